#include "corner_time.hpp"

#include <algorithm>
#include <cmath>

#include "axis_limits.hpp"
#include "junction.hpp"
#include "roots.hpp"

namespace trammel::planner {
CornerTime::CornerTime(const machine::Machine& machine)
    : axes_(machine.axes.size()), deviation_(machine.motion.junction_deviation) {
  for (std::size_t i = 0; i < axes_; ++i) {
    limits_[i] = limits_of(machine.axes[i], machine.motion);
    linear_[i] = is_linear(machine.axes[i]);
  }
}

CornerTime::Along CornerTime::along(const CornerSide& side) const {
  Along most{side.speed, {kNoLimit, kNoLimit}};
  for (std::size_t i = 0; i < axes_; ++i) {
    const double share = std::abs(side.direction[i]);
    if (share == 0) continue;
    most.speed = std::min(most.speed, limits_[i].velocity / share);
    most.limits.acceleration = std::min(most.limits.acceleration, limits_[i].acceleration / share);
    most.limits.jerk = std::min(most.limits.jerk, limits_[i].jerk / share);
  }
  if (side.curvature != 0) {
    most.speed = std::min(most.speed, std::sqrt(kAcross * most.limits.acceleration / std::abs(side.curvature)));
  }
  return most;
}

double CornerTime::corner_speed(const CornerSide& from, const CornerSide& to, double sine) const {
  double acceleration = kNoLimit;
  double speed = kNoLimit;
  for (std::size_t i = 0; i < axes_; ++i) {
    const double part = std::abs(to.direction[i] - from.direction[i]);
    if (part == 0) continue;
    if (linear_[i]) {
      acceleration = std::min(acceleration, limits_[i].acceleration * 2 * sine / part);
    } else {
      speed = std::min(speed, std::sqrt(limits_[i].acceleration * deviation_) / part);
    }
  }
  const double square = corner_speed_square(acceleration, deviation_, sine, std::min(from.length, to.length));
  return std::min(speed, std::sqrt(square));
}

double CornerTime::blend_speed(const Fillet& blend, const CornerSide& from, const CornerSide& to) const {
  AxisLimits plane{kNoLimit, kNoLimit, kNoLimit};
  for (std::size_t i = 0; i < axes_; ++i) {
    if (!linear_[i] || (from.direction[i] == 0 && to.direction[i] == 0)) continue;
    plane.velocity = std::min(plane.velocity, limits_[i].velocity);
    plane.acceleration = std::min(plane.acceleration, limits_[i].acceleration);
    plane.jerk = std::min(plane.jerk, limits_[i].jerk);
  }
  double speed = std::min(plane.velocity, std::sqrt(kAcross * plane.acceleration * blend.radius));
  if (plane.jerk < kNoLimit)
    speed = std::min(speed, cube_root(kTurningJerk * plane.jerk * blend.radius * blend.radius));
  return speed;
}

// Time over the length, with a ramp from `end_speed` to the highest speed that limits and length allow.
double CornerTime::seconds(const Along& along, double length, double end_speed) {
  if (!(length > 0)) return 0;
  const double low = std::min(end_speed, along.speed);
  const double top = std::min(along.speed, ramp_end(low, length, along.limits));
  const double ramp = ramp_length(low, top, along.limits);
  return (ramp > 0 ? 2 * ramp / (low + top) : 0) + (length - ramp) / top;
}

bool CornerTime::is_less_without(const Fillet& blend, const CornerSide& from, const CornerSide& to, double sine) const {
  const Along before = along(from);
  const Along behind = along(to);
  const double slower = std::min(before.speed, behind.speed);
  const double corner = std::min(slower, corner_speed(from, to, sine));
  const double curve = std::min(slower, blend_speed(blend, from, to));
  const double with = seconds(before, from.length / 2 - blend.before, curve) + blend.radius * blend.sweep / curve +
                      seconds(behind, to.length / 2 - blend.behind, curve);
  const double without = seconds(before, from.length / 2, corner) + seconds(behind, to.length / 2, corner);
  return without < with;
}

}  // namespace trammel::planner
