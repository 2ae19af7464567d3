// The watchdog of commands that move an external card. The hosts are stopped, killed or fed slowly.
#include <gmock/gmock.h>

#include <csignal>

#include "command.hpp"
#include "server.hpp"

namespace trammel::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kSilent = "WATCHDOG (the program that moved the card was silent for too long)";

// A served card that a program of 10 s moves, with a watchdog of 0.6 s.
class WatchedRun : public ::testing::Test {
 protected:
  // Once it moves.
  Running start() {
    return Running(command_, "run " + command_.write("long.ngc", "G1 X100 F600\n") + kShort + server_.moving(),
                   "client.err");
  }
  bool shows(const std::string& text) const {
    return command_.run("monitor --looks 1 --card " + server_.url()).out.find(text) != std::string::npos;
  }
  std::string registers() const { return command_.run("dump --card " + server_.url()).out; }
  Outcome move(const std::string& options) const {
    return command_.run("run " + command_.write("next.ngc", "G91 G1 X1 F6000\n") + options +
                        " --set motion.watchdog=40 --card " + server_.moving());
  }
  // A move is refused until the fault is cleared, and then begins at the card's place.
  void expect_cleared_on_request() const {
    const Outcome refused = move("");
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.err, HasSubstr(std::string("--card: the card has stopped with a fault: ") + kSilent +
                                       "; the card stands at X "));
    EXPECT_THAT(refused.err, HasSubstr("clear the fault with --clear-faults"));
    const Outcome cleared = move(" --clear-faults");
    EXPECT_EQ(cleared.status, 0) << cleared.err;
    EXPECT_THAT(cleared.err, HasSubstr(std::string("cleared the card's earlier fault: ") + kSilent));
    const std::string after = registers();
    EXPECT_THAT(after, HasSubstr("FAULT                0x00000000"));
    EXPECT_THAT(after, HasSubstr("WATCHDOG             0x00000000")) << "or an idle card has a fault";
  }

  static constexpr const char* kShort = " --set motion.watchdog=0.6 --card ";
  Command command_;
  Server server_{command_, "--engine model"};
};

TEST_F(WatchedRun, AHostThatIsStoppedForTooLong) {
  Running client = start();
  ASSERT_TRUE(eventually([&] { return shows("on a path"); })) << server_.errors();
  EXPECT_THAT(registers(), HasSubstr("WATCHDOG             0x0000000A")) << "units of 65,536 us";
  client.signal(SIGSTOP);
  EXPECT_TRUE(eventually([&] { return shows("idle, FAULT: WATCHDOG"); }));
  client.signal(SIGCONT);
  const std::optional<int> status = client.wait();
  EXPECT_TRUE(status && WIFEXITED(*status) && WEXITSTATUS(*status) == 1);
  const std::string said = contents(command_.path("client.err"));
  EXPECT_THAT(said, HasSubstr(std::string("long.ngc:1: stream: the card has stopped with a fault: ") + kSilent));
  const std::string stands = " mm (pulses ";
  ASSERT_THAT(said, HasSubstr("the card stands at X "));
  ASSERT_THAT(said, HasSubstr(stands));
  EXPECT_THAT(said, HasSubstr(" in command 1 of the geometry queue, "));
  EXPECT_THAT(said, HasSubstr("--clear-faults"));
  const int steps = std::stoi(said.substr(said.find(stands) + stands.size()));
  EXPECT_GT(steps, 0);
  expect_cleared_on_request();
  EXPECT_THAT(server_.end(), HasSubstr("path: " + std::to_string(steps + 80) + " steps")) << "every pulse is counted";
}

TEST_F(WatchedRun, AHostThatIsKilled) {
  Running client = start();
  ASSERT_TRUE(eventually([&] { return shows("on a path"); })) << server_.errors();
  client.signal(SIGKILL);
  EXPECT_TRUE(eventually([&] { return shows("FAULT: WATCHDOG"); }));
  expect_cleared_on_request();
}

TEST(WatchedRunTime, WhatTheCardCannotCountIsRefused) {
  const Command command;
  Server server(command, "--engine model --clock 4000000000");
  const Outcome outcome = command.run("line --to 10 --card " + server.moving());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("5000 ms: this card takes up to 1073 ms: change it by --set motion.watchdog="));
}

TEST_F(WatchedRun, AProgramThatComesSlowly) {
  const Outcome outcome = command_.run("run - --stream" + std::string(kShort) + server_.moving() +
                                       " < <(echo G1 X1 F6000; sleep 1; echo G1 X2)");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("X: ends at pulse 160"));
}

}  // namespace
}  // namespace trammel::test
