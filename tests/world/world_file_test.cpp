// World files and scripts: the contents of the default, and errors that name file, line and the right form.
#include "trammel/world/world_file.hpp"

#include <gmock/gmock.h>

#include <cstdio>
#include <fstream>

#include "trammel/machine/machine.hpp"
#include "world_card.hpp"

namespace trammel::world {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string file_error(const std::string& text) {
  try {
    parse_world(text, "w.toml");
  } catch (const WorldError& error) {
    return error.what();
  }
  return "none";
}

std::string script_error(const std::string& text) {
  try {
    parse_events(text, "e.txt", default_world());
  } catch (const WorldError& error) {
    return error.what();
  }
  return "none";
}

TEST(WorldFile, TheDefaultFitsTheDefaultMachine) {
  const Description world = default_world();
  const machine::Machine machine = machine::default_machine();
  ASSERT_EQ(world.axes.size(), machine.axes.size());
  for (std::size_t n = 0; n < world.axes.size(); ++n) {
    EXPECT_EQ(world.axes[n].letter, machine.axes[n].letter);
    EXPECT_EQ(world.axes[n].card_axis, n);
    EXPECT_DOUBLE_EQ(world.axes[n].pulses_a_mm, machine.axes[n].steps_per_mm);
  }
  EXPECT_EQ(world.switches.size(), 7U);
  EXPECT_EQ(world.buttons.size(), 3U);
}

constexpr const char* kEachEntry = R"(
seed = 7
closed_level = 1
events = ["at 1.5 s press stop", "at 20 ms alarm X"]
[axis.z]
card_axis = 6
[axis.x]
full_steps_a_turn = 400
microsteps = 8
mm_a_turn = 32
torque = 1.5
rotor = 100
mass = 2
friction = 0.1
damping = 0.01
low = -10
high = 20
alarm = 8
alarm_at = 1.5
alarm_normally = "closed"
[switch.home]
input = 3
axis = "z"
above = 7.5
release = 0.25
normally = "open"
bounce = 2
bounces = 5
[button.stop]
emergency_stop = true
cuts_power = false
power_off_after = 30
bounces = 0
)";

TEST(WorldFile, EachEntryIsRead) {
  const Description d = parse_world(kEachEntry, "w.toml");
  EXPECT_EQ(d.seed, 7U);
  EXPECT_TRUE(d.closed_level);
  ASSERT_EQ(d.axes.size(), 2U);
  const AxisDescription& x = d.axes[0];
  EXPECT_EQ(x.letter, 'X');
  EXPECT_EQ(d.axes[1].card_axis, 6U);
  EXPECT_DOUBLE_EQ(x.pulses_a_mm, 100);
  const MotorParameters& motor = x.carriage.motor;
  EXPECT_DOUBLE_EQ(motor.holding_torque, 1.5);
  EXPECT_DOUBLE_EQ(motor.rotor_inertia, 1e-5);
  EXPECT_DOUBLE_EQ(motor.mass, 2);
  EXPECT_DOUBLE_EQ(motor.friction, 0.1);
  EXPECT_DOUBLE_EQ(motor.damping, 0.01);
  EXPECT_NEAR(motor.radius, 5.09296e-3, 1e-8);
  EXPECT_EQ(x.carriage.low, -1000);
  EXPECT_EQ(x.carriage.high, 2000);
  EXPECT_DOUBLE_EQ(x.alarm_at.value_or(0), 1.5);
  const SwitchDescription& home = d.switches.at(0);
  EXPECT_EQ(home.axis, 1U);
  EXPECT_EQ(home.input, 3U);
  EXPECT_TRUE(home.above);
  EXPECT_EQ(home.at, 600);
  EXPECT_EQ(home.hysteresis, 20);
  EXPECT_FALSE(home.contact.normally_closed);
  EXPECT_DOUBLE_EQ(home.contact.bounce, 2e-3);
  EXPECT_EQ(home.contact.bounces, 5U);
  ASSERT_EQ(d.buttons.size(), 2U);
  EXPECT_EQ(d.buttons[0].name, "x_alarm");
  EXPECT_EQ(d.buttons[0].input, 8U);
  EXPECT_TRUE(d.buttons[0].contact.normally_closed);
  EXPECT_FALSE(d.buttons[1].input);
  EXPECT_FALSE(d.buttons[1].cuts_power);
  EXPECT_DOUBLE_EQ(d.buttons[1].power_delay, 0.03);
  EXPECT_TRUE(d.buttons[1].contact.normally_closed);
  ASSERT_EQ(d.events.size(), 2U);
  EXPECT_EQ(d.events[0].nanoseconds, 1'500'000'000U);
  EXPECT_EQ(d.events[1].nanoseconds, 20'000'000U);
  EXPECT_EQ(d.events[1].button, "x_alarm");
}

TEST(WorldFile, ErrorsNameFileAndLine) {
  EXPECT_EQ(file_error("[axis.x]\n"), "none");
  EXPECT_THAT(file_error("seed = 1\n"), StartsWith("w.toml:1: "));
  EXPECT_THAT(file_error("[axis.x]\nmas = 1\n"),
              AllOf(StartsWith("w.toml:2: unknown entry axis.x.mas"), HasSubstr("mass")));
  EXPECT_THAT(file_error("[axis.x]\n\nmass = -1\n"), StartsWith("w.toml:3: axis.x.mass must be from 0 to"));
  EXPECT_THAT(file_error("[axis.x]\nmass = \"a\"\n"), StartsWith("w.toml:2: axis.x.mass must be a number"));
  EXPECT_THAT(file_error("[axis.x]\nmass = nan\n"), StartsWith("w.toml:2: axis.x.mass must be"));
  EXPECT_THAT(file_error("[axis.q]\n"), StartsWith("w.toml:1: axis.q is no axis"));
  EXPECT_THAT(file_error("[axis.x]\nlow = 1\n"), StartsWith("w.toml:2: axis.x.low must be"));
  EXPECT_THAT(file_error("[axis.x]\nalarm_at = 1\n"), StartsWith("w.toml:2: axis.x.alarm_at needs an input"));
  EXPECT_THAT(file_error("[axis.x]\n[switch.a]\ninput = 1\n"), StartsWith("w.toml:2: switch.a needs input"));
  EXPECT_THAT(file_error("[axis.x]\n[switch.a]\ninput = 1\naxis = \"y\"\nabove = 1\n"),
              StartsWith("w.toml:4: switch.a.axis must be \"x\""));
  EXPECT_THAT(file_error("[axis.x]\n[button.a]\n"), StartsWith("w.toml:2: button.a needs either"));
  EXPECT_THAT(file_error("[axis.x]\n[button.a]\ninput = 1\n[button.b]\ninput = 1\n"),
              StartsWith("w.toml:4: button b: something else is wired to input 1"));
  EXPECT_THAT(file_error("[axis.x]\nrotor = 0.01\nmass = 0\n"),
              AllOf(StartsWith("w.toml:1: axis X: "), HasSubstr("too light")));
  EXPECT_THAT(file_error("events = [\"at noon press a\"]\n[axis.x]\n"), StartsWith("w.toml:1: "));
  EXPECT_THAT(file_error("[axis.x\n"), StartsWith("w.toml:1: not TOML"));
  EXPECT_THAT(file_error("[axis.x]\n[swich.a]\n"), StartsWith("w.toml:2: unknown entry swich; known here: axis"));
  EXPECT_THAT(file_error("axis = 1\n"), StartsWith("w.toml:1: axis must be a table"));
  EXPECT_THAT(file_error(std::string(100'000, '[')), HasSubstr("brackets"));
  EXPECT_THAT(file_error(std::string(kLongestWorldText + 1, '#')), HasSubstr("longer than"));
}

TEST(WorldFile, FilesThatCannotBeRead) {
  EXPECT_THROW(load_world("/nowhere/world.toml"), WorldError);
  EXPECT_THROW(load_world("/"), WorldError);
  EXPECT_THROW(load_world(""), WorldError);
  EXPECT_THROW(load_events("/nowhere/events", default_world()), WorldError);
}

TEST(WorldScript, LinesCommentsAndTimes) {
  const auto events =
      parse_events("# begin\n\nat 1.5 s press estop # now\n  at 2 s release estop\nat 7 ms press feed_hold\n", "e.txt",
                   default_world());
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events[0].nanoseconds, 1'500'000'000U);
  EXPECT_TRUE(events[0].press);
  EXPECT_FALSE(events[1].press);
  EXPECT_EQ(events[1].button, "estop");
  EXPECT_EQ(events[2].nanoseconds, 7'000'000U);
  EXPECT_EQ(events[2].button, "feed_hold");
}

TEST(WorldScript, ErrorsNameFileAndLine) {
  EXPECT_THAT(script_error("\nat 1 s push estop\n"), AllOf(StartsWith("e.txt:2: push"), HasSubstr("press NAME")));
  EXPECT_THAT(script_error("at 1 s press\n"), StartsWith("e.txt:1: at 1 s press: an event is"));
  EXPECT_THAT(script_error("at 1 min press estop\n"), HasSubstr("1 min: a time is"));
  EXPECT_THAT(script_error("at -1 s press estop\n"), HasSubstr("0 s to"));
  EXPECT_THAT(script_error("at nan s press estop\n"), HasSubstr("0 s to"));
  EXPECT_THAT(script_error("at 1 s press stop\n"), HasSubstr("stop: the world has no such button: it has feed_hold"));
  EXPECT_THAT(script_error("at 1 s alarm X\n"), HasSubstr("x_alarm: the world has no such button"));
}

}  // namespace
}  // namespace trammel::world
