// Alarms of limits, probes and homing: what they drop, and the answers.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "session.hpp"

namespace trammel::grbl {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

const char* const kUnlockFirst = "[MSG:'$H'|'$X' to unlock]";

TEST(Alarm, RefusesALineBeyondTheSoftLimits) {
  Session session(fenced_router());
  session.begun();
  session.put("G0X-5\nG0X1\nG0X-6\n");
  session.settle();
  EXPECT_THAT(session.answers(), ElementsAre("ok", "ALARM:2", kUnlockFirst));
  EXPECT_EQ(session.state(), "Alarm");
  EXPECT_LE(session.fake.at()[0], 0);
  EXPECT_THAT(session.ask("G0X-7"), ElementsAre("error:9"));
  session.ask("$X");
  EXPECT_EQ(session.last("G91G0X-1"), "ok") << "the place is known";
}

TEST(Alarm, OfASoftLimitStopsWhatMoves) {
  Session session(fenced_router());
  session.begun();
  session.fake.ticks_a_motion = 8;
  session.script([] {}, [] {}, [&] { session.put("G0X1\nG0X-3\n"); });
  session.put("G0X-10\nG0X-20\n");
  session.settle();
  EXPECT_EQ(session.fake.stops, 1U);
  EXPECT_THAT(session.answers(), ElementsAre("ok", "ok", "ALARM:2", kUnlockFirst));
  EXPECT_EQ(session.fake.at()[0], -5);
  session.ask("$X");
  session.ask("G91G0X-1");
  EXPECT_EQ(session.fake.at()[0], -6);
}

TEST(Alarm, JogsBeyondTheSoftLimitsAreErrors) {
  Session session(fenced_router());
  session.begun();
  EXPECT_THAT(session.ask("$J=X1F100"), ElementsAre("error:15"));
  EXPECT_EQ(session.state(), "Idle");
  EXPECT_THAT(session.fake.motions, IsEmpty());
}

TEST(Alarm, OfTheMachineDropsAllLines) {
  for (const auto alarm : {Alarm::kHardLimit, Alarm::kSoftLimit, Alarm::kPositionLost}) {
    Session session;
    session.begun();
    session.fake.motion_fails = End{false, alarm, "why", std::nullopt};
    session.put("G0X1\nG0X2\nG4P1\nG0X3\nG0X4");
    session.settle();
    EXPECT_THAT(session.answers(),
                ElementsAre("ok", "ok", fmt::format("ALARM:{}", static_cast<int>(alarm)), "[MSG:why]", kUnlockFirst));
    EXPECT_EQ(session.state(), "Alarm");
    EXPECT_THAT(session.fake.motions, IsEmpty());
    EXPECT_THAT(session.ask(""), ElementsAre("ok")) << "the line that had begun is dropped, too";
    EXPECT_THAT(session.ask("G0X5"), ElementsAre("error:9"));
    EXPECT_EQ(session.last("$X"), "ok");
    EXPECT_EQ(session.last("G0X5"), "ok");
    EXPECT_EQ(session.fake.at()[0], 5);
  }
}

TEST(Alarm, OfAMachineThatStandsIsTold) {
  Session session;
  session.begun();
  session.fake.trouble_now = {false, Alarm::kHardLimit, "limit of X", std::nullopt};
  session.settle();
  EXPECT_THAT(session.answers(), ElementsAre("ALARM:1", "[MSG:limit of X]", kUnlockFirst));
  session.settle();
  EXPECT_THAT(session.answers(), IsEmpty()) << "once";
  EXPECT_EQ(session.state(), "Alarm");
}

TEST(Alarm, OutlivesAResetWhileItsCauseDoes) {
  Session session;
  session.begun();
  session.fake.trouble_now = {false, Alarm::kHardLimit, "limit of X", std::nullopt};
  session.settle();
  session.answers();
  session.put("\x18");
  session.settle();
  EXPECT_EQ(session.state(), "Alarm");
  EXPECT_THAT(session.answers(), ElementsAre("Grbl 1.1h ['$' for help]", "[MSG:limit of X]", kUnlockFirst));
}

// The machine side refuses a motion without an alarm: the reason is reported, the remaining lines are dropped, and
// there is no lock.
TEST(Alarm, IsNoneWhereAMotionIsRefused) {
  Session session;
  session.begun();
  session.fake.motion_fails = End{false, Alarm::kNone, "refused", std::nullopt};
  session.put("G0X1\nG0X2\n");
  session.settle();
  EXPECT_THAT(session.answers(), ElementsAre("ok", "ok", "[MSG:refused]"));
  EXPECT_EQ(session.state(), "Idle");
  session.ask("G91G0X1");
  EXPECT_EQ(session.fake.at()[0], 1);
}

TEST(Probe, TellsWhereItTouched) {
  Session session;
  session.begun();
  session.fake.edge = 0.25;
  session.put("G0Z8\nG38.2Z0F100\nG92Z0\n");
  session.settle();
  EXPECT_THAT(session.answers(), ElementsAre("ok", "[PRB:0.000,0.000,6.000:1]", "ok", "ok"));
  EXPECT_THAT(session.ask("$#"), Contains("[PRB:0.000,0.000,6.000:1]"));
  EXPECT_EQ(session.state(), "Idle");
  EXPECT_EQ(session.field("WCO"), "0.000,0.000,6.000") << "G92 counts from where it stands";
}

TEST(Probe, TellsAMissWithoutAlarmWhereThatIsAsked) {
  for (const char* const line : {"G38.3Z-4F100", "G38.5Z-4F100"}) {
    Session session;
    session.begun();
    session.fake.touched = std::string(line).rfind("G38.5", 0) == 0;
    EXPECT_THAT(session.ask(line), ElementsAre("[PRB:0.000,0.000,-4.000:0]", "ok"));
    EXPECT_EQ(session.state(), "Idle");
    EXPECT_EQ(session.last("G91G0Z1"), "ok");
    EXPECT_EQ(session.fake.at()[2], -3);
  }
}

// As in Grbl, the line gets its ok after the alarm, and the lines after it are refused.
TEST(Probe, RaisesAlarm5WhereItMisses) {
  for (const char* const line : {"G38.2Z-4F100", "G38.4Z-4F100"}) {
    Session session;
    session.begun();
    session.fake.touched = std::string(line).rfind("G38.4", 0) == 0;
    session.put(std::string(line) + "\nG0X1\n");
    session.settle();
    EXPECT_THAT(session.answers(), ElementsAre("ALARM:5", kUnlockFirst, "[PRB:0.000,0.000,-4.000:0]", "ok", "error:9"));
    EXPECT_EQ(session.state(), "Alarm");
    session.ask("$X");
    session.ask("G91G0Z1");
    EXPECT_EQ(session.fake.at()[2], -3);
  }
}

TEST(Probe, RaisesAlarm4WhereItTouchesAlready) {
  for (const char* const line : {"G38.2Z-4F100", "G38.3Z-4F100", "G38.4Z-4F100", "G38.5Z-4F100"}) {
    Session session;
    session.begun();
    session.fake.touched = std::string(line) < "G38.4";
    session.put(std::string(line) + "\nG0X1\n");
    session.settle();
    EXPECT_THAT(session.answers(), ElementsAre("ALARM:4", kUnlockFirst, "ok", "error:9")) << line;
    EXPECT_THAT(session.fake.befores, IsEmpty()) << "nothing moves";
    session.ask("$X");
    session.ask("G91G0Z1");
    EXPECT_EQ(session.fake.at()[2], 1);
  }
}

TEST(Probe, WaitsForWhatIsBeforeIt) {
  Session session;
  session.begun();
  session.fake.edge = 0.5;
  session.put("G0X4\nG38.2Z-4F100\nG0X5\n");
  session.settle();
  EXPECT_THAT(session.answers(), ElementsAre("ok", "[PRB:4.000,0.000,-2.000:1]", "ok", "ok"));
  EXPECT_EQ(session.fake.at()[0], 5);
  EXPECT_EQ(session.fake.at()[2], -2);
}

TEST(Probe, EndsWithAReset) {
  Session session;
  session.begun();
  session.script([] {}, [&] { session.put("\x18"); });
  session.put("G38.2Z-4F100\n");
  session.settle();
  EXPECT_THAT(session.answers(), ElementsAre("Grbl 1.1h ['$' for help]"));
  EXPECT_EQ(session.state(), "Idle");
}

// The lines of motions that contain M words, which switch outputs.
std::vector<std::string> switches(const Session& session) {
  std::vector<std::string> lines;
  for (const std::string& line : session.fake.lines) {
    if (line.find('M') != std::string::npos) lines.push_back(line);
  }
  return lines;
}

TEST(Outputs, AreSwitchedOffByAReset) {
  Session session(router());
  session.begun();
  session.ask("M3 S500 M8");
  session.put("\x18");
  session.settle();
  ASSERT_FALSE(switches(session).empty());
  EXPECT_EQ(switches(session).back(), "M5 M9");
  const std::size_t before = session.fake.lines.size();
  session.put("\x18");
  session.settle();
  EXPECT_EQ(session.fake.lines.size(), before) << "they are off already";
}

TEST(Outputs, AreSwitchedOffByAnAlarmAndStayOff) {
  Session session(fenced_router());
  session.begun();
  session.ask("M3 S500");
  session.ask("G90 G1 X50 F100");  // exceeds the soft limit
  ASSERT_EQ(session.state(), "Alarm");
  EXPECT_EQ(switches(session).back(), "M5 M9");
  session.ask("$X");
  session.ask("G1 X-1 F100");
  EXPECT_EQ(switches(session).back(), "M5 M9") << "nothing switches them on again but a line";
  EXPECT_EQ(session.fake.befores.back().spindle, 5);
}

TEST(Outputs, ThatAStopHasSwitchedOffAreKnownToBeOff) {
  machine::Machine machine = router();
  machine.outputs.off_at_rest = machine.outputs.m3;
  Session session(machine);
  session.begun();
  session.ask("M3 S500");
  session.fake.ticks_a_motion = 8;
  session.script([&] { session.put("\x85"); });
  session.put("$J=G91X-50F100\n");
  session.settle();
  session.ask("G91 G1 X-1 F100");
  EXPECT_EQ(session.fake.befores.back().spindle, 5) << "the jog's cancel set the safe levels";
}

// A router with $22=1.
class HomingRouter : public testing::Test {
 protected:
  HomingRouter() {
    session_.begun();
    session_.ask("$22=1");
    session_.ask("$X");
  }

  Session session_{fenced_router()};
};

TEST_F(HomingRouter, IsHomed) {
  session_.ask("G0X-9");
  session_.settings.set_startup(0, "G21");
  EXPECT_THAT(session_.ask("$H"), ElementsAre(">G21:ok", "ok"));
  EXPECT_THAT(session_.fake.homings, ElementsAre(IsEmpty()));
  EXPECT_EQ(session_.field("MPos"), "0.000,0.000,0.000");
  session_.ask("G91G0X-1");
  EXPECT_EQ(session_.field("MPos"), "-1.000,0.000,0.000");
}

TEST_F(HomingRouter, HomesSingleAxesWithoutStartupLines) {
  session_.settings.set_startup(0, "G21");
  EXPECT_THAT(session_.ask("$HY"), ElementsAre("ok"));
  EXPECT_THAT(session_.fake.homings, ElementsAre(ElementsAre(1)));
  EXPECT_THAT(session_.ask("$HA"), ElementsAre("error:3"));
  EXPECT_THAT(session_.ask("$H1"), ElementsAre("error:3"));
  EXPECT_EQ(session_.state(), "Idle");
}

// Homing takes long. During it reports and resets are served, whether the $H came during a wait or before.
TEST_F(HomingRouter, ServesASenderMeanwhile) {
  for (const bool in_wait : {false, true}) {
    std::string during;
    std::vector<std::string> answers{"none"};
    const auto look = [&] {
      during = session_.state();
      session_.put("$G\n");
    };
    if (in_wait) {
      session_.script([&] { session_.put("$H\n"); }, look, [&] { answers = session_.answers(); });
    } else {
      session_.put("$H\n");
      session_.script(look, [&] { answers = session_.answers(); });
    }
    session_.settle();
    EXPECT_EQ(during, "Home");
    EXPECT_THAT(answers, IsEmpty()) << "lines wait";
    EXPECT_THAT(session_.answers(), ElementsAre("ok", testing::StartsWith("[GC:"), "ok"));
  }
}

TEST_F(HomingRouter, RaisesAlarm6AtAReset) {
  session_.script([&] { session_.put("\x18"); });
  session_.put("$H\n");
  session_.settle();
  const std::vector<std::string> answers = session_.answers();
  EXPECT_EQ(answers.front(), "ALARM:6");
  EXPECT_THAT(answers, Contains("Grbl 1.1h ['$' for help]"));
  EXPECT_EQ(session_.state(), "Alarm");
  EXPECT_EQ(session_.fake.stops, 1U);
}

TEST_F(HomingRouter, RaisesAlarm9WithoutASwitch) {
  session_.fake.homing_end = {false, Alarm::kHomingNoSwitch, "X: no switch in 220 mm", std::nullopt};
  session_.put("$H\nG0X-1\n");
  session_.settle();
  EXPECT_THAT(session_.answers(), ElementsAre("ALARM:9", "[MSG:X: no switch in 220 mm]", kUnlockFirst, "ok"));
  EXPECT_EQ(session_.state(), "Alarm");
  EXPECT_THAT(session_.ask("G0X-1"), ElementsAre("error:9"));
  session_.fake.homing_end = {};
  EXPECT_THAT(session_.ask("$H"), ElementsAre("ok"));
  EXPECT_EQ(session_.state(), "Idle");
}

TEST_F(HomingRouter, EndsAnAlarmByHoming) {
  session_.fake.trouble_now = {false, Alarm::kPositionLost, "", std::nullopt};
  session_.settle();
  EXPECT_EQ(session_.state(), "Alarm");
  session_.answers();
  EXPECT_THAT(session_.ask("$H"), ElementsAre("ok"));
  EXPECT_EQ(session_.state(), "Idle");
}

}  // namespace
}  // namespace trammel::grbl
