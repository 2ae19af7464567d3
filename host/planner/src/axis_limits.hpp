// The part of an axis's limits that planning may use: divided by max_override, its square and its cube; acceleration is
// also reduced by hold_reserve. Internal to the planner.
#pragma once

#include <cmath>
#include <limits>

#include "trammel/machine/machine.hpp"

namespace trammel::planner {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

struct AxisLimits {
  double velocity;      // mm/s
  double acceleration;  // mm/s^2
  double jerk;          // mm/s^3, infinite: no limit
};

inline AxisLimits limits_of(const machine::MachineAxis& axis, const machine::MotionSettings& motion) {
  const double spare = 1 / motion.max_override;
  return {axis.max_velocity * spare, axis.max_acceleration * (1 - motion.hold_reserve) * spare * spare,
          axis.max_jerk > 0 ? axis.max_jerk * spare * spare * spare : kNoLimit};
}

// Of a joint; infinite limits stay infinite.
inline AxisLimits limits_of(const machine::JointLimits& joint, const machine::MotionSettings& motion) {
  const double spare = 1 / motion.max_override;
  return {joint.velocity * spare, joint.acceleration * (1 - motion.hold_reserve) * spare * spare,
          joint.jerk * spare * spare * spare};
}

inline bool is_linear(const machine::MachineAxis& axis) { return axis.letter >= 'X' && axis.letter <= 'Z'; }

// The largest share of the acceleration on an arc that acts across the path. Without the rest, no ramp would reach the
// speed. It costs 0.25 % of the highest speed.
constexpr double kAcross = 0.995;

// The largest share of the jerk on an arc that v^3 / r^2 takes, at the speed v and the radius r; Curve divides the
// rest.
constexpr double kTurningJerk = 0.8;

}  // namespace trammel::planner
