// The answer to each command in each state.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>

#include "session.hpp"

namespace trammel::grbl {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

using Answers = std::map<std::string, std::string>;

// Checks the last answer to each line in the state that `enter` sets up. Each line gets a new session.
void expect_in_state(const std::string& state, const std::function<void(Session&)>& enter, const Answers& answers) {
  for (const auto& [line, answer] : answers) {
    Session session(fenced_router());
    session.begun();
    enter(session);
    ASSERT_EQ(session.state(), state);
    session.answers();
    EXPECT_EQ(session.last(line), answer) << state << ": " << line;
  }
}

// The same, while the machine executes `motion`.
void expect_in_motion(const std::string& state, const std::string& motion, const Answers& answers) {
  for (const auto& [line, answer] : answers) {
    Session session(fenced_router());
    session.begun();
    session.fake.ticks_a_motion = 6;
    std::string met;
    std::vector<std::string> during;
    session.script([&] { met = session.state(); }, [&] { session.answers(); },
                   [&, asked = line] { session.put(asked + "\n"); }, [&] { during = session.answers(); });
    session.put(motion + "\n");
    session.settle();
    EXPECT_EQ(met, state);
    ASSERT_FALSE(during.empty()) << line;
    EXPECT_EQ(during.back(), answer) << state << ": " << line;
  }
}

TEST(States, IdleTakesAllCommands) {
  expect_in_state("Idle", [](Session&) {},
                  {{"", "ok"},
                   {"$", "ok"},
                   {"$G", "ok"},
                   {"$$", "ok"},
                   {"$#", "ok"},
                   {"$I", "ok"},
                   {"$N", "ok"},
                   {"$X", "ok"},
                   {"$C", "ok"},
                   {"$N0=G21", "ok"},
                   {"$0=5", "ok"},
                   {"$I=ME", "ok"},
                   {"G0X-1", "ok"},
                   {"$H", "ok"},
                   {"$HX", "ok"},
                   {"$J=X-1F100", "ok"}});
}

TEST(States, WrongCommandsHaveGrblsNumbers) {
  expect_in_state("Idle", [](Session&) {},
                  {{"$Q", "error:2"},      {"$=1", "error:2"},      {"$5", "error:3"},      {"$$$", "error:3"},
                   {"$GX", "error:3"},     {"$CC", "error:3"},      {"$XX", "error:3"},     {"$J", "error:3"},
                   {"$JX1", "error:3"},    {"$#1", "error:3"},      {"$S", "error:3"},      {"$SLEEP", "error:3"},
                   {"$I1", "error:3"},     {"$R", "error:3"},       {"$RST", "error:3"},    {"$RST=X", "error:3"},
                   {"$RST=$$", "error:3"}, {"$N0", "error:3"},      {"$N2=G21", "error:3"}, {"$N=G21", "error:2"},
                   {"$NX=G21", "error:2"}, {"$0=", "error:2"},      {"$0=X", "error:2"},    {"$0=5X", "error:3"},
                   {"$0=1E3", "error:3"},  {"$0=0X10", "error:3"},  {"$0=INF", "error:2"},  {"$300=1", "error:3"},
                   {"$7=1", "error:3"},    {"$0=2", "error:6"},     {"$0=-5", "error:4"},   {"$1x=3", "error:3"},
                   {"$N0=G5", "error:20"}, {"$N1=G1X1", "error:22"}});
}

TEST(States, RunRefusesWhatNeedsAMachineAtRest) {
  expect_in_motion("Run", "G1X-9F100",
                   {{"$", "ok"},
                    {"$G", "ok"},
                    {"$X", "ok"},
                    {"$GX", "error:3"},
                    {"$$", "error:8"},
                    {"$#", "error:8"},
                    {"$I", "error:8"},
                    {"$N", "error:8"},
                    {"$C", "error:8"},
                    {"$H", "error:8"},
                    {"$0=5", "error:8"},
                    {"$Q", "error:8"},
                    {"$SLP", "error:8"},
                    {"$RST=$", "error:8"},
                    {"$J", "error:8"},
                    {"$J=X-1F100", "error:8"},
                    {"G0X-2", "ok"},
                    {"X-3", "ok"},
                    {"", "ok"}});
}

TEST(States, JogTakesJogsAlone) {
  expect_in_motion("Jog", "$J=X-9F100",
                   {{"$", "ok"},
                    {"$G", "ok"},
                    {"$X", "ok"},
                    {"$$", "ok"},
                    {"$J=X-1F100", "ok"},
                    {"$J=X-1", "error:22"},
                    {"$J=X1F100", "error:15"},
                    {"$J=M3X-1F100", "error:16"},
                    {"G0X-1", "error:9"},
                    {"M5", "error:9"},
                    {"$#", "error:8"},
                    {"$C", "error:8"},
                    {"$H", "error:8"},
                    {"$SLP", "error:8"},
                    {"$0=5", "error:8"},
                    {"", "ok"}});
}

void enter_alarm(Session& session) {
  session.fake.trouble_now = {false, Alarm::kHardLimit, "", std::nullopt};
  session.settle();
}

TEST(States, AlarmIsLocked) {
  expect_in_state("Alarm", enter_alarm,
                  {{"", "ok"},
                   {"$", "ok"},
                   {"$G", "ok"},
                   {"$$", "ok"},
                   {"$#", "ok"},
                   {"$I", "ok"},
                   {"$N", "ok"},
                   {"$X", "ok"},
                   {"$0=5", "ok"},
                   {"$H", "ok"},
                   {"$N0=G21", "error:8"},
                   {"$C", "error:8"},
                   {"$J=X-1F100", "error:8"},
                   {"$J", "error:8"},
                   {"G0X1", "error:9"},
                   {"G21", "error:9"},
                   {"nonsense", "error:9"}});
}

TEST(States, CheckRefusesWhatIsNoProgram) {
  expect_in_state("Check", [](Session& session) { session.ask("$C"); },
                  {{"", "ok"},
                   {"$", "ok"},
                   {"$G", "ok"},
                   {"$$", "ok"},
                   {"$X", "ok"},
                   {"$#", "error:8"},
                   {"$I", "error:8"},
                   {"$N", "error:8"},
                   {"$N0=G21", "error:8"},
                   {"$0=5", "error:8"},
                   {"$H", "error:8"},
                   {"$SLP", "error:8"},
                   {"$J=X-1F100", "error:8"},
                   {"G0X-1", "ok"},
                   {"G1X-1", "error:22"},
                   {"M6", "error:20"}});
}

// In a hold no line is answered. The lines are executed when it ends.
TEST(States, HoldAndDoorAnswerNothingUntilTheyEnd) {
  for (const auto& [byte, state] : std::map<std::string, std::string>{{"!", "Hold:0"}, {"\x84", "Door:0"}}) {
    Session session;
    session.begun();
    session.put(byte);
    EXPECT_EQ(session.state(), state);
    session.answers();
    EXPECT_THAT(session.ask("G0X1"), IsEmpty());
    EXPECT_THAT(session.ask("$G"), IsEmpty());
    EXPECT_THAT(session.ask("$J=X2F100"), IsEmpty());
    EXPECT_EQ(session.fake.at()[0], 0);
    session.put("~");
    session.settle();
    EXPECT_EQ(session.answers().size(), 4U) << "ok, $G's two, and one for the jog";
    EXPECT_EQ(session.fake.at()[0], 1);
    EXPECT_EQ(session.state(), "Idle");
  }
}

TEST(States, SleepEndsWithAResetAlone) {
  Session session;
  session.begun();
  EXPECT_THAT(session.ask("$SLP"), testing::UnorderedElementsAre("[MSG:Sleeping]", "ok"));
  EXPECT_EQ(session.state(), "Sleep");
  EXPECT_THAT(session.ask("$X"), IsEmpty());
  session.put("~!\x84\x85");
  EXPECT_THAT(session.ask("G0X1"), IsEmpty());
  EXPECT_EQ(session.state(), "Sleep");
  session.put("\x18");
  session.settle();
  EXPECT_THAT(session.answers(), testing::Contains("[MSG:'$H'|'$X' to unlock]"));
  EXPECT_EQ(session.state(), "Alarm");
  EXPECT_THAT(session.ask("$X"), ElementsAre("[MSG:Caution: Unlocked]", "ok"));
  EXPECT_EQ(session.state(), "Idle");
}

TEST(States, UnlockTellsWhenSomethingStays) {
  Session session;
  session.begun();
  enter_alarm(session);
  session.answers();
  session.fake.unlock_leaves = {false, Alarm::kEmergencyStop, "the emergency stop is pressed", std::nullopt};
  EXPECT_THAT(session.ask("$X"), ElementsAre("[MSG:the emergency stop is pressed]", "error:9"));
  EXPECT_EQ(session.state(), "Alarm");
  session.fake.unlock_leaves = {};
  EXPECT_THAT(session.ask("$X"), ElementsAre("[MSG:Caution: Unlocked]", "ok"));
  EXPECT_EQ(session.state(), "Idle");
  EXPECT_EQ(session.last("G0X1"), "ok");
}

TEST(States, UnlockTakesThePlaceOfTheMachine) {
  Session session;
  session.begun();
  enter_alarm(session);
  session.fake.live.at[0] = 33;
  session.ask("$X");
  session.ask("G91G0X1");
  EXPECT_EQ(session.fake.at()[0], 34);
}

// A machine that requires homing.
TEST(States, BeginsLockedWhereHomingIsDue) {
  machine::Machine machine = fenced_router();
  machine.require_home = true;
  Session session(machine);
  session.fake.is_homed = false;
  session.controller.begin();
  EXPECT_THAT(session.answers(), ElementsAre("Grbl 1.1h ['$' for help]", "[MSG:'$H'|'$X' to unlock]"));
  EXPECT_EQ(session.state(), "Alarm");
  EXPECT_EQ(session.last("$H"), "ok");
  EXPECT_EQ(session.state(), "Idle");
  session.put("\x18");
  session.settle();
  EXPECT_EQ(session.state(), "Idle") << "homed it stays";
}

}  // namespace
}  // namespace trammel::grbl
