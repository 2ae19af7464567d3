#include "junction.hpp"

#include <algorithm>
#include <cmath>

#include "axis_limits.hpp"
#include "trammel/driver/trigonometry.hpp"

namespace trammel::planner {
namespace {

constexpr double kEven = 1e-6;

}  // namespace

double corner_speed_square(double acceleration, double deviation, double sine, double shorter) {
  const double cosine = std::sqrt(1 - sine * sine);
  const double angle = 2 * driver::arc_tangent(sine, cosine);
  // sine^2 / (1 + cosine) is 1 - cosine without cancellation.
  const double formula = acceleration * deviation * cosine * (1 + cosine) / (sine * sine);
  return std::min(formula, acceleration * shorter / angle);
}

Junctions::Junctions(const machine::Machine& machine)
    : axes_(machine.axes.size()), kinematics_(machine), deviation_(machine.motion.junction_deviation) {
  for (std::size_t i = 0; i < kinematics_.joints(); ++i) {
    joint_acceleration_[i] = limits_of(kinematics_.joint(i).limits, machine.motion).acceleration;
  }
  for (std::size_t i = 0; i < axes_; ++i) {
    linear_[i] = is_linear(machine.axes[i]);
    acceleration_[i] = limits_of(machine.axes[i], machine.motion).acceleration;
  }
}

Junctions::Turn Junctions::turn(const Block& from, const Heading& to) const {
  double square = 0;
  double dot = 0;
  double before = 0;
  double after = 0;
  for (std::size_t i = 0; i < axes_; ++i) {
    if (!in_angle(i, from)) continue;
    const double change = to.entry[i] - from.exit[i];
    square += change * change;
    dot += to.entry[i] * from.exit[i];
    before += from.exit[i] * from.exit[i];
    after += to.entry[i] * to.entry[i];
  }
  const double lengths = std::sqrt(before * after);
  return {square, lengths > 0 ? dot / lengths : -1, std::abs(before - 1) <= kEven && std::abs(after - 1) <= kEven};
}

double Junctions::corner_square(const Block& from, const Heading& to, const Turn& turn) const {
  const double size = std::sqrt(turn.square);
  Direction change{};
  for (std::size_t i = 0; i < axes_; ++i) change[i] = in_angle(i, from) ? to.entry[i] - from.exit[i] : 0;
  double acceleration = joints_allow(change, size);
  for (std::size_t i = 0; i < axes_; ++i) {
    const double part = std::abs(change[i]);
    if (part > 0) acceleration = std::min(acceleration, acceleration_[i] * size / part);
  }
  return corner_speed_square(acceleration, deviation_, std::min(1.0, size / 2), std::min(from.length, to.length));
}

// The largest acceleration along a change of direction, whose length is `size`, that the joints' own limits allow.
double Junctions::joints_allow(const Direction& change, double size) const {
  double acceleration = kNoLimit;
  if (!kinematics_.has_joint_limits()) return acceleration;
  for (std::size_t i = 0; i < kinematics_.joints(); ++i) {
    const double part = std::abs(kinematics_.joint_rate(i, change));
    if (part > 0) acceleration = std::min(acceleration, joint_acceleration_[i] * size / part);
  }
  return acceleration;
}

// The speed at which no axis outside the angle (`all`: no axis) jumps by more than acceleration and deviation allow.
double Junctions::jump_speed(const Block& from, const Heading& to, bool all) const {
  double speed = kNoLimit;
  for (std::size_t i = 0; i < axes_; ++i) {
    const double part = std::abs(to.entry[i] - from.exit[i]);
    if (part == 0 || (!all && in_angle(i, from))) continue;
    speed = std::min(speed, std::sqrt(acceleration_[i] * deviation_) / part);
  }
  return speed;
}

double Junctions::speed(const Block& from, const Heading& to) const { return speed(from, to, turn(from, to)); }

double Junctions::speed(const Block& from, const Heading& to, const Turn& turn) const {
  if (from.path_control == gcode::PathControl::kExactStop || from.linear != to.linear) return 0;
  if (turn.cosine < kReversal) return 0;
  const bool exact = deviation_ == 0 || from.path_control == gcode::PathControl::kExactPath;
  if (exact && !turn.tangent()) return 0;
  const double speed = std::min({from.speed, to.speed, jump_speed(from, to, !turn.even)});
  if (!turn.even || !(turn.square > 0)) return speed;
  return std::min(speed, std::sqrt(corner_square(from, to, turn)));
}

Junction Junctions::between(const Block& from, const Block& to) const {
  const Heading heading{to.entry, to.length, to.speed, to.linear};
  const Turn corner = turn(from, heading);
  Junction junction;
  junction.speed = speed(from, heading, corner);
  if (to.detour.speed > 0) {
    junction.speed = std::max(junction.speed, std::min(to.detour.speed, speed(from, to.detour.first)));
  }
  if (junction.speed == 0) return junction;
  for (std::size_t i = 0; i < axes_; ++i) junction.jump = std::max(junction.jump, std::abs(to.entry[i] - from.exit[i]));
  if (corner.tangent()) junction.bend = std::abs(to.curvature - from.curvature);
  return junction;
}

}  // namespace trammel::planner
