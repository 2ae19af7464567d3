#include "trammel/machine/machine.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

namespace trammel::machine {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string error_of(const std::string& text) {
  try {
    parse_machine(text, "m.toml");
  } catch (const MachineError& error) {
    return error.what();
  }
  return "no error";
}

std::string override_error(const std::string& text) {
  Machine machine = default_machine();
  try {
    apply_override(machine, text);
  } catch (const MachineError& error) {
    return error.what();
  }
  return "no error";
}

const std::string& defaults() { return default_machine_text(); }

TEST(Machine, EmbeddedDefaultIsTheExample) {
  const std::string path = TRAMMEL_EXAMPLES_DIR "/machine.toml";
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(text, default_machine_text());
  EXPECT_EQ(load_machine(path).axes.size(), 4U);
}

TEST(Machine, DefaultHasFourAxesAtEightySteps) {
  const Machine machine = default_machine();
  EXPECT_EQ(machine.clock_hz, 100'000'000U);
  ASSERT_EQ(machine.axes.size(), 4U);
  std::string letters;
  for (const MachineAxis& axis : machine.axes) {
    letters += axis.letter;
    EXPECT_EQ(axis.steps_per_mm, 80);
    EXPECT_EQ(axis.max_acceleration, 1000);
    EXPECT_FALSE(axis.inverted);
    EXPECT_EQ(axis.home, 0);
  }
  EXPECT_EQ(letters, "XYZE");
  EXPECT_EQ(machine.axis('E'), 3U);
  EXPECT_EQ(machine.axis('A'), std::nullopt);
}

TEST(Machine, AxesStandInTheCardsOrder) {
  std::string text = defaults();
  text = replaced(text, "[axis.x]", "[axis.w]");
  text = replaced(text, "[axis.z]", "[axis.a]");
  const Machine machine = parse_machine(text, "m.toml");
  EXPECT_EQ(machine.axis('Y'), 0U);
  EXPECT_EQ(machine.axis('A'), 1U);
  EXPECT_EQ(machine.axis('W'), 2U);
  EXPECT_EQ(machine.axis('E'), 3U);
}

TEST(Machine, ReadsHomeAndOffsets) {
  const Machine machine =
      parse_machine(replaced(defaults(), "inverted = false", "inverted = true\nhome = -5\ng54 = 1.5\ng59 = 2"), "m");
  EXPECT_TRUE(machine.axes[0].inverted);
  EXPECT_EQ(machine.axes[0].home, -5);
  EXPECT_EQ(machine.axes[0].offsets[0], 1.5);
  EXPECT_EQ(machine.axes[0].offsets[5], 2);
}

TEST(Machine, RefusesWithFileAndLine) {
  EXPECT_EQ(error_of(replaced(defaults(), "steps_per_mm = 80 ", "steps_per_mm = 0 ")),
            "m.toml:9: axis.x.steps_per_mm must be greater than 0, not 0");
  EXPECT_EQ(error_of(replaced(defaults(), "step_length_ns = 2000", "step_length_ns = -1")),
            "m.toml:13: axis.x.step_length_ns must be greater than 0, not -1");
  EXPECT_EQ(error_of(replaced(defaults(), "direction_hold_ns = 1000", "direction_hold_ns = -1")),
            "m.toml:16: axis.x.direction_hold_ns must not be negative, not -1");
  EXPECT_EQ(error_of(replaced(defaults(), "max_velocity = 150", "max_velocity = \"fast\"")),
            "m.toml:10: axis.x.max_velocity must be a number");
  EXPECT_EQ(error_of(replaced(defaults(), "max_velocity = 150", "max_velocity = inf")),
            "m.toml:10: axis.x.max_velocity must be a finite number");
  EXPECT_EQ(error_of(replaced(defaults(), "max_velocity = 150", "max_velocity = nan")),
            "m.toml:10: axis.x.max_velocity must be a finite number");
  EXPECT_EQ(error_of(replaced(defaults(), "inverted = false", "inverted = 0")),
            "m.toml:17: axis.x.inverted must be true or false");
  EXPECT_EQ(error_of(replaced(defaults(), "max_velocity = 150", "")), "m.toml:8: [axis.x] has no max_velocity");
  EXPECT_EQ(error_of(replaced(defaults(), "inverted = false", "")), "m.toml:8: [axis.x] has no inverted");
  EXPECT_EQ(error_of(replaced(defaults(), "max_velocity", "max_speed")), "m.toml:10: unknown entry axis.x.max_speed");
  EXPECT_EQ(error_of(replaced(defaults(), "inverted = false", "inverted = false\ng60 = 1")),
            "m.toml:18: unknown entry axis.x.g60");
  EXPECT_THAT(error_of(replaced(defaults(), "[axis.x]", "[axis.q]")), StartsWith("m.toml:8: unknown axis [axis.q]"));
  EXPECT_THAT(error_of(replaced(defaults(), "[axis.x]", "[axis.X]")), StartsWith("m.toml:8: unknown axis [axis.X]"));
  EXPECT_EQ(error_of(replaced(defaults(), "[card]", "[cord]")), "m.toml:4: unknown entry cord");
  EXPECT_EQ(error_of(replaced(defaults(), "clock_hz", "clock")), "m.toml:5: unknown entry card.clock");
  EXPECT_EQ(error_of(replaced(defaults(), "100_000_000", "1.5")),
            "m.toml:5: card.clock_hz must be a whole number below 2^32");
  EXPECT_THAT(error_of(replaced(defaults(), "[card]", "[card")), StartsWith("m.toml:4: not TOML"));
  EXPECT_EQ(error_of("[card]\nclock_hz = 1\n"), "m.toml:1: no axis: at least one table [axis.<letter>]");
  EXPECT_EQ(error_of("card = 3\n"), "m.toml:1: card must be a table");
  EXPECT_THAT(error_of(replaced(defaults(), "step_space_ns = 2000", "step_space_ns = 2000000")),
              HasSubstr("axis X: 2000000 ns"));
}

TEST(Machine, RefusesMoreThanEightAxes) {
  std::string text = defaults();
  const std::string table = text.substr(text.find("[axis.y]"), text.find("[axis.z]") - text.find("[axis.y]"));
  for (const char* name : {"[axis.a]", "[axis.b]", "[axis.c]", "[axis.u]"}) {
    text += "\n" + replaced(table, "[axis.y]", name);
  }
  EXPECT_EQ(parse_machine(text, "m.toml").axes.size(), 8U);
  text += "\n" + replaced(table, "[axis.y]", "[axis.v]");
  EXPECT_EQ(error_of(text), "m.toml:1: 9 axes, the card has at most 8");
}

TEST(Machine, RefusesAMissingFile) { EXPECT_THROW(load_machine("no/such/machine.toml"), MachineError); }

TEST(Machine, OverridesEntries) {
  Machine machine = default_machine();
  apply_override(machine, "axis.x.steps_per_mm=20");
  apply_override(machine, "card.clock_hz=1e6");
  apply_override(machine, "axis.e.inverted = true");
  apply_override(machine, "axis.y.g55=7.5");
  EXPECT_EQ(machine.axes[0].steps_per_mm, 20);
  EXPECT_EQ(machine.clock_hz, 1'000'000U);
  EXPECT_TRUE(machine.axes[3].inverted);
  EXPECT_EQ(machine.axes[1].offsets[1], 7.5);
}

TEST(Machine, RefusesBadOverrides) {
  EXPECT_EQ(override_error("axis.x.steps_per_mm=0"),
            "--set axis.x.steps_per_mm=0: axis.x.steps_per_mm must be greater than 0, not 0");
  EXPECT_EQ(override_error("axis.a.steps_per_mm=1"), "--set axis.a.steps_per_mm=1: the machine has no axis a");
  EXPECT_EQ(override_error("axis.x.colour=1"), "--set axis.x.colour=1: unknown entry axis.x.colour");
  EXPECT_EQ(override_error("axis.x=1"), "--set axis.x=1: axis.x must be a table");
  EXPECT_EQ(override_error("speed=1"), "--set speed=1: unknown entry speed");
  EXPECT_THAT(override_error("axis.x.steps_per_mm"), StartsWith("--set axis.x.steps_per_mm: "));
  EXPECT_THAT(override_error(""), HasSubstr("not an assignment"));
  EXPECT_THAT(override_error("axis.x.steps_per_mm=eighty"), HasSubstr("not TOML"));
}

TEST(Machine, TimesBecomeWholeClocks) {
  EXPECT_EQ(clocks_from_ns(2000, 100'000'000), 200);
  EXPECT_EQ(clocks_from_ns(2001, 100'000'000), 201);
  EXPECT_EQ(clocks_from_ns(2000, 1'000'000), 2);
  EXPECT_EQ(clocks_from_ns(1, 1'000'000), 1);
  EXPECT_EQ(clocks_from_ns(0, 1'000'000), 0);
  EXPECT_EQ(clocks_from_ns(65535, 1'000'000'000), 65535);
  EXPECT_THROW(clocks_from_ns(65536, 1'000'000'000), std::out_of_range);
}

}  // namespace
}  // namespace trammel::machine
