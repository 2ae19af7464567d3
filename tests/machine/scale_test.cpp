// Changes one steps_per_mm in a machine file. Nothing else may change, in any form of TOML.
#include "trammel/machine/scale.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "machine_texts.hpp"

namespace trammel::machine {
namespace {

using ::testing::HasSubstr;

const std::string kRest =
    "max_velocity = 100\nmax_acceleration = 500\nstep_length_ns = 2000\nstep_space_ns = 2000\ndirection_setup_ns = "
    "1000\n"
    "direction_hold_ns = 1000\ninverted = false\n";

// `before` has `mark` at the place of the number. Only the number may change, from 80 to `number`.
void expect_only_number(const std::string& before, const std::string& mark, const std::string& number) {
  const std::string text = replaced(before, mark, "80");
  EXPECT_EQ(with_steps_per_mm(text, "m.toml", 'X', number).text, replaced(before, mark, number)) << before;
}

TEST(Scale, IsTheOldOneTimesTheRatioInSevenDigits) {
  EXPECT_EQ(calibrated_scale(80, 100, 99.2), "80.64516");
  EXPECT_EQ(calibrated_scale(80, -100, -99.2), "80.64516");
  EXPECT_EQ(calibrated_scale(80, 50, 100), "40");
  EXPECT_EQ(calibrated_scale(800'000, 1, 0.8), "1000000");
}

TEST(Scale, ReplacesTheNumberAlone) {
  const std::string card = "[card]\nclock_hz = 64e6\n";
  expect_only_number(card + "[axis.x]\nsteps_per_mm = @  # of the belt: 80\n" + kRest, "@", "80.64516");
  expect_only_number("# 80\n\n" + card + "[axis.x]\nsteps_per_mm=@#80\n" + kRest, "@", "40");
  // Indented, after other axes with the same value, in a file without a newline at its end.
  expect_only_number(card + "[axis.y]\nsteps_per_mm = 80\n" + kRest + "[axis.x]\n" + kRest + "\t steps_per_mm  =  @",
                     "@", "1");
}

TEST(Scale, FollowsDottedKeysAndTablesInALine) {
  const std::string in_a_line =
      "axis.x = { max_velocity = 100, steps_per_mm = @, max_acceleration = 500, step_length_ns = 2000, step_space_ns = "
      "2000, direction_setup_ns = 1000, direction_hold_ns = 1000, inverted = false }\n[card]\nclock_hz = 64e6\n";
  expect_only_number(in_a_line, "@", "80.64516");
  std::string dotted = "axis.x.\"steps_per_mm\" = @\n";
  std::string rest = kRest;
  while (!rest.empty()) {
    dotted += "axis.x." + rest.substr(0, rest.find('\n') + 1);
    rest.erase(0, rest.find('\n') + 1);
  }
  expect_only_number(dotted + "[card]\nclock_hz = 64e6\n", "@", "7.5");
}

TEST(Scale, KeepsEndsOfLinesAndTheByteOrderMark) {
  std::string text = "\xEF\xBB\xBF[card]\nclock_hz = 64e6 # \xC3\xA9\n[axis.x]\nsteps_per_mm = @ # \xC3\xA9\n" + kRest;
  expect_only_number(text, "@", "80.64516");
  std::string carriage;
  for (const char c : text) carriage += c == '\n' ? std::string("\r\n") : std::string(1, c);
  expect_only_number(carriage, "@", "80.64516");
  const ChangedText changed = with_steps_per_mm(replaced(carriage, "@", "80"), "m.toml", 'X', "9");
  EXPECT_EQ(changed.line, 4U);
  EXPECT_EQ(changed.line_is_now, "steps_per_mm = 9 # \xC3\xA9");
}

RC_GTEST_PROP(Scale, EachAxisOfTheExampleAlone, ()) {
  const char letter = *rc::gen::element('X', 'Y', 'Z', 'E');
  const std::string number = calibrated_scale(*rc::gen::inRange(1, 100'000), 100, *rc::gen::inRange(60, 190));
  const std::string& before = default_machine_text();
  const ChangedText changed = with_steps_per_mm(before, "m.toml", letter, number);
  const Machine machine = parse_machine(changed.text, "m.toml");
  for (const MachineAxis& axis : machine.axes)
    RC_ASSERT(axis.steps_per_mm == (axis.letter == letter ? std::stod(number) : 80));
  // The text before the number and the text after it are unchanged.
  const std::size_t at =
      before.find("steps_per_mm", before.find(std::string("\n[axis.") + static_cast<char>(letter - 'A' + 'a'))) + 15;
  RC_ASSERT(changed.text == before.substr(0, at) + number + before.substr(at + 2));
}

TEST(Scale, RefusesWhatIsNoMachineFile) {
  const auto refused = [](const std::string& text, char letter, const std::string& number) {
    try {
      with_steps_per_mm(text, "m.toml", letter, number);
    } catch (const MachineError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(refused(defaults(), 'X', "0"), HasSubstr("m.toml:10: axis.x.steps_per_mm"));
  EXPECT_THAT(refused(defaults(), 'X', "2000000"), HasSubstr("m.toml:10: axis.x.steps_per_mm"));
  EXPECT_THAT(refused(defaults(), 'B', "80"), HasSubstr("m.toml: the machine has no axis B"));
  EXPECT_THAT(refused("[card", 'X', "80"), HasSubstr("m.toml:1: not TOML"));
  EXPECT_THROW(read_machine_text(""), MachineError);
  EXPECT_THROW(read_machine_text("/nowhere/m.toml"), MachineError);
}

}  // namespace
}  // namespace trammel::machine
