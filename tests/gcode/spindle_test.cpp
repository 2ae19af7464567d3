// Power in each motion by S, M3, M4 and M5, for a machine whose file has a spindle or a laser.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "reading.hpp"

namespace trammel::gcode {
namespace {

machine::Machine machine_with_spindle(const char* more) {
  machine::Machine machine = machine::default_machine();
  machine::apply_override(machine, "spindle.output=1");
  machine::apply_override(machine, "spindle.max_s=1000");
  if (*more != 0) machine::apply_override(machine, more);
  return machine;
}

// Power of each motion except output changes, in percent. "~": it follows the speed; "d": a dwell.
std::vector<std::string> powers_of(const machine::Machine& machine, const std::string& text) {
  std::vector<std::string> result;
  for (const Motion& motion : read_text(text, machine).motions) {
    if (motion.kind == MotionKind::kOutput) continue;
    result.push_back(std::string(motion.kind == MotionKind::kDwell ? "d" : "") + (motion.power_follows ? "~" : "") +
                     std::to_string(static_cast<int>(motion.power * 100 + 0.5)));
  }
  return result;
}

using Powers = std::vector<std::string>;

TEST(Spindle, TurnsInAllMotionsUntilItIsOff) {
  const machine::Machine machine = machine_with_spindle("");
  EXPECT_EQ(powers_of(machine, "S500\nG1 X1 F60\nM3\nX2\nG0 X3 S250\nG4 P1\nM4 X4\nM5 X5\nM3 S2000 X6\nM2\n"),
            (Powers{"0", "50", "25", "d25", "25", "0", "100", "0"}));
}

TEST(Spindle, CuttingWaitsForANewSpeed) {
  const machine::Machine machine = machine_with_spindle("spindle.spin_up_s=2.5");
  EXPECT_EQ(powers_of(machine, "M3 S500\nG1 X1 F60\nX2 S500\nX3 S600\nM5\nX4 S700\nM2\n"),
            (Powers{"d50", "50", "50", "d60", "60", "0", "0"}));
}

// Like Grbl 1.1 in laser mode.
TEST(Laser, IsDarkInTraversesAndFollowsWithM4) {
  const machine::Machine machine = machine_with_spindle("spindle.laser=true");
  EXPECT_EQ(powers_of(machine, "M3 S1000\nG0 X1\nG1 X2 F60\nG4 P1\nG2 X4 I1\nG0 X5\nG4 P1\nG1 S0 X6\nS500 X7\nM2\n"),
            (Powers{"0", "100", "d100", "100", "0", "d0", "0", "50", "0"}));
  EXPECT_EQ(powers_of(machine, "M4 S1000\nG0 X1\nG1 X2 F60\nX3 S10\nM3 X4\nM5 X5\nM2\n"),
            (Powers{"0", "~100", "~1", "1", "0", "0"}));
  EXPECT_EQ(powers_of(machine, "F60 M3 S1000\nG3 X4 I2\nG4 P1\nG80\nG4 P1\nM2\n"), (Powers{"100", "d100", "d0", "0"}));
}

TEST(Spindle, CuttingWaitsForTheInputThatSaysAtSpeed) {
  const auto waits = [](const machine::Machine& machine) {
    std::vector<bool> result;
    for (const Motion& motion : read_text("M3 S500\nG1 X1 F60\nS600\nM5\nM2\n", machine).motions) {
      if (motion.kind == MotionKind::kDwell) result.push_back(motion.awaits_spindle && motion.seconds == 0);
    }
    return result;
  };
  machine::Machine machine = machine_with_spindle("inputs.spindle_at_speed=3");
  EXPECT_EQ(waits(machine), (std::vector<bool>{true, true}));
  machine::apply_override(machine, "spindle.laser=true");
  EXPECT_EQ(waits(machine), std::vector<bool>{}) << "a laser is there at once";
}

TEST(Spindle, ItsOutputIsSwitchedByM3AndM4) {
  const machine::Machine machine = machine_with_spindle("outputs.m4=2");
  std::vector<std::pair<unsigned, unsigned>> switched;
  for (const Motion& motion : read_text("M3\nM4\nM5\nM2\n", machine).motions) {
    if (motion.kind == MotionKind::kOutput) switched.emplace_back(motion.set, motion.clear);
  }
  const std::vector<std::pair<unsigned, unsigned>> expected{{2, 4}, {6, 0}, {0, 6}, {0, 6}};
  EXPECT_EQ(switched, expected);
}

TEST(Spindle, WithoutTheTableSHasNoEffect) {
  const machine::Machine machine = machine::default_machine();
  EXPECT_EQ(powers_of(machine, "M3 S1000\nG1 X1 F60\nM2\n"), (Powers{"0", "0"}));
}

}  // namespace
}  // namespace trammel::gcode
