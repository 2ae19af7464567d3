// M3 to M5 and M7 to M9 switch the outputs that the machine file names.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "reading.hpp"

namespace trammel::gcode {
namespace {

using ::testing::HasSubstr;

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
  // If a program ends without M2 or M30, the outputs keep their levels.
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
  machine::apply_override(machine, "spindle.output=0");
  EXPECT_EQ(read_text(program, machine).accepted, (Words{{"M7", 1}, {"M8", 1}, {"M9", 1}})) << "S sets the pulse width";
}

machine::Machine machine_with_numbered_outputs() {
  machine::Machine machine = machine_with_outputs();
  machine::apply_override(machine, "outputs.p0=4");
  machine::apply_override(machine, "outputs.p15=[6, 7]");
  return machine;
}

TEST(PathOutputs, NumberedOnesWithTheMotionOrBehindAStop) {
  const machine::Machine machine = machine_with_numbered_outputs();
  const auto made = [&](const std::string& text) { return order_of(read_text(text + "\n", machine).motions); };
  EXPECT_EQ(made("M62 P0"), (Order{"1:+16-0", "1:end"}));
  EXPECT_EQ(made("M63 P15"), (Order{"1:+0-192", "1:end"}));
  EXPECT_EQ(made("G1 X1 F60\nM62 P0\nX2\nM63 P0 X3"),
            (Order{"1:move", "2:+16-0", "3:move", "4:+0-16", "4:move", "4:end"}));
  EXPECT_EQ(made("M64 P0"), (Order{"1:dwell", "1:+16-0", "1:end"}));
  EXPECT_EQ(made("M65 P15"), (Order{"1:dwell", "1:+0-192", "1:end"}));
  EXPECT_EQ(made("M62 P0\nM3\nM2"), (Order{"1:+16-0", "2:+1-32", "3:+0-32805", "3:end"}))
      << "M2 leaves them, as LinuxCNC";
}

TEST(PathOutputs, NumberedOnesThatAreRefused) {
  const machine::Machine machine = machine_with_numbered_outputs();
  const auto refused = [&](const std::string& text) { return read_text(text + "\n", machine).message(); };
  EXPECT_THAT(refused("M62 P1"), HasSubstr("M62 P1: [outputs] of the machine file names no output for p1"));
  EXPECT_THAT(refused("M65 P16"), HasSubstr("names no output for p16"));
  EXPECT_THAT(refused("M64"), HasSubstr("need P"));
  EXPECT_THAT(refused("M64 P-1"), HasSubstr("negative"));
  EXPECT_THAT(refused("M64 P0.5"), HasSubstr("whole"));
  EXPECT_THAT(refused("M62 P0 M63"), HasSubstr("modal group"));
  for (const char* line : {"G4 P0 M62", "G64 P0 M62", "G1 F60 X0\nG2 I1 P0 M62", "G82 X0 Z0 R1 P0 M62",
                           "G10 L2 X1 P0 M62", "G5 F60 X9 I1 J1 P0 Q0 M62"}) {
    EXPECT_THAT(refused(line), HasSubstr("takes P")) << line;
  }
}

}  // namespace
}  // namespace trammel::gcode
