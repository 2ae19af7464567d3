// `trammel world`: the machine behind a served card, while other clients use the card.
#include <gmock/gmock.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <thread>
#include <vector>

#include "command.hpp"
#include "server.hpp"
#include "trammel/transport/served_world.hpp"

namespace trammel::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class AtTheMachine : public ::testing::Test {
 protected:
  Outcome world(const std::string& arguments) const {
    return command_.run("world --card " + server_.moving() + " " + arguments);
  }
  nlohmann::json state() const {
    return nlohmann::json::parse(command_.run("world --json --card " + server_.url()).out, nullptr, false);
  }
  // Moves by a program of one line. A jog would poll the card more often.
  Outcome move(const std::string& words, const std::string& options = "") const {
    return command_.run("run " + command_.write("move.ngc", "G91\nG1 " + words + " F6000\n") + " " + options +
                        " --card " + server_.moving());
  }
  std::string refused(const std::string& arguments) const {
    const Outcome outcome = command_.run("world " + arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_EQ(outcome.out, "");
    return outcome.err;
  }

  Command command_;
  Server server_{command_, "--engine model --fast --world default"};
};

TEST_F(AtTheMachine, TheStateFollowsTheCardAndTheButtons) {
  ASSERT_EQ(move("X-100.5").status, 0);
  const nlohmann::json now = state();
  EXPECT_EQ(now["axes"][0]["axis"], "X");
  EXPECT_EQ(now["axes"][0]["commanded"], -8040);
  EXPECT_NEAR(now["axes"][0]["carriage_mm"].get<double>(), -100.5, 0.02);
  EXPECT_EQ(now["axes"][0]["lost"], 0);
  EXPECT_EQ(now["pressed"], nlohmann::json({"x_minus"}));
  EXPECT_EQ(now["path"]["steps"], 8040);
  const Outcome pressed = world("press estop");
  EXPECT_EQ(pressed.status, 0) << pressed.err;
  EXPECT_THAT(pressed.out,
              AllOf(HasSubstr("the card counts  -100.5000 mm   lost 0 pulses\n"),
                    HasSubstr("pressed   x_minus, estop\n"), HasSubstr("path      8040 steps, identity ")));
  EXPECT_THAT(command_.run("recover --card " + server_.url()).out, HasSubstr("EMERGENCY_STOP"));
  EXPECT_EQ(world("release estop").status, 0);
  EXPECT_FALSE(state()["emergency_stop"]);
  EXPECT_EQ(move("X1", "--clear-faults").status, 0);
  EXPECT_THAT(world("count").out, HasSubstr("path      0 steps, identity 0000000000000000\n"));
}

TEST_F(AtTheMachine, APressInMidMotion) {
  Running press(command_, "world press estop --when 'X>5' --card " + server_.moving(), "press.err", "press.out");
  ASSERT_TRUE(eventually([&] { return server_.said("has come"); }));
  const Outcome stopped = move("X20");
  EXPECT_EQ(stopped.status, 1);
  EXPECT_THAT(stopped.err, HasSubstr("EMERGENCY_STOP"));
  EXPECT_TRUE(press.wait());
  EXPECT_THAT(contents(command_.path("press.out")), HasSubstr("pressed   estop\n"));
  const double at = state()["axes"][0]["commanded_mm"].get<double>();
  EXPECT_GT(at, 5);
  EXPECT_LT(at, 8);  // at 100 mm/s: 5 ms for a turn of the server, and as much for its accesses
}

TEST_F(AtTheMachine, WhatIsNotThereIsRefusedByName) {
  EXPECT_THAT(refused(""), HasSubstr("world: needs --card with the URL that `trammel serve --world default` prints"));
  EXPECT_THAT(refused("--card serial:/dev/ttyUSB0"), HasSubstr("no machine is simulated behind this card"));
  EXPECT_THAT(refused("--card '" + server_.url() + "?hello=no'"), HasSubstr("no machine is simulated"));
  EXPECT_THAT(refused("--card " + server_.moving() + " press stop"),
              HasSubstr("stop: no such button: feed_hold, cycle_start, estop"));
  EXPECT_THAT(refused("--card " + server_.url() + " press estop"), HasSubstr("token"));
  const Command elsewhere;
  const Server bare(elsewhere, "--engine model --fast");
  const Outcome none = command_.run("world --card " + bare.moving());
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("no machine behind its pins: start it by `trammel serve --world default`"));
  const Outcome wrong = command_.run("world --card '" + server_.url() + "?token=guess'");
  EXPECT_THAT(wrong.err, HasSubstr("wrong token"));
  EXPECT_TRUE(state()["pressed"].empty());
}

TEST_F(AtTheMachine, AWaitEndsAndItsPressIsForgotten) {
  const Outcome waited = world("press estop --when 'X>5' --longest 0.3");
  EXPECT_EQ(waited.status, 1);
  EXPECT_THAT(waited.err, HasSubstr("nothing was done, because X > 5 did not come within 0.3 s"));
  EXPECT_TRUE(eventually([&] { return server_.said("client gone"); })) << "the server sees that it has left";
  const Outcome moved = move("X10");
  EXPECT_EQ(moved.status, 0) << moved.err;
  EXPECT_TRUE(state()["pressed"].empty());
}

// During a run three threads read and press without a pause. The path is the undisturbed one, and each answer is
// complete and consistent.
TEST_F(AtTheMachine, ManyAtOnceDisturbNoRun) {
  std::string program = "F3000\n";
  for (int i = 1; i <= 40; ++i) program += "G1 X" + std::to_string(i % 7) + " Y" + std::to_string(i % 5) + "\n";
  const std::string file = command_.write("many.ngc", program + "G1 X0 Y0\nM2\n");
  const Command elsewhere;
  Server other(elsewhere, "--engine model --fast --world default");
  ASSERT_EQ(command_.run("run " + file + " --card " + other.moving()).status, 0);
  std::atomic<bool> ended = false;
  std::atomic<int> answers = 0;
  std::vector<std::thread> threads;
  for (int n = 0; n < 3; ++n) {
    threads.emplace_back([&, url = server_.url() + "?token=secret"] {
      transport::ServedWorld at(transport::parse_card_url(url));
      for (int i = 0; !ended; ++i) {
        const std::string text = at.request(i % 3 == 0   ? "state"
                                            : i % 3 == 1 ? "press cycle_start"
                                                         : "release cycle_start");
        const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
        ASSERT_FALSE(json.is_discarded()) << text;
        ASSERT_EQ(json["axes"].size(), 4U);
        ++answers;
      }
    });
  }
  const Outcome run = command_.run("run " + file + " --card " + server_.moving());
  const int during = answers;
  ended = true;
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_GT(during, 10);
  const auto path_line = [](const std::string& said) { return said.substr(said.rfind("path: ")).substr(0, 90); };
  EXPECT_EQ(path_line(server_.end()), path_line(other.end()));
}

// Runs the page's Python example.
TEST_F(AtTheMachine, AnyLanguageWithASocket) {
  const std::string page = contents(TRAMMEL_EXAMPLES_DIR "/../docs/user/world.md");
  const std::size_t from = page.find("```python\n");
  ASSERT_NE(from, std::string::npos);
  const std::string text = page.substr(from + 10, page.find("```", from + 10) - from - 10);
  const std::size_t colon = server_.url().rfind(':');
  const std::string file = command_.write(
      "at.py", "HOST, PORT, TOKEN = '127.0.0.1', " + server_.url().substr(colon + 1) + ", 'secret'\n" + text);
  ASSERT_EQ(std::system(("python3 " + file + " >" + command_.path("said") + " 2>&1").c_str()), 0)
      << contents(command_.path("said"));
  EXPECT_EQ(contents(command_.path("said")), "['estop']\n");
}

}  // namespace
}  // namespace trammel::test
