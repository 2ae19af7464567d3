// M3 to M5 and M7 to M9 as outputs that the machine file names.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "reading.hpp"

namespace trammel::gcode {
namespace {

machine::Machine machine_with_outputs() {
  machine::Machine machine = machine::default_machine();
  machine::apply_override(machine, "outputs.m3=0");
  machine::apply_override(machine, "outputs.m4=[0, 5]");
  machine::apply_override(machine, "outputs.m7=2");
  machine::apply_override(machine, "outputs.m8=15");
  return machine;
}

// "line:+set-clear" for outputs, "line:move", "line:dwell", "line:end".
std::vector<std::string> order_of(const std::vector<Motion>& motions) {
  std::vector<std::string> result;
  for (const Motion& motion : motions) {
    std::string text = std::to_string(motion.line) + ":";
    if (motion.kind == MotionKind::kOutput) {
      text += "+" + std::to_string(motion.set) + "-" + std::to_string(motion.clear);
    } else {
      text += motion.kind == MotionKind::kDwell ? "dwell" : motion.kind == MotionKind::kEnd ? "end" : "move";
    }
    result.push_back(text);
  }
  return result;
}

using Order = std::vector<std::string>;

TEST(PathOutputs, EachWordSwitchesItsOwn) {
  const machine::Machine machine = machine_with_outputs();
  const auto made = [&](const std::string& text) { return order_of(read_text(text + "\n", machine).motions); };
  EXPECT_EQ(made("M3"), (Order{"1:+1-32", "1:end"})) << "not beside M4's own";
  EXPECT_EQ(made("M4"), (Order{"1:+33-0", "1:end"}));
  EXPECT_EQ(made("M5"), (Order{"1:+0-33", "1:end"}));
  EXPECT_EQ(made("M7"), (Order{"1:+4-0", "1:end"}));
  EXPECT_EQ(made("M8"), (Order{"1:+32768-0", "1:end"})) << "mist stays as it is";
  EXPECT_EQ(made("M9"), (Order{"1:+0-32772", "1:end"}));
  EXPECT_EQ(made("M3 M8"), (Order{"1:+32769-32", "1:end"}));
}

TEST(PathOutputs, BeforeTheMotionOfTheirLineAndOffAtTheEnd) {
  const machine::Machine machine = machine_with_outputs();
  EXPECT_EQ(order_of(read_text("G1 X1 F60 M3\nM5 G4 P1\nG28 X2 M8\nM30 M3\n", machine).motions),
            (Order{"1:+1-32", "1:move", "2:+0-33", "2:dwell", "3:+32768-0", "3:move", "3:move", "4:+1-32", "4:+0-32805",
                   "4:end"}));
  // Where a program ends without M2 or M30 they stay.
  EXPECT_EQ(order_of(read_text("%\nM3\n%\n", machine).motions), (Order{"2:+1-32", "3:end"}));
}

TEST(PathOutputs, WordsWithoutAnOutputAreToldAsBefore) {
  machine::Machine machine = machine::default_machine();
  const std::string program = "S100 M3\nM8\nM4\nM9\nM5\nM7\nM2\n";
  using Words = std::map<std::string, std::size_t>;
  const Reading none = read_text(program, machine);
  EXPECT_EQ(none.accepted, (Words{{"S", 1}, {"M3", 1}, {"M4", 1}, {"M5", 1}, {"M7", 1}, {"M8", 1}, {"M9", 1}}));
  EXPECT_EQ(order_of(none.motions), Order{"7:end"});
  machine::apply_override(machine, "outputs.m3=1");
  const Reading spindle = read_text(program, machine);
  EXPECT_EQ(spindle.accepted, (Words{{"S", 1}, {"M4", 1}, {"M7", 1}, {"M8", 1}, {"M9", 1}}))
      << "M4 has none of its own";
  EXPECT_EQ(order_of(spindle.motions), (Order{"1:+2-0", "3:+0-2", "5:+0-2", "7:+0-2", "7:end"})) << "M4 ends M3";
}

}  // namespace
}  // namespace trammel::gcode
