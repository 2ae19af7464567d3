// The protocol as a sender sees it: when each line is answered, and the answers.
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
using testing::StartsWith;

using Texts = std::vector<std::string>;

const char* const kGreeting = "Grbl 1.1h ['$' for help]";

Texts oks(std::size_t count) { return Texts(count, "ok"); }

TEST(Controller, GreetsAsGrbl) {
  Session session;
  session.controller.begin();
  EXPECT_THAT(session.answers(), ElementsAre(kGreeting));
  EXPECT_EQ(session.state(), "Idle");
}

TEST(Controller, AnswersEachLineOnceAndInOrder) {
  Session session;
  session.begun();
  session.put("G21\nG1X1\n\n(nothing)\nG90 F100\r\nG1X1\rT999\nG4P0\nM5\n$\n");
  session.settle();
  EXPECT_THAT(session.answers(), ElementsAre("ok", "error:22", "ok", "ok", "ok", "ok", "error:38", "ok", "ok",
                                             StartsWith("[HLP:$$ $# $G"), "ok"));
  EXPECT_EQ(session.fake.at()[0], 1);
}

TEST(Controller, RefusesALineOf80Bytes) {
  Session session;
  session.begun();
  const std::string line = "G0X1.";
  EXPECT_THAT(session.ask(line + std::string(79 - line.size(), '0')), ElementsAre("ok"));
  EXPECT_THAT(session.ask(line + std::string(80 - line.size(), '0')), ElementsAre("error:11"));
  EXPECT_THAT(session.ask("$" + std::string(79, '$')), ElementsAre("error:11"));
  EXPECT_THAT(session.ask("G0X2 (" + std::string(500, 'c') + ")"), ElementsAre("ok"));
  EXPECT_EQ(session.fake.at()[0], 2);
}

// Grbl's planner has 15 blocks. The line after those is answered when a block has ended.
TEST(Controller, TakesAsManyLinesAheadAsGrblsPlannerHolds) {
  Session session;
  session.begun();
  session.fake.ticks_a_motion = 10;
  Texts while_first;
  Texts while_second;
  const auto nothing = [] {};
  session.script(
      nothing, nothing, nothing, nothing, nothing, [&] { while_first = session.answers(); }, nothing, nothing, nothing,
      nothing, nothing, nothing, nothing, [&] { while_second = session.answers(); });
  for (int n = 1; n <= 20; ++n) session.put(fmt::format("G1X{}F1000\n", n));
  session.settle();
  EXPECT_EQ(while_first, oks(16)) << "one is under way, 15 are planned";
  EXPECT_EQ(while_second, oks(1)) << "there is room for one more";
  EXPECT_EQ(session.answers(), oks(3));
  EXPECT_EQ(session.fake.motions.size(), 20U);
  EXPECT_EQ(session.fake.at()[0], 20);
}

TEST(Controller, ShowsItsBuffers) {
  Session session;
  session.begun();
  session.last("$10=3");
  EXPECT_EQ(session.field("Bf"), "15,128");
  session.fake.ticks_a_motion = 10;
  std::string busy;
  session.script([] {}, [] {}, [&] { busy = session.field("Bf"); });
  for (int n = 1; n <= 18; ++n) session.put("G91G1X1F1000\n");
  session.settle();
  // 16 of 18 lines of 13 bytes are read; the others wait.
  EXPECT_EQ(busy, "0,102");
  EXPECT_EQ(session.field("Bf"), "15,128");
}

TEST(Controller, PlansLinesThatFollowEachOtherInOneMotion) {
  Session session;
  session.begun();
  session.put("G1X1F100\nX2\nM3S500\nX3\n");
  session.settle();
  EXPECT_THAT(session.fake.befores, SizeIs(1));
  EXPECT_EQ(session.answers(), oks(4));
  EXPECT_EQ(session.fake.at()[0], 3);
}

TEST(Controller, TellsTheMotionWhatHoldsBeforeIt) {
  Session session;
  session.begun();
  session.put("G0X5\nM3S700\n");
  session.settle();
  session.put("G10L2P1X2\n");
  session.settle();
  session.put("G0X5\n");
  session.settle();
  const Before& before = session.fake.befores.back();
  EXPECT_EQ(before.place[0], 5);
  EXPECT_EQ(before.spindle, 3);
  EXPECT_EQ(before.speed, 700);
  EXPECT_EQ(before.parameters.at(5221), 2);
  EXPECT_EQ(session.fake.at()[0], 7);
}

// Each motion begins with the modes set by earlier lines.
TEST(Controller, RemembersModesBetweenMotions) {
  Session session;
  session.begun();
  for (const char* const line : {"G20", "G91", "F10", "G1X1", "G43.1Z1", "X1", "G18", "G2X1I0.5", "G21", "X10Z10R10"}) {
    EXPECT_EQ(session.last(line), "ok") << line;
  }
  EXPECT_NEAR(session.fake.at()[0], 3 * 25.4 + 10, 1e-9);
  EXPECT_NEAR(session.fake.at()[2], 10, 1e-9);
  EXPECT_NEAR(session.fake.motions[0].feed, 254 / 60.0, 1e-9);
}

TEST(Controller, AnswersADwellWhenItHasEnded) {
  Session session;
  session.begun();
  Texts during{"none"};
  session.script([] {}, [] {}, [&] { during = session.answers(); });
  session.put("G0X1\nG4P1.5\nG0X2\n");
  session.settle();
  EXPECT_EQ(during, oks(1)) << "the motion's";
  EXPECT_EQ(session.answers(), oks(2));
  ASSERT_THAT(session.fake.motions, SizeIs(3));
  EXPECT_EQ(session.fake.motions[1].seconds, 1.5);
}

TEST(Controller, PausesAtM0UntilItIsResumed) {
  Session session;
  session.begun();
  session.put("G0X1\nM0\nG0X2\n");
  session.settle();
  EXPECT_EQ(session.answers(), oks(1));
  EXPECT_EQ(session.state(), "Hold:0");
  EXPECT_EQ(session.fake.at()[0], 1);
  session.put("~");
  session.settle();
  EXPECT_EQ(session.answers(), oks(2));
  EXPECT_EQ(session.fake.at()[0], 2);
  EXPECT_EQ(session.state(), "Idle");
}

TEST(Controller, DoesWhatAPausesLineSaysFirst) {
  Session session;
  session.begun();
  session.put("M3S400G0X1M0\n");
  session.settle();
  EXPECT_EQ(session.state(), "Hold:0");
  EXPECT_EQ(session.fake.at()[0], 1);
  ASSERT_FALSE(session.fake.motions.empty());
  EXPECT_EQ(session.fake.motions.front().set, 1U) << "the spindle's output";
  EXPECT_THAT(session.answers(), IsEmpty());
  session.put("~");
  session.settle();
  EXPECT_EQ(session.answers(), oks(1));
}

TEST(Controller, ForgetsAPauseAtAReset) {
  Session session;
  session.begun();
  session.put("M0\n");
  session.settle();
  session.put("\x18");
  session.settle();
  EXPECT_THAT(session.answers(), ElementsAre(kGreeting));
  session.put("!~");
  EXPECT_EQ(session.ask("G0X1"), oks(1)) << "no answer is left";
}

TEST(Controller, TellsTheEndOfAProgram) {
  for (const char* const line : {"M2", "M30"}) {
    Session session;
    session.begun();
    session.put("G55G91G0X1M3S100\n\x91\x96\x9A");
    session.settle();
    session.answers();
    EXPECT_THAT(session.ask(line), ElementsAre("[MSG:Pgm End]", "ok"));
    EXPECT_THAT(session.ask("$G"), ElementsAre("[GC:G1 G54 G17 G21 G90 G94 M5 M9 T0 F0 S100]", "ok"));
    EXPECT_EQ(session.field("Ov"), "100,100,100") << "as Grbl's RESTORE_OVERRIDES_AFTER_PROGRAM_END";
    EXPECT_EQ(session.fake.feeds.back(), 100);
    EXPECT_EQ(session.fake.rapids.back(), 100);
  }
}

TEST(Controller, ChecksProgramsWithoutMotion) {
  Session session;
  session.begun();
  EXPECT_THAT(session.ask("$C"), ElementsAre("[MSG:Enabled]", "ok"));
  EXPECT_EQ(session.state(), "Check");
  session.put("G0X5\nG1X1\nG4P10\nM0\nG38.2Z-1F10\nM3S100\nM2\nG2X1\n");
  session.settle();
  EXPECT_THAT(session.answers(),
              ElementsAre("ok", "error:22", "ok", "ok", "ok", "ok", "[MSG:Pgm End]", "ok", "error:35"));
  EXPECT_THAT(session.fake.motions, IsEmpty());
  EXPECT_EQ(session.state(), "Check");
  EXPECT_THAT(session.ask("$C"), ElementsAre("[MSG:Disabled]", "ok", kGreeting));
  EXPECT_EQ(session.state(), "Idle");
  EXPECT_EQ(session.field("MPos"), "0.000,0.000,0.000");
  EXPECT_THAT(session.ask("$G"), ElementsAre("[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]", "ok"));
  session.ask("G91G0X1");
  EXPECT_EQ(session.field("MPos"), "1.000,0.000,0.000") << "from where the machine stands";
}

TEST(Controller, RunsStartupLinesAfterItsBanner) {
  Session session;
  session.begun();
  EXPECT_THAT(session.ask("$N"), ElementsAre("$N0=", "$N1=", "ok"));
  EXPECT_EQ(session.last("$N0=G20 G55"), "ok");
  EXPECT_EQ(session.last("$N1=G1X1"), "error:22") << "checked before it is kept";
  EXPECT_EQ(session.last("$N1=G91"), "ok");
  EXPECT_THAT(session.ask("$N"), ElementsAre("$N0=G20G55", "$N1=G91", "ok"));
  session.put("\x18");
  session.settle();
  EXPECT_THAT(session.answers(), ElementsAre(kGreeting, ">G20G55:ok", ">G91:ok"));
  EXPECT_THAT(session.ask("$G"), Contains("[GC:G0 G55 G17 G20 G91 G94 M5 M9 T0 F0 S0]"));
  EXPECT_EQ(session.last("$N0="), "ok");
  EXPECT_THAT(session.ask("$N"), ElementsAre("$N0=", "$N1=G91", "ok"));
}

TEST(Controller, AnswersStartupLinesThatWaitInTheirPlace) {
  Session session;
  session.settings.set_startup(0, "G0X3");
  session.settings.set_startup(1, "G4P1");
  session.controller.begin();
  session.settle();
  EXPECT_THAT(session.answers(), ElementsAre(kGreeting, ">G0X3:ok", ">G4P1:ok"));
  EXPECT_THAT(session.fake.motions, SizeIs(2));
  EXPECT_EQ(session.state(), "Idle");
}

TEST(Controller, TellsStartupLinesThatAreWrong) {
  Session session;
  session.settings.set_startup(0, "G1X3");
  session.settings.set_startup(1, "G21");
  session.controller.begin();
  EXPECT_THAT(session.answers(), ElementsAre(kGreeting, ">G1X3:error:22", ">G21:ok"));
}

TEST(Controller, KeepsStartupLinesBackWhileItIsLocked) {
  Session session;
  session.settings.set_startup(0, "G20");
  session.fake.trouble_now = {false, Alarm::kPositionLost, "the place is not known", std::nullopt};
  session.controller.begin();
  EXPECT_THAT(session.answers(), ElementsAre(kGreeting, "[MSG:the place is not known]", "[MSG:'$H'|'$X' to unlock]"));
  // The unlock runs no startup lines, as in Grbl: they could move the machine, whose place is not known.
  EXPECT_THAT(session.ask("$X"), ElementsAre("[MSG:Caution: Unlocked]", "ok"));
}

// The bytes that bCNC sends at the end of a program.
TEST(Controller, KeepsItsPlaceThroughBcncsEndOfJob) {
  Session session;
  session.begun();
  session.put("G55\nG0X12.5Y3\n");
  session.settle();
  EXPECT_EQ(session.state(), "Idle");
  session.put("!");
  for (int n = 0; n < 100; ++n) session.controller.work();
  session.put("\x18");
  session.settle();
  session.answers();
  EXPECT_THAT(session.ask("G43.1Z0"), ElementsAre("ok"));
  EXPECT_THAT(session.ask("$G"), ElementsAre("[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]", "ok"));
  EXPECT_EQ(session.state(), "Idle");
  EXPECT_EQ(session.field("MPos"), "12.500,3.000,0.000");
  session.ask("G91G0X1");
  EXPECT_EQ(session.field("MPos"), "13.500,3.000,0.000");
}

TEST(Controller, ReportsPlacesWithOffsets) {
  Session session;
  session.begun();
  session.put("G10L2P1X10Z-1\nG92Y2\nG43.1Z0.5\nG0X1Y3Z1\n");
  session.settle();
  EXPECT_EQ(session.field("MPos"), "11.000,1.000,0.500");
  EXPECT_EQ(session.last("$10=0"), "ok");
  EXPECT_EQ(session.field("WPos"), "1.000,3.000,1.000");
  session.ask("G54");
  EXPECT_EQ(session.field("WCO"), "10.000,-2.000,-0.500");
  EXPECT_THAT(session.ask("$#"),
              ElementsAre("[G54:10.000,0.000,-1.000]", "[G55:0.000,0.000,0.000]", "[G56:0.000,0.000,0.000]",
                          "[G57:0.000,0.000,0.000]", "[G58:0.000,0.000,0.000]", "[G59:0.000,0.000,0.000]",
                          "[G28:0.000,0.000,0.000]", "[G30:0.000,0.000,0.000]", "[G92:0.000,-2.000,0.000]",
                          "[TLO:0.500]", "[PRB:0.000,0.000,0.000:0]", "ok"));
}

TEST(Controller, ReportsInches) {
  Session session;
  session.begun();
  session.put("G0X25.4Y-12.7\nG10L2P1Z50.8\nG43.1Z2.54\nF254\n");
  session.settle();
  EXPECT_EQ(session.last("$13=1"), "ok");
  session.answers();
  session.fake.live.speed = 2540;
  EXPECT_EQ(session.field("MPos"), "1.0000,-0.5000,0.0000");
  EXPECT_EQ(session.field("FS"), "100,0");
  const Texts offsets = session.ask("$#");
  EXPECT_THAT(offsets, Contains("[G54:0.0000,0.0000,2.0000]"));
  EXPECT_THAT(offsets, Contains("[TLO:0.1000]"));
  EXPECT_THAT(offsets, Contains("[PRB:0.0000,0.0000,0.0000:0]"));
  EXPECT_THAT(session.ask("$G"), Contains("[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F10.0 S0]"));
}

TEST(Controller, ReportsPinsSpindleAndLineNumbers) {
  Session session;
  session.begun();
  session.fake.live.limits = 5;
  session.fake.live.probe = true;
  EXPECT_EQ(session.field("Pn"), "PXZ");
  session.fake.live.limits = 0;
  session.fake.live.probe = false;
  EXPECT_EQ(session.field("Pn"), "");
  session.ask("M3S1200M8");
  EXPECT_EQ(session.field("FS"), "0,1200");
  session.ask("M4M7");
  EXPECT_EQ(session.field("A"), "CFM");
  session.ask("M5M9");
  EXPECT_EQ(session.field("FS"), "0,0");
  EXPECT_EQ(session.field("A"), "");
  std::string first;
  std::string second;
  session.script([&] { first = session.field("Ln"); }, [] {}, [&] { second = session.field("Ln"); });
  session.put("N10G1X1F100\nN20X2\n");
  session.settle();
  EXPECT_EQ(first, "10");
  EXPECT_EQ(second, "20");
  EXPECT_EQ(session.field("Ln"), "");
}

// A settings file that cannot be written does not stop a program.
TEST(Controller, TellsThatSettingsAreNotKept) {
  Session session(router(), "/nonexistent/settings");
  session.begun();
  EXPECT_THAT(session.ask("$110=600"), ElementsAre(testing::HasSubstr("/nonexistent/settings"), "ok"));
  EXPECT_THAT(session.ask("$110=600.5"), Contains("ok"));
  EXPECT_THAT(session.ask("G10L2P1X1"), ElementsAre(testing::HasSubstr("/nonexistent/settings"), "ok"));
  EXPECT_THAT(session.ask("G0X1"), ElementsAre("ok"));
  EXPECT_EQ(session.fake.at()[0], 2);
}

TEST(Controller, ChangesTheMachineBySettings) {
  Session session;
  session.begun();
  EXPECT_EQ(session.last("$110=600"), "ok");
  EXPECT_EQ(session.fake.settings_taken, 1U);
  EXPECT_EQ(session.fake.machine().axes[0].max_velocity, 10);
  EXPECT_EQ(session.last("$13=0"), "ok");
  EXPECT_EQ(session.fake.settings_taken, 1U) << "nothing of the machine's";
  EXPECT_EQ(session.last("$110=-1"), "error:4");
  EXPECT_EQ(session.fake.settings_taken, 1U);
}

TEST(Controller, RestoresDefaultsAndResets) {
  Session session;
  session.begun();
  session.put("$110=600\nG10L2P2X5\n$N0=G20\n$I=MINE\n");
  session.settle();
  session.answers();
  EXPECT_THAT(session.ask("$RST=$"), ElementsAre("[MSG:Restoring defaults]", "ok", kGreeting, ">G20:ok"));
  EXPECT_EQ(session.fake.machine().axes[0].max_velocity, 50);
  EXPECT_THAT(session.ask("$#"), Contains("[G55:5.000,0.000,0.000]"));
  EXPECT_THAT(session.ask("$RST=#"), ElementsAre("[MSG:Restoring defaults]", "ok", kGreeting, ">G20:ok"));
  EXPECT_THAT(session.ask("$#"), Contains("[G55:0.000,0.000,0.000]"));
  EXPECT_THAT(session.ask("$I"), ElementsAre(StartsWith("[VER:1.1h."), "[OPT:VNMH,15,128]", "ok"));
  EXPECT_THAT(session.ask("$I").front(), testing::EndsWith(":MINE]"));
  EXPECT_THAT(session.ask("$RST=*"), ElementsAre("[MSG:Restoring defaults]", "ok", kGreeting));
  EXPECT_THAT(session.ask("$N"), ElementsAre("$N0=", "$N1=", "ok"));
  EXPECT_THAT(session.ask("$I").front(), Not(testing::EndsWith(":MINE]")));
}

}  // namespace
}  // namespace trammel::grbl
