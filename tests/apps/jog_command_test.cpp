// `trammel jog` on a served card, by a distance and by the keys of a terminal.
#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "command.hpp"
#include "server.hpp"

namespace trammel::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kRight = "\x1b[C";
constexpr const char* kLeft = "\x1b[D";

class JogCommand : public ::testing::Test {
 protected:
  Outcome jog(const std::string& arguments) const {
    return command_.run("jog " + arguments + " --card " + server_.moving());
  }
  // Position of an axis in pulses, 80 per mm.
  int axis(int number) const {
    const std::string out = command_.run("monitor --looks 1 --card " + server_.url()).out;
    const std::string name = "axis " + std::to_string(number) + "   pulse ";
    return out.find(name) == std::string::npos ? -1'000'000 : std::stoi(out.substr(out.find(name) + name.size()));
  }
  // The wait is longer than one pulse of a slow axis takes.
  bool moves() const {
    const int before = axis(0);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    return axis(0) != before;
  }

  Command command_;
  Server server_{command_, "--engine model"};
};

TEST_F(JogCommand, GoesByADistanceFromWhereTheMachineStands) {
  const Outcome first = jog("X10 Y-0.5 --speed 200");
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_EQ(first.out, "the machine stands at X 10.0000 Y -0.5000 Z 0.0000 E 0.0000 mm\n");
  const Outcome second = jog("x-2 Z1");
  EXPECT_EQ(second.out, "the machine stands at X 8.0000 Y -0.5000 Z 1.0000 E 0.0000 mm\n") << second.err;
  EXPECT_EQ(axis(0), 640);
  EXPECT_EQ(axis(1), -40);
  EXPECT_THAT(server_.end(), HasSubstr("path: 1080 steps")) << "800, 40, 160 back, 80";
}

TEST_F(JogCommand, EndsAtASoftLimitAndSaysSo) {
  ASSERT_EQ(command_.run("zero X Y Z E --homed --card " + server_.moving()).status, 0);
  const Outcome outcome = jog("X10 --set axis.x.max=4");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(
      outcome.err,
      HasSubstr("note: X moved by 4.0000 mm instead of 10.0000 mm, because a soft limit (min or max) is in the way"));
  const Outcome at_the_limit = jog("X10 --set axis.x.max=4");
  EXPECT_EQ(at_the_limit.status, 2);
  EXPECT_EQ(axis(0), 320);
}

TEST_F(JogCommand, BeginsFromThePlaceThatTheCardKeeps) {
  const Outcome first = jog("X10 --set axis.x.max=4");
  EXPECT_THAT(first.err, HasSubstr("the card was reset: machine zero is where it stands now; soft limits of X"));
  EXPECT_EQ(axis(0), 800) << "no limit holds for an axis that is not homed";
  ASSERT_EQ(command_.run("zero X --card " + server_.moving()).status, 0);
  EXPECT_EQ(jog("X1").out, "the machine stands at X 1.0000 Y 0.0000 Z 0.0000 E 0.0000 mm\n");
  const Outcome scales = jog("X1 --set axis.x.steps_per_mm=100");
  EXPECT_EQ(scales.status, 2) << scales.err;
  const Outcome home = jog("X1 --set card.require_home=true");
  EXPECT_EQ(home.status, 2) << home.err;
  EXPECT_THAT(home.err, HasSubstr("homed"));
  EXPECT_EQ(axis(0), 880);
}

TEST_F(JogCommand, RefusesBeforeAnythingMoves) {
  const auto refusal = [&](const std::string& arguments) {
    const Outcome outcome = jog(arguments);
    EXPECT_EQ(outcome.status, 2);
    return outcome.err;
  };
  EXPECT_THAT(refusal("X10 Q5"), HasSubstr("jog: Q5: must be an axis of the machine and a distance in mm"));
  EXPECT_THAT(refusal("X10 Y"), HasSubstr("jog: Y: the distance must be a number"));
  EXPECT_THAT(refusal("X1e999"), HasSubstr("jog: X1e999: the distance must be a number"));
  EXPECT_THAT(refusal("X0x10"), HasSubstr("jog: X0x10: the distance must be a number"));
  EXPECT_THAT(refusal("X0 X5"), HasSubstr("jog: X5: the axis is given twice"));
  EXPECT_THAT(refusal("X1 x2"), HasSubstr("jog: x2: the axis is given twice"));
  EXPECT_THAT(refusal("X0"), HasSubstr("jog"));
  EXPECT_THAT(refusal(""), HasSubstr("jog: name axes and distances, such as X10 Y-0.5; keys need a terminal"));
  EXPECT_THAT(command_.run("jog X1").err, HasSubstr("jog: needs --card"));
  EXPECT_EQ(axis(0), 0);
}

TEST_F(JogCommand, CtrlCStopsItOnARampAndTellsThePlace) {
  const Running client(command_, "jog X100 --speed 20 --card " + server_.moving(), "client.err");
  ASSERT_TRUE(eventually([&] { return axis(0) > 40; }));
  client.signal(SIGINT);
  const auto said = [&] { return contents(command_.path("client.err")); };
  ASSERT_TRUE(eventually([&] { return said().find("stopped by SIGINT: X ") != std::string::npos; })) << said();
  const double place = std::stod(said().substr(said().find("SIGINT: X ") + 10));
  EXPECT_NEAR(place * 80, axis(0), 1);
  EXPECT_LT(place, 99);
}

class JogKeys : public JogCommand {
 protected:
  Running start() { return Running(command_, "jog --card " + server_.moving(), "client.err", terminal_); }
  bool shows(const std::string& text) { return terminal_.shown().find(text) != std::string::npos; }
  void expect_end(Running& client) {
    terminal_.type("q");
    const std::optional<int> status = client.wait();
    EXPECT_TRUE(status && WIFEXITED(*status) && WEXITSTATUS(*status) == 0) << contents(command_.path("client.err"));
  }

  PseudoTerminal terminal_;
};

TEST_F(JogKeys, MoveByStepsOfTheChosenLength) {
  Running client = start();
  ASSERT_TRUE(eventually([&] { return shows("by 1 a key"); })) << contents(command_.path("client.err"));
  terminal_.type(kRight);
  EXPECT_TRUE(eventually([&] { return axis(0) == 80 && shows("X 1.0000"); }));
  terminal_.type("2");
  EXPECT_TRUE(eventually([&] { return shows("by 0.1 a key"); }));
  terminal_.type(kLeft);
  EXPECT_TRUE(eventually([&] { return axis(0) == 72 && shows("X 0.9000"); }));
  expect_end(client);
  EXPECT_THAT(terminal_.shown(), HasSubstr("the machine stands at X 0.9000"));
  EXPECT_EQ(axis(0), 72);
}

TEST_F(JogKeys, MoveWhileAKeyIsHeldAndNoLonger) {
  Running client = start();
  ASSERT_TRUE(eventually([&] { return shows("by 1 a key"); })) << contents(command_.path("client.err"));
  terminal_.type("0-----");
  ASSERT_TRUE(eventually([&] { return shows("while a key is held, 3 %"); }));
  terminal_.type(kRight);
  ASSERT_TRUE(eventually([&] { return axis(0) > 8; }));
  const auto repeated = [&] {
    terminal_.type(kRight);
    return axis(0) > 80;
  };
  EXPECT_TRUE(eventually(repeated));
  const int held = axis(0);
  EXPECT_TRUE(eventually([&] { return !moves(); })) << "the key is released";
  EXPECT_LT(axis(0) - held, 80) << "200 ms at 0.8 mm/s, and a ramp";
  const int stood = axis(0);
  terminal_.type(kRight);
  EXPECT_TRUE(eventually([&] { return axis(0) != stood; }));
  terminal_.type(kLeft);
  EXPECT_TRUE(eventually([&] { return !moves(); })) << "the other direction ends it";
  EXPECT_GT(axis(0), stood);
  expect_end(client);
}

TEST_F(JogKeys, AKeyForAStepDoesNotHoldAMotionThatAKeyHas) {
  Running client = start();
  ASSERT_TRUE(eventually([&] { return shows("by 1 a key"); })) << contents(command_.path("client.err"));
  terminal_.type("0-----");
  terminal_.type(kRight);
  ASSERT_TRUE(eventually([&] { return axis(0) > 8; }));
  terminal_.type("3");
  EXPECT_TRUE(eventually([&] { return !moves(); })) << "the key is released";
  expect_end(client);
}

TEST_F(JogKeys, AnotherKeyAndTheTerminalsEndStopIt) {
  Running client = start();
  ASSERT_TRUE(eventually([&] { return shows("by 1 a key"); })) << contents(command_.path("client.err"));
  terminal_.type("4----");
  terminal_.type(kRight);
  ASSERT_TRUE(eventually([&] { return axis(0) > 8; }));
  terminal_.type("x");
  EXPECT_TRUE(eventually([&] { return !moves(); }));
  EXPECT_LT(axis(0), 800) << "10 mm were asked for";
  client.signal(SIGTERM);
  const std::optional<int> status = client.wait();
  EXPECT_TRUE(status && WIFSIGNALED(*status) && WTERMSIG(*status) == SIGTERM);
  EXPECT_THAT(contents(command_.path("client.err")), HasSubstr("stopped by SIGTERM: X "));
}

}  // namespace
}  // namespace trammel::test
