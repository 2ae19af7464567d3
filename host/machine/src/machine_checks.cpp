#include "machine_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "text.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card_timing.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::machine {

void check_motors(const std::string& where, const Machine& machine) {
  if (machine.axes.size() > card_map::kMaxAxes) {
    refuse(fmt::format("{}: {} axes, the card has at most {}", where, machine.axes.size(), card_map::kMaxAxes));
  }
  if (machine.motors() > card_map::kMaxAxes) {
    refuse(fmt::format("{}: {} motors, second ones included, the card has at most {}", where, machine.motors(),
                       card_map::kMaxAxes));
  }
  for (const MachineAxis& axis : machine.axes) {
    if (axis.second_inverted && !axis.second_motor) {
      refuse(fmt::format("{}: axis {}: second_inverted without second_motor", where, axis.letter));
    }
  }
}

void check_kinematics(const std::string& where, const Machine& machine) {
  const JointLimits& motor = machine.kinematics.motor;
  const bool limited = std::isfinite(motor.velocity) || std::isfinite(motor.acceleration) || std::isfinite(motor.jerk);
  if (machine.kinematics.name != "corexy") {
    if (!limited) return;
    refuse(
        fmt::format("{}: kinematics: motor limits are for corexy; here each axis has its motor and its limits", where));
  }
  for (const char letter : {'X', 'Y'}) {
    const std::optional<std::size_t> axis = machine.axis(letter);
    if (!axis) refuse(fmt::format("{}: kinematics: corexy needs the axes X and Y, and {} is missing", where, letter));
    if (machine.axes[*axis].second_motor) {
      refuse(fmt::format("{}: axis {}: second_motor: with corexy two motors move X and Y together", where, letter));
    }
  }
}

void check_ramps(const std::string& where, const Machine& machine) {
  constexpr double kLongest = 1000;  // s: the card's slowest slew at 1 MHz
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  const auto check = [&](const std::string& what, double seconds, const char* reached, const char* unit_of) {
    if (seconds <= kLongest) return;
    refuse(
        fmt::format("{}: {}: {} is reached after {:g} s; at most {:g} s are possible, which is the card's longest "
                    "ramp at 1 MHz: is {}?",
                    where, what, reached, seconds, kLongest, unit_of));
  };
  // With CoreXY a motion along X or Y moves each motor by the same distance as the axis, so the lower limit applies.
  const JointLimits& motor = machine.kinematics.motor;
  const bool motors = machine.kinematics.name == "corexy";
  for (const MachineAxis& axis : machine.axes) {
    const bool moved_by_both = motors && (axis.letter == 'X' || axis.letter == 'Y');
    const auto limit = [&](double of_axis, double of_motor) {
      return moved_by_both ? std::min(of_axis, of_motor) : of_axis;
    };
    const std::string name =
        fmt::format("axis {}{}", axis.letter, moved_by_both ? " with the limits of kinematics" : "");
    const double velocity = limit(axis.max_velocity, motor.velocity);
    const double acceleration = limit(axis.max_acceleration, motor.acceleration);
    const double jerk = limit(axis.max_jerk > 0 ? axis.max_jerk : kNoLimit, motor.jerk);
    check(name, velocity / acceleration, "max_velocity", "max_acceleration in mm/s^2");
    if (jerk < kNoLimit) check(name, acceleration / jerk, "max_acceleration", "max_jerk in mm/s^3");
  }
}

void check_times(const std::string& where, const Machine& machine) {
  constexpr double kLongest = 1e15;  // ns; more than any register at the slowest clock
  const auto check = [&](const MachineAxis& axis, double time, const char* what) {
    const std::chrono::nanoseconds whole(static_cast<std::int64_t>(std::ceil(std::min(time, kLongest))));
    try {
      driver::step_time_clocks(whole, machine.clock_hz, what);
    } catch (const driver::ArgumentError& error) {
      refuse(fmt::format("{}: axis {}: {}", where, axis.letter, error.what()));
    }
  };
  for (const MachineAxis& axis : machine.axes) {
    check(axis, axis.step_length_ns, "step_length_ns");
    check(axis, axis.step_space_ns, "step_space_ns");
    check(axis, axis.direction_setup_ns, "direction_setup_ns");
    check(axis, axis.direction_hold_ns, "direction_hold_ns");
  }
}

void check_soft_limits(const std::string& where, const Machine& machine) {
  for (const MachineAxis& axis : machine.axes) {
    const bool rotary = axis.letter == 'A' || axis.letter == 'B' || axis.letter == 'C';
    const bool limited = std::isfinite(axis.min) || std::isfinite(axis.max);
    if (axis.endless && !rotary) refuse(fmt::format("{}: axis {}: only A, B and C can be endless", where, axis.letter));
    if (axis.endless && limited) {
      refuse(fmt::format("{}: axis {}: endless, but it has min or max", where, axis.letter));
    }
    if (rotary && !axis.endless && !limited) {
      refuse(fmt::format("{}: axis {}: a rotary axis needs min and max, or endless = true where it has no soft limits",
                         where, axis.letter));
    }
  }
}

void check_outputs(const std::string& where, const MachineOutputs& outputs) {
  const auto check = [&where](unsigned both, const char* named) {
    if (both == 0) return;
    unsigned output = 0;
    while ((both >> output & 1U) == 0) ++output;
    refuse(fmt::format("{}: output {} is named for {}", where, output, named));
  };
  check(unsigned{outputs.spindle()} & outputs.coolant(), "the spindle (m3, m4) and for coolant (m7, m8)");
  check((unsigned{outputs.spindle()} | outputs.coolant()) & outputs.all_numbered(),
        "the spindle or for coolant and for M62 to M65 (p0 to p15)");
  const unsigned others = unsigned{outputs.of_words()} | outputs.safe();
  check(outputs.roles() & others,
        "the drives or the card (enable, brake, charge_pump, healthy) and for the program, which does not switch it");
  check(unsigned{outputs.enable} & outputs.brake, "enable and for brake");
  check(unsigned{outputs.charge_pump} & outputs.healthy, "charge_pump and for healthy");
  check((unsigned{outputs.enable} | outputs.brake) & (unsigned{outputs.charge_pump} | outputs.healthy),
        "the drives (enable, brake) and for the card (charge_pump, healthy)");
}

}  // namespace trammel::machine
