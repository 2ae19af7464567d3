// Real-time commands: holds, cancelled jogs, resets and overrides, in each state.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "session.hpp"

namespace trammel::grbl {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

const char* const kHello = "Grbl 1.1h ['$' for help]";

TEST(RealTime, HoldsAMotionAndGoesOn) {
  Session session;
  session.begun();
  session.fake.ticks_a_motion = 8;
  std::vector<std::string> states;
  const auto look = [&] { states.push_back(session.state()); };
  session.script(
      look,
      [&] {
        session.put("!");
        look();
      },
      [] {}, [] {}, look,
      [&] {
        session.put("~");
        look();
      });
  session.put("G1X10F100\n");
  session.settle();
  EXPECT_THAT(states, ElementsAre("Run", "Hold:1", "Hold:0", "Run"));
  EXPECT_THAT(session.fake.holds, ElementsAre(true, false));
  EXPECT_EQ(session.fake.at()[0], 10);
  EXPECT_EQ(session.answers(), std::vector<std::string>{"ok"});
  EXPECT_EQ(session.state(), "Idle");
}

TEST(RealTime, HoldsOnceHoweverOftenItIsAsked) {
  Session session;
  session.begun();
  session.fake.ticks_a_motion = 8;
  session.script([&] { session.put("!!!"); }, [&] { session.put("!"); }, [&] { session.put("~"); });
  session.put("G1X10F100\n");
  session.settle();
  EXPECT_EQ(session.fake.at()[0], 10);
  EXPECT_EQ(session.state(), "Idle");
}

// Lines that come during a hold wait. Lines that were accepted before are kept.
TEST(RealTime, KeepsAcceptedLinesInAHold) {
  Session session;
  session.begun();
  std::vector<std::string> held;
  session.script([&] { session.put("!"); }, [] {}, [&] { session.put("G0X4\n"); }, [] {}, [] {},
                 [&] {
                   held = session.answers();
                   session.put("~");
                 });
  session.put("G0X1\nG0X2\nG0X3\n");
  session.settle();
  EXPECT_EQ(held, std::vector<std::string>(3, "ok"));
  EXPECT_EQ(session.answers(), std::vector<std::string>{"ok"});
  EXPECT_EQ(session.fake.at()[0], 4);
}

TEST(RealTime, HoldsAnIdleMachineWithoutMotion) {
  Session session;
  session.begun();
  session.put("!");
  EXPECT_EQ(session.state(), "Hold:0");
  session.put("~");
  EXPECT_EQ(session.state(), "Idle");
  session.put("~~");
  EXPECT_EQ(session.state(), "Idle");
}

TEST(RealTime, IgnoresAHoldWhereGrblDoes) {
  Session alarm;
  alarm.fake.trouble_now.alarm = Alarm::kPositionLost;
  alarm.begun();
  alarm.put("!\x84");
  EXPECT_EQ(alarm.state(), "Alarm");
  Session check;
  check.begun();
  check.ask("$C");
  check.put("!\x84");
  EXPECT_EQ(check.state(), "Check");
}

TEST(RealTime, OpensTheDoor) {
  Session session;
  session.begun();
  session.fake.ticks_a_motion = 9;
  std::vector<std::string> states;
  const auto look = [&] { states.push_back(session.state()); };
  session.script(
      [&] {
        session.put("\x84");
        look();
      },
      [&] {
        session.put("!");
        look();
      },
      [] {}, [] {}, [] {}, look,
      [&] {
        session.put("~");
        look();
      });
  session.put("G1X10F100\n");
  session.settle();
  EXPECT_THAT(states, ElementsAre("Door:2", "Door:2", "Door:0", "Run"));
  EXPECT_THAT(session.answers(), ElementsAre("ok", "[MSG:Check Door]"));
  EXPECT_EQ(session.fake.at()[0], 10);
}

TEST(RealTime, TurnsAHoldIntoAnOpenDoor) {
  Session session;
  session.begun();
  session.put("!\x84");
  EXPECT_EQ(session.state(), "Door:0");
  EXPECT_EQ(session.field("Pn"), "") << "no switch says so";
  session.put("~");
  EXPECT_EQ(session.state(), "Idle");
}

// The jog ends before its target, later jogs are dropped, and the place is that of the machine.
TEST(RealTime, CancelsJogs) {
  for (const char* const byte : {"\x85", "!"}) {
    Session session;
    session.begun();
    session.fake.ticks_a_motion = 6;
    std::string jogging;
    session.script([] {}, [&] { jogging = session.state(); }, [&] { session.put(byte); });
    session.put("$J=X10F100\n$J=X20F100\n$J=X30F100\n");
    session.settle();
    EXPECT_EQ(jogging, "Jog");
    EXPECT_EQ(session.answers(), std::vector<std::string>(3, "ok"));
    EXPECT_EQ(session.state(), "Idle");
    EXPECT_EQ(session.fake.at()[0], 5);
    EXPECT_THAT(session.fake.motions, IsEmpty());
    EXPECT_EQ(session.last("G91G0X1"), "ok");
    EXPECT_EQ(session.fake.at()[0], 6);
  }
}

// As in Grbl, reading continues when the cancelled jog is at rest: lines that follow the cancel count.
TEST(RealTime, TakesLinesBehindACancelledJog) {
  Session session;
  session.begun();
  session.fake.ticks_a_motion = 6;
  session.script([] {}, [&] { session.put("\x85$J=G91X1F100\n"); });
  session.put("$J=X10F100\n");
  session.settle();
  EXPECT_EQ(session.answers(), std::vector<std::string>(2, "ok"));
  EXPECT_EQ(session.fake.at()[0], 6) << "the second one, from where the first has ended";
  EXPECT_EQ(session.state(), "Idle");
}

TEST(RealTime, CancelsNothingButJogs) {
  Session session;
  session.begun();
  session.script([&] { session.put("\x85"); });
  session.put("G0X10\n");
  session.settle();
  EXPECT_EQ(session.fake.at()[0], 10);
  EXPECT_EQ(session.fake.stops, 0U);
  session.put("\x85");
  EXPECT_EQ(session.last("G0X1"), "ok");
}

TEST(RealTime, ResetStopsAMotionAndDropsLines) {
  Session session;
  session.begun();
  session.script([] {}, [&] { session.put("G0X7\nG0X8\x18G0X9"); });
  session.put("G0X10\nG0X20\nG4P1\n");
  session.settle();
  EXPECT_EQ(session.fake.stops, 1U);
  EXPECT_THAT(session.answers(), ElementsAre("ok", "ok", kHello));
  EXPECT_EQ(session.fake.at()[0], 5) << "stopped on its way, on a ramp: the place is known";
  EXPECT_EQ(session.state(), "Idle");
  session.put("\n");
  session.settle();
  EXPECT_EQ(session.fake.at()[0], 9) << "bytes behind the reset are a new line";
}

TEST(RealTime, ResetsInEachState) {
  const auto reset = [](const std::function<void(Session&)>& enter) {
    Session session(fenced_router());
    session.begun();
    enter(session);
    session.answers();
    session.put("\x18");
    session.settle();
    EXPECT_THAT(session.answers(), Contains(kHello));
    return session.state();
  };
  EXPECT_EQ(reset([](Session&) {}), "Idle");
  EXPECT_EQ(reset([](Session& session) { session.put("!"); }), "Idle");
  EXPECT_EQ(reset([](Session& session) { session.put("\x84"); }), "Idle");
  EXPECT_EQ(reset([](Session& session) { session.ask("$C"); }), "Idle");
  EXPECT_EQ(reset([](Session& session) { session.ask("M0"); }), "Idle");
  EXPECT_EQ(reset([](Session& session) { session.ask("$SLP"); }), "Alarm");
  EXPECT_EQ(reset([](Session& session) { session.ask("G0X1"); }), "Alarm") << "a soft limit's";
}

TEST(RealTime, ResetEndsAHoldInAMotion) {
  Session session;
  session.begun();
  session.script([] {}, [&] { session.put("!"); }, [] {}, [] {}, [&] { session.put("\x18"); });
  session.put("G0X10\n");
  session.settle();
  EXPECT_THAT(session.answers(), ElementsAre("ok", kHello));
  EXPECT_EQ(session.state(), "Idle");
  EXPECT_EQ(session.fake.holds.back(), false);
  EXPECT_EQ(session.last("G0X1"), "ok");
  EXPECT_EQ(session.fake.at()[0], 1);
}

TEST(RealTime, ResetEndsADwellAndAJogWithoutAnswer) {
  for (const auto& [line, count] : std::vector<std::pair<std::string, std::size_t>>{{"G4P5", 0}, {"$J=X9F100", 1}}) {
    Session session;
    session.begun();
    session.script([] {}, [&] { session.put("\x18"); });
    session.put(line + "\n");
    session.settle();
    EXPECT_THAT(session.answers(), SizeIs(count + 1)) << line;
    EXPECT_EQ(session.state(), "Idle");
    EXPECT_EQ(session.last("G0X1"), "ok");
  }
}

TEST(RealTime, ResetForgetsAsGrbl) {
  Session session;
  session.begun();
  session.put("G10L2P2X5\nG55G20G91\nG92Y9\nG43.1Z1\nF10M3S1000\n\x91\x96\x9A");
  session.settle();
  session.fake.edge = 0.5;
  session.ask("G38.2Z-1F10");
  session.put("\x18");
  session.settle();
  EXPECT_EQ(session.field("Ov"), "100,100,100");
  EXPECT_THAT(session.ask("$G"), Contains("[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]"));
  const std::vector<std::string> offsets = session.ask("$#");
  EXPECT_THAT(offsets, Contains("[G55:5.000,0.000,0.000]"));
  EXPECT_THAT(offsets, Contains("[G92:0.000,0.000,0.000]"));
  EXPECT_THAT(offsets, Contains("[TLO:0.000]"));
  EXPECT_THAT(offsets, Contains("[PRB:0.000,0.000,0.000:0]"));
}

std::string after_bytes(const std::string& bytes) {
  Session session;
  session.begun();
  session.put(bytes);
  return session.field("Ov");
}

TEST(RealTime, OverridesFeedsBetween10And200) {
  EXPECT_EQ(after_bytes("\x91"), "110,100,100");
  EXPECT_EQ(after_bytes("\x92"), "90,100,100");
  EXPECT_EQ(after_bytes("\x93"), "101,100,100");
  EXPECT_EQ(after_bytes("\x94"), "99,100,100");
  EXPECT_EQ(after_bytes(std::string(30, '\x91')), "200,100,100");
  EXPECT_EQ(after_bytes(std::string(30, '\x92')), "10,100,100");
  EXPECT_EQ(after_bytes(std::string(9, '\x92') + "\x94\x94"), "10,100,100");
  EXPECT_EQ(after_bytes(std::string(10, '\x91') + "\x93"), "200,100,100");
  EXPECT_EQ(after_bytes("\x91\x91\x93\x90"), "100,100,100");
}

TEST(RealTime, OverridesRapids) {
  EXPECT_EQ(after_bytes("\x96"), "100,50,100");
  EXPECT_EQ(after_bytes("\x97"), "100,25,100");
  EXPECT_EQ(after_bytes("\x97\x95"), "100,100,100");
}

TEST(RealTime, OverridesTheSpindleBetween10And200) {
  EXPECT_EQ(after_bytes("\x9A"), "100,100,110");
  EXPECT_EQ(after_bytes("\x9B"), "100,100,90");
  EXPECT_EQ(after_bytes("\x9C"), "100,100,101");
  EXPECT_EQ(after_bytes("\x9D"), "100,100,99");
  EXPECT_EQ(after_bytes(std::string(30, '\x9A')), "100,100,200");
  EXPECT_EQ(after_bytes(std::string(30, '\x9B')), "100,100,10");
  EXPECT_EQ(after_bytes("\x9A\x99"), "100,100,100");
}

TEST(RealTime, IgnoresBytesThatGrblLacks) {
  for (int byte = 0x80; byte < 256; ++byte) {
    const bool known = byte == 0x84 || (byte >= 0x90 && byte <= 0x97) || (byte >= 0x99 && byte <= 0x9D);
    if (known) continue;
    Session session;
    session.begun();
    session.put(std::string(1, static_cast<char>(byte)));
    EXPECT_EQ(session.state(), "Idle") << byte;
    EXPECT_EQ(session.field("Ov"), "100,100,100") << byte;
    EXPECT_THAT(session.answers(), IsEmpty()) << byte;
  }
}

TEST(RealTime, TellsTheMachineOfOverridesAtOnce) {
  Session session;
  session.begun();
  session.script([] {}, [&] { session.put("\x91\x97"); });
  session.put("G1X1F100\n");
  session.settle();
  EXPECT_THAT(session.fake.feeds, ElementsAre(110));
  EXPECT_THAT(session.fake.rapids, ElementsAre(25));
}

// The machine allows a feed override of at most 150 %.
TEST(RealTime, ReportsTheOverrideThatTheMachineAllows) {
  Session session;
  session.begun();
  session.fake.most_feed_override = 150;
  session.put(std::string(10, '\x91'));
  EXPECT_EQ(session.field("Ov"), "150,100,100");
  session.put("\x92");
  EXPECT_EQ(session.field("Ov"), "140,100,100");
}

TEST(RealTime, AnswersAReportWhereverItStands) {
  Session session;
  session.begun();
  session.fake.ticks_a_motion = 4;
  std::vector<std::string> places;
  session.script([] {}, [&] { places.push_back(session.field("MPos")); }, [] {}, [] {}, [] {},
                 [&] { places.push_back(session.field("MPos")); });
  session.put("G0X1\nG0X2\n");
  session.settle();
  EXPECT_THAT(places, ElementsAre("0.000,0.000,0.000", "1.000,0.000,0.000"));
  session.put("?G?0?X?3?\n");
  session.settle();
  EXPECT_EQ(session.fake.at()[0], 3);
  EXPECT_EQ(session.answers().size(), 8U) << "two ok and six reports";
}

// A button at the machine causes a hold without the controller.
TEST(RealTime, ShowsTheMachinesOwnHoldAndEndsIt) {
  Session session;
  session.begun();
  session.fake.ticks_a_motion = 6;
  std::vector<std::string> states;
  session.script([&] { session.fake.hold(true); }, [] {}, [] {}, [] {},
                 [&] {
                   states.push_back(session.state());
                   session.put("~");
                 },
                 [&] { states.push_back(session.state()); });
  session.put("G0X1\n");
  session.settle();
  EXPECT_THAT(states, ElementsAre("Hold:0", "Run"));
  EXPECT_EQ(session.fake.at()[0], 1);
}

}  // namespace
}  // namespace trammel::grbl
