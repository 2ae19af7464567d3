#include "trammel/panel/session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench.hpp"

namespace trammel::panel {
namespace {

using testing::HasSubstr;

TEST(Jog, GoesOnWhileThePageSaysThatItIsHeldAndEndsAtRelease) {
  Bench bench;
  bench.press(7);
  milliseconds said = bench.clock();
  const milliseconds begun = said;
  bench.machine.at_moments = [&] {
    if (bench.clock() - begun >= milliseconds(1500)) {
      bench.send({{"do", "release"}, {"id", 7}});
      bench.machine.at_moments = nullptr;
    } else if (bench.clock() - said >= milliseconds(100)) {
      bench.held(7);
      said = bench.clock();
    }
  };
  bench.work(milliseconds(2000));
  ASSERT_EQ(bench.machine.stops.size(), 1U);
  EXPECT_NEAR(bench.machine.live.at[0], 30, 0.5);  // 1.5 s at 20 mm/s
  EXPECT_EQ(bench.state()["state"], "Idle");
  EXPECT_EQ(bench.state()["jog"], 0);
}

TEST(Jog, EndsWhenThePageWasSilentForTheDeadMansTime) {
  Bench bench;
  bench.press(1);
  const TimePoint begun = bench.machine.now;
  bench.work(milliseconds(1000));
  ASSERT_EQ(bench.machine.stops.size(), 1U);
  EXPECT_GE(bench.machine.stops[0] - begun, milliseconds(300));
  EXPECT_LE(bench.machine.stops[0] - begun, milliseconds(300) + SlowMachine::kMoment);
  EXPECT_THAT(bench.notes(), HasSubstr("silent for 300 ms"));
}

// A message that was on its way for longer than the dead-man time does not count.
TEST(Jog, AMessageThatWasUnderWayTooLongDoesNotCount) {
  Bench bench;
  bench.press(1);
  const auto old = bench.state()["clock"];
  bench.machine.at_moments = [&] { bench.send({{"do", "held"}, {"id", 1}, {"clock", old}}); };
  bench.work(milliseconds(1000));
  ASSERT_EQ(bench.machine.stops.size(), 1U);
  EXPECT_LE(bench.machine.stops[0], TimePoint(milliseconds(600) + 2 * SlowMachine::kMoment));
  const double stood = bench.machine.live.at[0];
  bench.send({{"do", "jog"}, {"id", 2}, {"axis", 0}, {"way", 1}, {"percent", 50}, {"clock", old}});
  bench.machine.at_moments = nullptr;
  bench.work(milliseconds(200));
  EXPECT_EQ(bench.machine.live.at[0], stood);
  EXPECT_THAT(bench.notes(), HasSubstr("too late"));
}

TEST(Jog, DoesNotBeginAgainByMessagesOfOneThatHasEnded) {
  Bench bench;
  bench.press(1);
  bench.work(milliseconds(1000));
  const double stood = bench.machine.live.at[0];
  bench.held(1);
  bench.work(milliseconds(500));
  EXPECT_EQ(bench.machine.live.at[0], stood);
}

TEST(Jog, MessagesOfAnotherDoNotProlongIt) {
  Bench bench;
  bench.press(1);
  bench.machine.at_moments = [&] { bench.held(2); };
  bench.work(milliseconds(1000));
  ASSERT_EQ(bench.machine.stops.size(), 1U);
  EXPECT_LE(bench.machine.stops[0], TimePoint(milliseconds(310)));
}

TEST(Jog, EndsWhenThePageGoesOrAnotherComes) {
  for (const bool goes : {true, false}) {
    Bench bench;
    bench.press(1);
    bench.after(milliseconds(100), [&] { goes ? bench.session.left() : bench.session.arrived(); });
    bench.work(milliseconds(250));
    ASSERT_EQ(bench.machine.stops.size(), 1U);
    EXPECT_NEAR(bench.machine.live.at[0], 2, 0.2);
  }
}

TEST(Jog, AStepGoesItsWayAfterRelease) {
  Bench bench;
  bench.press(1, 4);
  bench.after(milliseconds(50), [&] { bench.send({{"do", "release"}, {"id", 1}}); });
  bench.work(milliseconds(400));
  EXPECT_TRUE(bench.machine.stops.empty());
  EXPECT_DOUBLE_EQ(bench.machine.live.at[0], 4);
}

TEST(Jog, AStepEndsBySilenceToo) {
  Bench bench;
  bench.press(1, 50);
  bench.work(milliseconds(1000));
  EXPECT_EQ(bench.machine.stops.size(), 1U);
  EXPECT_LT(bench.machine.live.at[0], 7);
}

TEST(Jog, EndsAtTheSoftLimit) {
  Bench bench;
  bench.press(1, 0, -1);
  bench.machine.at_moments = [&] { bench.held(1); };
  bench.work(milliseconds(1500));
  EXPECT_DOUBLE_EQ(bench.machine.live.at[0], -10);
  EXPECT_TRUE(bench.machine.stops.empty());
  bench.press(2, 1, -1);
  bench.settle();
  EXPECT_DOUBLE_EQ(bench.machine.live.at[0], -10);
  EXPECT_THAT(bench.notes(), HasSubstr("X is at its soft limit"));
}

TEST(Alarm, NothingMovesInItAndHomingOrRecoveryEndsIt) {
  Bench bench(false);
  EXPECT_EQ(bench.state()["state"], "Alarm");
  EXPECT_THAT(bench.state()["alarm"]["text"], HasSubstr("Not homed"));
  bench.load("G1 X5 F600");
  bench.press(1);
  bench.send({{"do", "start"}});
  bench.send({{"do", "zero"}, {"axis", 0}});
  bench.work(milliseconds(200));
  EXPECT_EQ(bench.machine.live.at[0], 0);
  EXPECT_THAT(bench.notes(), HasSubstr("Jog: refused in an alarm"));
  EXPECT_THAT(bench.notes(), HasSubstr("Start: refused in an alarm"));
  EXPECT_THAT(bench.notes(), HasSubstr("Work zero: refused in an alarm"));
  bench.send({{"do", "home"}});
  bench.settle();
  EXPECT_EQ(bench.machine.homings, 1U);
  EXPECT_EQ(bench.state()["state"], "Idle");
  EXPECT_TRUE(bench.state()["alarm"].is_null());
}

TEST(Alarm, TellsTheCardsReasonAndStopsTheProgram) {
  Bench bench;
  bench.load("G1 X5 F600\nX10\n");
  bench.send({{"do", "start"}});
  bench.after(milliseconds(300), [&] {
    bench.machine.trouble_now.alarm = grbl::Alarm::kHardLimit;
    bench.machine.trouble_now.message = "fault: limit switch X minus";
  });
  bench.work(milliseconds(1000));
  const json state = bench.state();
  EXPECT_EQ(state["alarm"]["number"], 1);
  EXPECT_EQ(state["alarm"]["reason"], "fault: limit switch X minus");
  // The alarm remains as long as its cause.
  bench.send({{"do", "unlock"}});
  bench.settle();
  EXPECT_EQ(bench.state()["state"], "Alarm");
  bench.machine.trouble_now = {};
  bench.send({{"do", "unlock"}});
  bench.settle();
  EXPECT_EQ(bench.state()["state"], "Idle");
}

TEST(Homing, IsStoppedInItsMidst) {
  Bench bench;
  bench.machine.live.at[0] = 50;
  bench.send({{"do", "home"}});
  bench.after(milliseconds(200), [&] { bench.send({{"do", "stop"}}); });
  bench.work(milliseconds(400));
  EXPECT_EQ(bench.machine.stops.size(), 1U);
  EXPECT_GT(bench.machine.live.at[0], 40);
  EXPECT_EQ(bench.state()["state"], "Alarm");
}

TEST(Zero, IsTheWorkZeroOfOneAxis) {
  Bench bench;
  bench.press(1, 3);
  bench.work(milliseconds(250));
  bench.send({{"do", "zero"}, {"axis", 0}});
  bench.settle();
  const json axes = bench.state()["axes"];
  EXPECT_EQ(axes[0]["work"], 0);
  EXPECT_EQ(axes[0]["machine"], 3);
  EXPECT_EQ(axes[1]["work"], 0);
}

TEST(Messages, RubbishChangesNothing) {
  Bench bench;
  for (const char* text : {"", "[]", "{", "{\"do\":7}", "{\"do\":\"jog\",\"axis\":-1}", "{\"do\":\"dance\"}", "null",
                           "{\"do\":\"jog\",\"axis\":99,\"clock\":0}", "{\"do\":\"zero\",\"axis\":7,\"clock\":0}",
                           "{\"do\":\"jog\",\"id\":\"x\"}", "{\"do\":\"feed\",\"change\":1000}"}) {
    bench.session.receive(text);
    bench.settle();
    EXPECT_EQ(bench.state()["state"], "Idle") << text;
    EXPECT_EQ(bench.machine.live.at[0], 0) << text;
  }
}

TEST(State, HasNumbersWithTheirUnits) {
  Bench bench;
  const json hello = json::parse(bench.session.hello())["hello"];
  ASSERT_EQ(hello["axes"].size(), 3U);
  EXPECT_EQ(hello["axes"][0]["letter"], "X");
  EXPECT_EQ(hello["axes"][0]["unit"], "mm");
  EXPECT_EQ(hello["axes"][0]["max_velocity_per_min"], 3000);
  EXPECT_EQ(hello["hold_when_gone"], true);
  bench.machine.live.at = {1.25, -2, 0.00004};
  bench.machine.live.limits = 2;
  const json state = bench.state();
  EXPECT_EQ(state["axes"][0], json::parse(R"({"machine":1.25,"work":1.25,"min":-10.0,"max":200.0,"at_switch":false})"));
  EXPECT_EQ(state["axes"][1]["at_switch"], true);
  EXPECT_EQ(state["axes"][2]["machine"], 0);
  EXPECT_EQ(state["feed_override_percent"], 100);
  EXPECT_EQ(state["homed"], true);
}

TEST(State, NotesComeOnce) {
  Bench bench;
  bench.session.receive("{");
  std::uint64_t told = 0;
  EXPECT_TRUE(json::parse(bench.session.state(told))["state"].contains("notes"));
  EXPECT_FALSE(json::parse(bench.session.state(told))["state"].contains("notes"));
}

TEST(Overrides, GoByTheButtonsSteps) {
  Bench bench;
  for (const int change : {10, 10, 1, -10}) bench.send({{"do", "feed"}, {"change", change}});
  EXPECT_EQ(bench.state()["feed_override_percent"], 111);
  bench.send({{"do", "feed"}, {"change", 0}});
  EXPECT_EQ(bench.state()["feed_override_percent"], 100);
  bench.send({{"do", "rapid"}, {"change", 25}});
  EXPECT_EQ(bench.state()["rapid_override_percent"], 25);
}

}  // namespace
}  // namespace trammel::panel
