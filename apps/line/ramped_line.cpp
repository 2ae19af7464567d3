#include "ramped_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>

#include "common/errors.hpp"
#include "trammel/kinematics/kinematics.hpp"

namespace trammel::app {

machine::Machine in_pulses(const machine::Machine& machine, std::size_t motors) {
  if (motors > machine.motors()) {
    throw UsageError(fmt::format(
        "--to: the machine has {} motors. Give a machine file with more (--machine), or --no-ramp, which needs none",
        machine.motors()));
  }
  // In the card's order; a rotary letter is used only if the others do not suffice.
  const std::string_view letters = motors < card_map::kMaxAxes ? "XYZUVWE" : "XYZAUVWE";
  const kinematics::Kinematics kinematics(machine);
  machine::Machine result = machine;
  result.axes.clear();
  result.kinematics = {};
  result.outputs = {};
  result.tools.clear();
  result.probe = {};
  for (std::size_t i = 0; i < motors; ++i) {
    const kinematics::Joint& joint = kinematics.joint(i);
    const machine::MachineAxis& of = machine.axes[joint.settings];
    machine::MachineAxis motor;
    motor.letter = letters[i];
    motor.steps_per_mm = 1;
    motor.max_velocity = std::min(of.max_velocity, joint.limits.velocity) * joint.steps_per_mm;
    motor.max_acceleration = std::min(of.max_acceleration, joint.limits.acceleration) * joint.steps_per_mm;
    if (of.max_jerk != 0) motor.max_jerk = std::min(of.max_jerk, joint.limits.jerk) * joint.steps_per_mm;
    motor.step_length_ns = of.step_length_ns;
    motor.step_space_ns = of.step_space_ns;
    motor.direction_setup_ns = of.direction_setup_ns;
    motor.direction_hold_ns = of.direction_hold_ns;
    motor.inverted = joint.inverted;
    motor.keeps_place = of.keeps_place;
    result.axes.push_back(motor);
  }
  return result;
}

run::ProgramLines ramped_line(const machine::Machine& machine, const std::vector<std::int64_t>& pulses,
                              double seconds) {
  constexpr double kLongest = 60'000;  // limit of G93
  if (std::all_of(pulses.begin(), pulses.end(), [](std::int64_t p) { return p == 0; })) {
    throw UsageError("line: no axis moves");
  }
  if (seconds > kLongest)
    throw UsageError("the line takes more than 1,000 minutes, which is allowed only without ramps (--no-ramp)");
  std::string text = fmt::format("G93 G91 G1 F{:.9f}", 60 / seconds);
  for (std::size_t i = 0; i < pulses.size(); ++i) text += fmt::format(" {}{}", machine.axes[i].letter, pulses[i]);
  return [text] { return std::make_unique<gcode::TextLines>(text, "line"); };
}

}  // namespace trammel::app
