#include "trammel/linuxcnc/joint_settings.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "trammel/kinematics/kinematics.hpp"
#include "trammel/planner/card_limits.hpp"

namespace trammel::linuxcnc {
namespace {

constexpr double kSpeedReserve = 1.05;
constexpr std::uint32_t kMostLead = 128;  // periods: half of the ring's capacity

std::chrono::nanoseconds given_or(std::uint32_t given, std::chrono::nanoseconds of_machine) {
  return given != 0 ? std::chrono::nanoseconds(given) : of_machine;
}

}  // namespace

std::array<double, card_map::kMaxAxes> pulses_per_unit(const machine::Machine& machine,
                                                       const trammel_settings& settings) {
  std::array<double, card_map::kMaxAxes> scales{};
  const kinematics::Kinematics kinematics(machine);
  for (std::size_t n = 0; n < kinematics.joints(); ++n) {
    const double given = settings.pulses_per_unit[n];
    scales[n] = given != 0 && std::isfinite(given) ? given : machine.axes[kinematics.joint(n).settings].steps_per_mm;
  }
  return scales;
}

ServoSettings servo_settings(const machine::Machine& machine, const trammel_settings& settings) {
  ServoSettings servo;
  if (settings.lead_periods != 0) servo.lead = std::min(settings.lead_periods, kMostLead);
  const kinematics::Kinematics kinematics(machine);
  for (std::size_t n = 0; n < kinematics.joints(); ++n) {
    const machine::MachineAxis& axis = machine.axes[kinematics.joint(n).settings];
    const double given = settings.max_speed[n];
    const bool is_given = given > 0 && std::isfinite(given);
    servo.max_speed[n] = is_given ? given : kSpeedReserve * axis.max_velocity * axis.steps_per_mm;
  }
  servo.stale_periods = static_cast<unsigned>(std::min(machine.motion.stale_periods, 255.0));
  return servo;
}

void configure_joints(driver::Card& card, const machine::Machine& machine, const trammel_settings& settings) {
  const kinematics::Kinematics kinematics(machine);
  for (std::size_t n = 0; n < kinematics.joints(); ++n) {
    const kinematics::Joint& joint = kinematics.joint(n);
    driver::AxisSettings axis = planner::settings_of(machine.axes[joint.settings]);
    axis.invert_second = joint.inverted;
    axis.step_length = given_or(settings.step_length[n], axis.step_length);
    axis.step_space = given_or(settings.step_space[n], axis.step_space);
    axis.direction_setup = given_or(settings.dir_setup[n], axis.direction_setup);
    axis.direction_hold = given_or(settings.dir_hold[n], axis.direction_hold);
    card.configure_axis(static_cast<unsigned>(n), axis);
  }
}

}  // namespace trammel::linuxcnc
