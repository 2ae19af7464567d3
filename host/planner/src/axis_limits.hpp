// What planning may use of an axis's limits: less by max_override, its square and cube, and by hold_reserve. Internal
// to the planner.
#pragma once

#include <cmath>
#include <limits>

#include "trammel/machine/machine.hpp"

namespace trammel::planner {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

struct AxisLimits {
  double velocity;      // mm/s
  double acceleration;  // mm/s^2
  double jerk;          // mm/s^3, infinite without a limit
};

inline AxisLimits limits_of(const machine::MachineAxis& axis, const machine::MotionSettings& motion) {
  const double spare = 1 / motion.max_override;
  return {axis.max_velocity * spare, axis.max_acceleration * (1 - motion.hold_reserve) * spare * spare,
          axis.max_jerk > 0 ? axis.max_jerk * spare * spare * spare : kNoLimit};
}

// Of a joint: infinite ones stay so.
inline AxisLimits limits_of(const machine::JointLimits& joint, const machine::MotionSettings& motion) {
  const double spare = 1 / motion.max_override;
  return {joint.velocity * spare, joint.acceleration * (1 - motion.hold_reserve) * spare * spare,
          joint.jerk * spare * spare * spare};
}

inline bool is_linear(const machine::MachineAxis& axis) { return axis.letter >= 'X' && axis.letter <= 'Z'; }

// Of the acceleration on an arc so much goes across the path at the most: without the rest no ramp would reach the
// speed. It costs 0.25 % of the highest speed.
constexpr double kAcross = 0.995;

// Of the jerk on an arc at the speed v on the radius r, v^3 / r^2 is so much at the most; Curve shares out the rest.
constexpr double kTurningJerk = 0.8;

}  // namespace trammel::planner
