// The machine's place on a served card: the start of commands, what they refuse, and what sets the place.
#include <gmock/gmock.h>

#include "command.hpp"
#include "server.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/transport/card_url.hpp"
#include "trammel/transport/connection.hpp"

namespace trammel::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kFirst = "the card was reset: machine zero is where it stands now";
constexpr const char* kLost = "the place of X was lost";

class PlaceOfACard : public ::testing::Test {
 protected:
  Outcome run(const std::string& text, const std::string& options = "") {
    return command_.run("run " + command_.write("p.ngc", text) + options + moving());
  }
  Outcome zero(const std::string& what) { return command_.run("zero " + what + moving()); }
  std::string position(const std::string& options = "") {
    const Outcome outcome = command_.run("position" + options + " --card " + server_.url());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  }
  std::string recover() {
    const Outcome outcome = command_.run("recover --card " + server_.url());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  }
  std::string moving() const { return " --card " + server_.moving(); }
  static void expect_refused(const Outcome& outcome, const std::string& message) {
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr(message));
    EXPECT_EQ(outcome.out, "");
  }
  // Moves X and aborts the motion.
  void cut_off() {
    transport::Connection connection(transport::parse_card_url(server_.url() + "?token=secret"));
    driver::Card card = driver::Card::open(connection.bus());
    card.take_over();
    driver::Stream stream(card, {});
    driver::LineCommand line;
    driver::FeedCommand feed;
    line.ticks = feed.ticks = 1'000'000;
    line.mask = 1;
    line.increment[0] = (std::int64_t{1} << 40) / 100;
    feed.rate = std::uint64_t{1} << 60;
    stream.send({feed, line});
    stream.flush();
    const std::int32_t from = card.read_snapshot().position[0];
    while (card.read_snapshot().position[0] < from + 20) card.bus().sleep(std::chrono::milliseconds(5));
    card.abort();
  }

  Command command_;
  Server server_{command_, "--engine model --fast"};
};

TEST_F(PlaceOfACard, OfTwoRunsTheSecondBeginsWhereTheFirstEnded) {
  EXPECT_THAT(position(), HasSubstr("no position since the card's reset"));
  const Outcome first = run("G91 G1 X10 F6000\n");
  EXPECT_EQ(first.status, 0);
  EXPECT_THAT(first.err, HasSubstr(kFirst));
  EXPECT_THAT(position(), HasSubstr("X      10.0000 mm       valid, not homed\n"));
  const Outcome second = run("G90 G1 X0 F6000\n");
  EXPECT_EQ(second.status, 0);
  EXPECT_THAT(second.err, AllOf(HasSubstr("the machine stands at X 10.0000"), Not(HasSubstr(kFirst))));
  EXPECT_THAT(second.out, HasSubstr("X: ends at pulse 0 (0.0000 mm)"));
  EXPECT_THAT(server_.end(), HasSubstr("path: 1600 steps"));
}

TEST_F(PlaceOfACard, ALineSetsItAndARunTakesItOver) {
  const Outcome line = command_.run("line --to 80,0" + moving());
  EXPECT_EQ(line.status, 0);
  EXPECT_THAT(line.err, HasSubstr(kFirst));
  EXPECT_EQ(command_.run("line --to 80,0 --no-ramp" + moving()).err, "");
  EXPECT_THAT(position(), HasSubstr("X       2.0000 mm       valid"));
  const Outcome program = run("G1 X3 F600\n");
  EXPECT_THAT(program.err, HasSubstr("the machine stands at X 2.0000"));
  EXPECT_THAT(program.out, HasSubstr("X: ends at pulse 240"));
}

// A card that something else has moved since its reset.
TEST_F(PlaceOfACard, TheFirstRunSetsZeroWhereTheCardStands) {
  cut_off();
  EXPECT_THAT(position(), HasSubstr("no position since the card's reset"));
  const Outcome first = run("G1 X1 F6000\n");
  EXPECT_THAT(first.err, AllOf(HasSubstr(kFirst), Not(HasSubstr("stands at"))));
  EXPECT_THAT(first.out, HasSubstr("X: ends at pulse 80"));
  EXPECT_THAT(position(), HasSubstr("X       1.0000 mm       valid, not homed\n"));
}

TEST_F(PlaceOfACard, ZeroSetsTheNamedAxesHere) {
  ASSERT_EQ(run("G1 X10 Y20 F6000\n").status, 0);
  EXPECT_THAT(zero("X").out, AllOf(HasSubstr("X       0.0000 mm"), HasSubstr("Y      20.0000 mm")));
  EXPECT_THAT(run("G1 X5 Y21 F6000\n").out,
              AllOf(HasSubstr("X: ends at pulse 400"), HasSubstr("Y: ends at pulse 1680")));
  expect_refused(zero("W"), "the machine has no axis W");
  EXPECT_THAT(zero("x y").out, AllOf(HasSubstr("X       0.0000 mm"), HasSubstr("Y       0.0000 mm")));
}

TEST_F(PlaceOfACard, ZeroOfABeltMovesNoOtherAxis) {
  const std::string corexy = " --set kinematics.name=\"'corexy'\"";
  ASSERT_EQ(run("G1 X10 Y4 F6000\n", corexy).status, 0);
  EXPECT_THAT(zero("X" + corexy).out, AllOf(HasSubstr("X       0.0000 mm"), HasSubstr("Y       4.0000 mm")));
  cut_off();
  expect_refused(zero("X" + corexy), "the place of X Y was lost, and they share motors: name them together");
  EXPECT_EQ(zero("X Y" + corexy).status, 0);
}

TEST_F(PlaceOfACard, APlaceThatWasLostIsRefused) {
  ASSERT_EQ(run("G1 X1 F6000\n").status, 0);
  cut_off();
  EXPECT_THAT(recover(), HasSubstr("path     at an unknown place of its path"));
  expect_refused(run("G1 Y1 F600\n"), kLost);
  expect_refused(command_.run("line --to 10,0" + moving()), "the place of axis 0 was lost");
  EXPECT_EQ(command_.run("line --to 0,10" + moving()).status, 0) << "of an axis that stood";
  EXPECT_THAT(recover(), AllOf(HasSubstr("place lost, not homed\n"), HasSubstr("`trammel zero X`")));
  EXPECT_EQ(zero("X").status, 0);
  EXPECT_EQ(run("G1 X1 F600\n").status, 0);
  EXPECT_THAT(recover(), AllOf(HasSubstr("stopped  by no fault\n"), HasSubstr("it begins here")));
}

TEST_F(PlaceOfACard, AnAxisThatKeepsItsPlaceLosesNone) {
  const std::string keeps = " --set axis.x.keeps_place=true";
  ASSERT_EQ(run("G1 X1 F6000\n", keeps).status, 0);
  EXPECT_THAT(position(), AllOf(HasSubstr("X       1.0000 mm       valid, not homed, keeps its place\n"),
                                HasSubstr("Y       0.0000 mm       valid, not homed\n")));
  cut_off();
  EXPECT_EQ(run("G1 X1 F6000\n", keeps).status, 0);
  EXPECT_EQ(command_.run("line --to 0,10 --set axis.y.keeps_place=true" + moving()).status, 0);
  EXPECT_THAT(position(), AllOf(HasSubstr("X       1.0000 mm       valid, not homed\n"),
                                HasSubstr("Y       0.1250 mm       valid, not homed, keeps its place\n")));
  EXPECT_EQ(command_.run("jog X1 Y-0.125" + moving()).status, 0);
  EXPECT_THAT(position(), HasSubstr("Y       0.0000 mm       valid, not homed\n"));
  cut_off();
  expect_refused(run("G1 X1 F600\n"), kLost);
}

TEST_F(PlaceOfACard, WhoKnowsBetterTrustsIt) {
  ASSERT_EQ(run("G1 X1 F6000\n").status, 0);
  cut_off();
  EXPECT_EQ(run("G1 X1 F600\n", " --trust-position").status, 0);
  EXPECT_EQ(run("G1 X1 F600\n").status, 0) << "it is valid again";
  expect_refused(command_.run("line --to 1 --trust-position"), "needs --card");
}

TEST_F(PlaceOfACard, OtherScalesAreRefused) {
  ASSERT_EQ(run("G1 X1 F6000\n").status, 0);
  for (const std::string& other : {std::string("steps_per_mm=40"), std::string("inverted=true")}) {
    const std::string set = " --set axis.x." + other;
    expect_refused(run("G1 X1 F600\n", set), "counted in other scales");
    expect_refused(run("G1 X1 F600\n", set + " --trust-position"), "counted in other scales");
    EXPECT_THAT(position(set), HasSubstr("counted in other scales"));
  }
  const std::string set = " --set axis.x.steps_per_mm=40";
  expect_refused(zero("X" + set), "counted in other scales");
  EXPECT_EQ(zero("XYZE" + set).status, 0);
  EXPECT_THAT(run("G1 X1 F600\n", set).out, HasSubstr("X: ends at pulse 40"));
}

TEST_F(PlaceOfACard, RequireHomeRefusesAxesThatAreNotHomed) {
  const std::string home = " --set card.require_home=true";
  expect_refused(run("G1 X1 F600\n", home), "not homed: X Y Z E, and the machine file has require_home");
  expect_refused(command_.run("line --to 10,0" + home + moving()), "not homed: axis 0");
  EXPECT_THAT(position(), HasSubstr("no position since")) << "nothing was written";
  ASSERT_EQ(zero("X Y Z --homed").status, 0);
  expect_refused(run("G1 X1 F600\n", home), "not homed: E,");
  EXPECT_EQ(command_.run("line --to 10,0" + home + moving()).status, 0);
  ASSERT_EQ(zero("E --homed").status, 0);
  EXPECT_EQ(run("G1 X1 F600\n", home).status, 0);
}

TEST_F(PlaceOfACard, SoftLimitsHoldForHomedAxes) {
  const std::string max = " --set axis.x.max=5";
  const Outcome first = run("G1 X6 F6000\n", max);
  EXPECT_EQ(first.status, 0);
  EXPECT_THAT(first.err, HasSubstr(std::string(kFirst) + "; soft limits of X are off: not homed"));
  EXPECT_THAT(run("G1 X7 F6000\n", max).err,
              HasSubstr("stands at X 6.0000 Y 0.0000 Z 0.0000 E 0.0000 mm; soft limits"));
  ASSERT_EQ(zero("X --homed").status, 0);
  expect_refused(run("G1 X6 F6000\n", max), "X6 is beyond the axis's max of 5");
}

TEST_F(PlaceOfACard, ALineHeedsSoftLimitsOfHomedAxes) {
  const auto line = [&](const std::string& to, const std::string& options = " --set axis.x.min=-1 --set axis.x.max=5") {
    return command_.run("line --to " + to + options + moving());
  };
  const Outcome not_homed = line("480,0");
  EXPECT_EQ(not_homed.status, 0);
  EXPECT_THAT(not_homed.err, HasSubstr("note: soft limits of X are off: not homed"));
  ASSERT_EQ(zero("X Y Z E --homed").status, 0);
  expect_refused(line("401,0"), "the line ends at X5.0125, beyond the axis's max of 5 (machine coordinates)");
  expect_refused(line("-81,0"), "the line ends at X-1.0125, beyond the axis's min of -1");
  EXPECT_EQ(line("400,9000").err, "");
  EXPECT_EQ(line("480,0", "").status, 0);
  expect_refused(line("1,0"), "the line ends at X11.0125");
  EXPECT_EQ(line("-80,0").status, 0) << "it comes back from beyond";
  const Outcome scales = line("480,0", " --set axis.x.max=5 --set axis.x.steps_per_mm=40");
  EXPECT_THAT(scales.err, HasSubstr("note: soft limits of X are off")) << "where it stands is not known";
  EXPECT_EQ(scales.status, 0);
}

// As run and jog do: the soft limits in the card remain its last guard.
TEST_F(PlaceOfACard, ALineTellsTheCardItsSoftLimits) {
  const auto limits = [&] {
    const std::string dump = command_.run("dump --card " + server_.url()).out;
    const std::size_t name = dump.find("SOFT_LIMITS ");
    return dump.substr(dump.find("0x", name), 10);
  };
  const auto line = [&](const std::string& options) { return command_.run("line --to 8,0" + options + moving()); };
  ASSERT_EQ(line(" --set axis.x.max=5 --set axis.z.min=-3").status, 0);
  EXPECT_EQ(limits(), "0x00000000") << "nothing is homed";
  ASSERT_EQ(zero("X Y Z E --homed").status, 0);
  ASSERT_EQ(line(" --set axis.x.max=5 --set axis.z.min=-3").status, 0);
  EXPECT_EQ(limits(), "0x00000005");
  ASSERT_EQ(line(" --set axis.x.max=5 --no-ramp").status, 0);
  EXPECT_EQ(limits(), "0x00000001");
  ASSERT_EQ(line("").status, 0);
  EXPECT_EQ(limits(), "0x00000000") << "a machine file without any";
}

TEST_F(PlaceOfACard, RecoverTellsOfAFault) {
  Running client(command_,
                 "run " + command_.write("long.ngc", "G1 X1000 F600\n") + " --set motion.watchdog=0.2" + moving(),
                 "client.err");
  ASSERT_TRUE(eventually([&] {
    return command_.run("monitor --looks 1 --card " + server_.url()).out.find("on a path") != std::string::npos;
  }));
  EXPECT_THAT(command_.run("recover" + moving()).out, HasSubstr("stopped  by nothing: the card moves"))
      << "beside the writer";
  client.signal(SIGKILL);
  ASSERT_TRUE(client.wait());
  ASSERT_TRUE(eventually([&] { return recover().find("stopped  by WATCHDOG") != std::string::npos; })) << recover();
  EXPECT_THAT(recover(), AllOf(HasSubstr("next     remove the cause, and clear the fault with --clear-faults"),
                               HasSubstr("valid, not homed"), HasSubstr("path     in command 1 of the geometry")))
      << "it stopped on a ramp";
}

TEST_F(PlaceOfACard, RecoverTellsOfAHostThatDied) {
  Running client(command_, "run " + command_.write("long.ngc", "G1 X1000 F600\n") + moving(), "client.err");
  ASSERT_TRUE(eventually([&] { return recover().find("by nothing: the card moves") != std::string::npos; }));
  EXPECT_THAT(position(), HasSubstr("\nthe card moves\n"));
  client.signal(SIGKILL);
  ASSERT_TRUE(client.wait());
  ASSERT_TRUE(eventually([&] { return recover().find("it drops the motion in which") != std::string::npos; }));
  EXPECT_THAT(position(), HasSubstr("\nthe card holds in a motion\n"));
  EXPECT_THAT(recover(), HasSubstr("stopped  by a hold: 127.0.0.1:")) << "and how its connection has ended";
  EXPECT_EQ(run("G1 X1 F6000\n").status, 0);
  EXPECT_THAT(recover(), HasSubstr("stopped  by no fault"))
      << "the hold that a client leaves at its end stopped nothing";
}

TEST(PlaceCommands, NeedACard) {
  const Command command;
  for (const char* verb : {"position", "recover", "zero X"}) {
    const Outcome outcome = command.run(verb);
    EXPECT_EQ(outcome.status, 2) << verb;
    EXPECT_THAT(outcome.err, HasSubstr("needs --card"));
  }
}

}  // namespace
}  // namespace trammel::test
