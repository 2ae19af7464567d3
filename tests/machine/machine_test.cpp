#include "trammel/machine/machine.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include "machine_texts.hpp"

namespace trammel::machine {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

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
  text = replaced(text, "[axis.z]", "[axis.a]\nendless = true");
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
            "m.toml:10: axis.x.steps_per_mm must be from 0.001 to 1e+06 pulses/mm, not 0 (a pulse a metre to a pulse a "
            "nanometre)");
  EXPECT_EQ(error_of(replaced(defaults(), "step_length_ns = 2000", "step_length_ns = -1")),
            "m.toml:13: axis.x.step_length_ns must be from 0.001 to 1e+11 ns, not -1 (a register holds 65,535 clocks, "
            "100 s at the slowest clock)");
  EXPECT_EQ(error_of(replaced(defaults(), "direction_hold_ns = 1000", "direction_hold_ns = -1")),
            "m.toml:16: axis.x.direction_hold_ns must be from 0 to 1e+11 ns, not -1 (a register holds 65,535 clocks, "
            "100 s at the slowest clock)");
  EXPECT_EQ(error_of(replaced(defaults(), "max_velocity = 150", "max_velocity = \"fast\"")),
            "m.toml:11: axis.x.max_velocity must be a number");
  EXPECT_EQ(error_of(replaced(defaults(), "max_velocity = 150", "max_velocity = inf")),
            "m.toml:11: axis.x.max_velocity must be a finite number");
  EXPECT_EQ(error_of(replaced(defaults(), "max_velocity = 150", "max_velocity = nan")),
            "m.toml:11: axis.x.max_velocity must be a finite number");
  EXPECT_EQ(error_of(replaced(defaults(), "inverted = false", "inverted = 0")),
            "m.toml:17: axis.x.inverted must be true or false");
  EXPECT_EQ(error_of(replaced(defaults(), "max_velocity = 150", "")), "m.toml:9: [axis.x] has no max_velocity");
  EXPECT_EQ(error_of(replaced(defaults(), "inverted = false", "")), "m.toml:9: [axis.x] has no inverted");
  EXPECT_EQ(error_of(replaced(defaults(), "max_velocity", "max_speed")),
            "m.toml:11: unknown entry axis.x.max_speed; did you mean max_jerk?");
  EXPECT_EQ(error_of(replaced(defaults(), "max_velocity", "max_velocty")),
            "m.toml:11: unknown entry axis.x.max_velocty; did you mean max_velocity?");
  EXPECT_THAT(error_of(replaced(defaults(), "max_velocity", "qqq")),
              StartsWith("m.toml:11: unknown entry axis.x.qqq; known are inverted, steps_per_mm, max_velocity, "));
  EXPECT_THAT(error_of(replaced(defaults(), "inverted = false", "inverted = false\ng60 = 1")),
              StartsWith("m.toml:18: unknown entry axis.x.g60; known are "));
  EXPECT_THAT(error_of(replaced(defaults(), "[axis.x]", "[axis.q]")), StartsWith("m.toml:9: unknown axis [axis.q]"));
  EXPECT_THAT(error_of(replaced(defaults(), "[axis.x]", "[axis.X]")), StartsWith("m.toml:9: unknown axis [axis.X]"));
  EXPECT_EQ(error_of(replaced(defaults(), "[card]", "[cord]")), "m.toml:4: unknown entry cord; did you mean card?");
  EXPECT_EQ(error_of(replaced(defaults(), "clock_hz", "clock")),
            "m.toml:5: unknown entry card.clock; did you mean clock_hz?");
  EXPECT_EQ(error_of(replaced(defaults(), "clock_hz", "hertz")),
            "m.toml:5: unknown entry card.hertz; known are clock_hz, require_home");
  for (const char* clock : {"1e4294967296", "999", "0", "-1e6", "1234.5", "4294967296"}) {
    EXPECT_THAT(error_of(replaced(defaults(), "100_000_000", clock)), StartsWith("m.toml:5: card.clock_hz must be a"))
        << clock;
  }
  EXPECT_EQ(error_of(replaced(defaults(), "100_000_000", "999")),
            "m.toml:5: card.clock_hz must be a whole number of Hz from 1000 to 4294967295, not 999");
  EXPECT_THAT(error_of(replaced(defaults(), "[card]", "[card")), StartsWith("m.toml:4: not TOML"));
  EXPECT_EQ(error_of("[card]\nclock_hz = 1\n"), "m.toml:1: no axis: at least one table [axis.<letter>]");
  EXPECT_EQ(error_of("card = 3\n"), "m.toml:1: card must be a table");
  EXPECT_THAT(error_of(replaced(defaults(), "step_space_ns = 2000", "step_space_ns = 2000000")),
              HasSubstr("axis X: step_space_ns: 2000000 ns"));
}

TEST(Machine, RefusesMoreThanEightAxes) {
  std::string text = defaults();
  const std::string table = text.substr(text.find("[axis.y]"), text.find("[axis.z]") - text.find("[axis.y]"));
  for (const char* name : {"[axis.a]", "[axis.b]", "[axis.c]", "[axis.u]"}) {
    const bool rotary = std::string(name) != "[axis.u]";
    text += "\n" + replaced(table, "[axis.y]", name + std::string(rotary ? "\nendless = true" : ""));
  }
  EXPECT_EQ(parse_machine(text, "m.toml").axes.size(), 8U);
  text += "\n" + replaced(table, "[axis.y]", "[axis.v]");
  EXPECT_EQ(error_of(text), "m.toml:1: 9 axes, the card has at most 8");
}

TEST(Machine, RotaryAxesHaveSoftLimitsOrSayThatTheyAreEndless) {
  const std::string rotary = replaced(defaults(), "[axis.z]", "[axis.a]");
  EXPECT_EQ(error_of(rotary),
            "m.toml:1: axis A: a rotary axis needs min and max, or endless = true where it has no soft limits");
  const auto with = [&](const std::string& lines) { return replaced(rotary, "[axis.a]", "[axis.a]\n" + lines); };
  EXPECT_TRUE(parse_machine(with("endless = true"), "m.toml").axes[2].endless);
  EXPECT_FALSE(parse_machine(with("min = 0\nmax = 360"), "m.toml").axes[2].endless);
  EXPECT_EQ(error_of(with("endless = true\nmin = 0")), "m.toml:1: axis A: endless, but it has min or max");
  EXPECT_EQ(error_of(replaced(defaults(), "[axis.z]", "[axis.z]\nendless = true")),
            "m.toml:1: axis Z: only A, B and C can be endless");
}

bool is_one_line(const std::string& message) {
  const auto control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; };
  return !message.empty() && message.size() <= 1000 && std::none_of(message.begin(), message.end(), control);
}

// Files with a few random changes are read, or refused with one line.
RC_GTEST_PROP(Machine, AnyTextIsReadOrRefused, ()) {
  std::string text = defaults();
  const auto changes = *rc::gen::inRange(1, 6);
  for (int i = 0; i < changes; ++i) {
    const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
    const auto count = std::min(*rc::gen::inRange<std::size_t>(0, 12), text.size() - at);
    text.replace(
        at, count,
        *rc::gen::element<std::string>("", "[", "]", "{", "}", "=", ".", "\n", "\"", "'", "[axis.x]", "[[card]]",
                                       "card={}", "1e400", "nan", "0x", "99999999999999999999", "1979-05-27",
                                       std::string("\0", 1), "\xff", "\x1b", "\"\\u0007\" = 1", "#", "\r"));
  }
  const std::string error = error_of(text);
  RC_ASSERT(is_one_line(error));
  RC_ASSERT(is_one_line(override_error(text.substr(0, *rc::gen::inRange<std::size_t>(0, 200)))));
}

std::string load_error(const std::string& path) {
  try {
    load_machine(path);
  } catch (const MachineError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Machine, RefusesWhatIsNoMachineFile) {
  EXPECT_EQ(load_error("no/such/machine.toml"),
            "no/such/machine.toml: cannot read the machine file: No such file or directory");
  EXPECT_EQ(load_error("."), ".: is a directory, not a machine file");
  EXPECT_EQ(load_error("/dev/null"), "/dev/null: is a device, not a machine file");
  EXPECT_EQ(load_error("/dev/zero"), "/dev/zero: is a device, not a machine file");
  EXPECT_EQ(load_error(""), "the machine file has no name");
}

TEST(Machine, ReadsAPipe) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  ASSERT_EQ(::write(ends[1], defaults().data(), defaults().size()), static_cast<ssize_t>(defaults().size()));
  ::close(ends[1]);
  EXPECT_EQ(load_machine("/dev/fd/" + std::to_string(ends[0])).axes.size(), 4U);
  ::close(ends[0]);
}

std::string repeated(const std::string& text, int count) {
  std::string result;
  for (int i = 0; i < count; ++i) {
    result += text;
  }
  return result;
}

// toml11 recurses for every bracket and for every table of a dotted key, so deep nesting would exhaust the stack.
TEST(Machine, RefusesDeepNesting) {
  for (const int depth : {17, 5000, 300000}) {
    EXPECT_EQ(error_of("\na = " + repeated("[", depth)), "m.toml:2: nested deeper than 16");
    EXPECT_EQ(error_of("# [\na = " + repeated("{a=", depth)), "m.toml:2: nested deeper than 16");
    EXPECT_EQ(error_of("\n" + repeated("a.", depth) + "b = 1"), "m.toml:2: nested deeper than 16");
    EXPECT_EQ(error_of("\n[" + repeated("a.", depth) + "b]"), "m.toml:2: nested deeper than 16");
  }
  EXPECT_EQ(override_error("card=" + repeated("[", 5000)),
            "--set card=" + repeated("[", 72) + "...: nested deeper than 16");
}

TEST(Machine, BracketsInCommentsAndStringsAreText) {
  const std::string brackets = repeated("[{", 50);
  EXPECT_EQ(parse_machine("# " + brackets + "\n" + defaults(), "m.toml").axes.size(), 4U);
  for (const std::string quote : {"\"", "'", "\"\"\"", "'''"}) {
    EXPECT_EQ(error_of("a = " + quote + brackets + quote),
              "m.toml:1: unknown entry a; known are card, axis, kinematics, motion, outputs, spindle, tools, probe, "
              "inputs, homing")
        << quote;
    // An unclosed one-line string ends with its line, so brackets in the next line count.
    const bool found = error_of("a = " + quote + "\nb = " + brackets) == "m.toml:2: nested deeper than 16";
    EXPECT_EQ(found, quote.size() == 1) << quote;
  }
  EXPECT_EQ(error_of("a = \"\\\"\" # " + brackets),
            "m.toml:1: unknown entry a; known are card, axis, kinematics, motion, outputs, spindle, tools, probe, "
            "inputs, homing");
  EXPECT_EQ(error_of("a = '\\' # " + brackets),
            "m.toml:1: unknown entry a; known are card, axis, kinematics, motion, outputs, spindle, tools, probe, "
            "inputs, homing");
}

TEST(Machine, RefusesEndlessText) {
  EXPECT_EQ(error_of(std::string(kLongestMachineText + 1, ' ')), "m.toml:1: more than 1048576 bytes");
}

TEST(Machine, SoftLimits) {
  const Machine none = default_machine();
  EXPECT_EQ(none.axes[0].min, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(none.axes[0].max, std::numeric_limits<double>::infinity());
  const auto with = [](const std::string& lines) {
    return replaced(defaults(), "inverted = false", "inverted = false\n" + lines);
  };
  const Machine both = parse_machine(with("min = -10.5\nmax = 220"), "m.toml");
  EXPECT_EQ(both.axes[0].min, -10.5);
  EXPECT_EQ(both.axes[0].max, 220);
  EXPECT_EQ(both.axes[1].max, std::numeric_limits<double>::infinity());
  EXPECT_EQ(parse_machine(with("min = 5"), "m.toml").axes[0].min, 5);
  EXPECT_EQ(error_of(with("max = 5\nmin = 5")), "m.toml:19: axis.x.min must be less than axis.x.max: 5 and 5");
  EXPECT_THAT(error_of(with("max = 5\nmin = 6")), HasSubstr("must be less than"));
  EXPECT_THAT(error_of(with("max = inf")), HasSubstr("must be a finite number"));
  Machine changed = both;
  apply_override(changed, "axis.x.min=219");
  EXPECT_EQ(changed.axes[0].min, 219);
  EXPECT_THROW(apply_override(changed, "axis.x.min=220"), MachineError);
  EXPECT_EQ(changed.axes[0].min, 219);
}

TEST(Machine, RequireHomeIsASwitch) {
  EXPECT_FALSE(default_machine().require_home);
  const auto with = [](const std::string& value) {
    return replaced(defaults(), "[card]\n", "[card]\nrequire_home = " + value + "\n");
  };
  EXPECT_TRUE(parse_machine(with("true"), "m.toml").require_home);
  EXPECT_EQ(error_of(with("1")), "m.toml:5: card.require_home must be true or false");
  Machine changed = default_machine();
  apply_override(changed, "card.require_home=true");
  EXPECT_TRUE(changed.require_home);
  EXPECT_EQ(changed.clock_hz, default_machine().clock_hz);
}

TEST(Machine, KeepsPlaceIsASwitchOfAnAxis) {
  for (const MachineAxis& axis : default_machine().axes) EXPECT_FALSE(axis.keeps_place);
  const auto with = [](const std::string& value) {
    return replaced(defaults(), "[axis.z]\n", "[axis.z]\nkeeps_place = " + value + "\n");
  };
  const Machine machine = parse_machine(with("true"), "m.toml");
  EXPECT_TRUE(machine.axes[2].keeps_place);
  EXPECT_FALSE(machine.axes[0].keeps_place);
  EXPECT_THAT(error_of(with("1")), HasSubstr("axis.z.keeps_place must be true or false"));
  EXPECT_THAT(override_error("axis.z.keep_place=true"), HasSubstr("did you mean keeps_place?"));
}

TEST(Machine, JerkIsOptional) {
  EXPECT_EQ(default_machine().axes[0].max_jerk, 0);
  const auto with = [](const std::string& line) {
    return replaced(defaults(), "inverted = false", "inverted = false\n" + line);
  };
  EXPECT_EQ(parse_machine(with("max_jerk = 50_000"), "m.toml").axes[0].max_jerk, 50000);
  EXPECT_THAT(error_of(with("max_jerk = 0")), HasSubstr("max_jerk must be from 0.001 to 1e+13 mm/s^3, not 0"));
}

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
            "--set axis.x.steps_per_mm=0: axis.x.steps_per_mm must be from 0.001 to 1e+06 pulses/mm, not 0 (a pulse a "
            "metre to a pulse a nanometre)");
  EXPECT_EQ(override_error("axis.a.steps_per_mm=1"), "--set axis.a.steps_per_mm=1: the machine has no axis a");
  EXPECT_THAT(override_error("axis.x.colour=1"),
              StartsWith("--set axis.x.colour=1: unknown entry axis.x.colour; known are "));
  EXPECT_EQ(override_error("axis.x.hom=1"), "--set axis.x.hom=1: unknown entry axis.x.hom; did you mean home?");
  for (const char* nothing : {"card={}", "axis={}", "axis.x={}", "# axis.x.home=1", "[card]"}) {
    EXPECT_EQ(override_error(nothing),
              std::string("--set ") + nothing + ": not an assignment such as axis.x.steps_per_mm=20");
  }
  EXPECT_EQ(override_error("card.clock_hz=999"),
            "--set card.clock_hz=999: card.clock_hz must be a whole number of Hz from 1000 to 4294967295, not 999");
  EXPECT_EQ(override_error("axis.x.min=1\naxis.x.max=1"),
            "--set axis.x.min=1\\naxis.x.max=1: axis.x.min must be less than axis.x.max: 1 and 1");
  EXPECT_EQ(override_error("axis.x=1"), "--set axis.x=1: axis.x must be a table");
  EXPECT_EQ(
      override_error("speed=1"),
      "--set speed=1: unknown entry speed; known are card, axis, kinematics, motion, outputs, spindle, tools, probe, "
      "inputs, homing");
  EXPECT_THAT(override_error("axis.x.steps_per_mm"), StartsWith("--set axis.x.steps_per_mm: "));
  EXPECT_THAT(override_error(""), HasSubstr("not an assignment"));
  EXPECT_THAT(override_error("axis.x.steps_per_mm=\"eighty"), HasSubstr("not TOML"));
}

// A shell removes quotation marks that are not quoted themselves.
TEST(Machine, TextWithoutQuotationMarksIsRefusedWithThem) {
  EXPECT_EQ(override_error("inputs.on_limit=ramp"),
            "--set inputs.on_limit=ramp: not TOML: ramp is neither a number nor true or false, and text needs "
            "quotation marks: --set 'inputs.on_limit=\"ramp\"'");
  EXPECT_THAT(override_error("inputs.on_limit='ramp"), HasSubstr("not TOML: the next token"));
  const std::string error = error_of(defaults() + "[inputs]\non_limit =ramp # as the drive does\n");
  EXPECT_THAT(error, StartsWith("m.toml:"));
  EXPECT_THAT(error, HasSubstr("not TOML: ramp is neither a number nor true or false, and text needs quotation marks: "
                               "on_limit = \"ramp\""));
}

TEST(Machine, StepTimesFitTheCardsRegistersAtItsClock) {
  Machine machine = default_machine();
  EXPECT_EQ(override_error("axis.x.step_space_ns=655350.1"),
            "--set axis.x.step_space_ns=655350.1: axis X: step_space_ns: 655351 ns, 65536 clocks at 100000000 Hz, is "
            "outside 0 .. 65535 clocks");
  EXPECT_NO_THROW(apply_override(machine, "axis.x.step_space_ns=655350"));
  EXPECT_THROW(apply_override(machine, "card.clock_hz=100000001"), MachineError);
  EXPECT_NO_THROW(apply_override(machine, "card.clock_hz=1000"));
  EXPECT_THAT(override_error("axis.e.direction_hold_ns=1e11"), HasSubstr("axis E: direction_hold_ns: "));
}

}  // namespace
}  // namespace trammel::machine
