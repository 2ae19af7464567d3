#include "trammel/kinematics/kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "members.hpp"

namespace trammel::kinematics {

std::int64_t to_pulses(double mm, double steps_per_mm) {
  const double pulses = mm * steps_per_mm;
  const double away = 0.5 + 1e-9 + 1e-15 * std::abs(pulses);
  return static_cast<std::int64_t>(pulses < 0 ? pulses - away : pulses + away);
}

Kinematics::Kinematics(const machine::Machine& machine) : Kinematics(layout_of(machine)) {}

Kinematics Kinematics::in_pulses(std::size_t axes) { return Kinematics(layout_in_pulses(axes)); }

Kinematics::Kinematics(Layout layout) : layout_(std::move(layout)) {
  for (const Joint& joint : layout_.joints) {
    const machine::JointLimits& limits = joint.limits;
    has_joint_limits_ = has_joint_limits_ || std::isfinite(limits.velocity) || std::isfinite(limits.acceleration) ||
                        std::isfinite(limits.jerk);
  }
  for (std::size_t axis = 0; axis < axes(); ++axis) {
    for (std::size_t joint = 0; joint < joints(); ++joint) {
      const double pulses = std::abs(factor(joint, axis)) * layout_.joints[joint].steps_per_mm;
      finest_[axis] = std::max(finest_[axis], pulses);
    }
  }
}

double Kinematics::factor(std::size_t joint, std::size_t axis) const {
  const Joint& of = layout_.joints[joint];
  for (std::size_t i = 0; i < of.term_count; ++i) {
    if (of.terms[i].axis == axis) return of.terms[i].factor;
  }
  return 0;
}

bool Kinematics::joint_for_each_axis() const {
  const auto alone = [](const Joint& joint) { return joint.term_count == 1; };
  return std::all_of(layout_.joints.begin(), layout_.joints.end(), alone);
}

unsigned Kinematics::axes_of(std::size_t joint) const {
  const Joint& of = layout_.joints[joint];
  unsigned axes = 0;
  for (std::size_t i = 0; i < of.term_count; ++i) axes |= 1U << of.terms[i].axis;
  return axes;
}

std::size_t Kinematics::max_terms(std::size_t axis) const {
  std::size_t most = 0;
  for (std::size_t joint = 0; joint < joints(); ++joint) {
    if (factor(joint, axis) != 0) most = std::max(most, layout_.joints[joint].term_count);
  }
  return most;
}

double Kinematics::max_in_plane(std::size_t joint, const Direction& first, const Direction& second) const {
  const double along_first = joint_rate(joint, first);
  const double along_second = joint_rate(joint, second);
  return std::sqrt(along_first * along_first + along_second * along_second);
}

double Kinematics::joint_rate(std::size_t joint, const Direction& direction) const {
  const Joint& of = layout_.joints[joint];
  double sum = 0;
  for (std::size_t i = 0; i < of.term_count; ++i) sum += of.terms[i].factor * direction[of.terms[i].axis];
  return sum;
}

std::int64_t Kinematics::pulses(std::size_t joint, const Coordinates& at) const {
  return to_pulses(joint_rate(joint, at), layout_.joints[joint].steps_per_mm);
}

Pulses Kinematics::pulses(const Coordinates& at) const {
  Pulses result{};
  for (std::size_t joint = 0; joint < joints(); ++joint) result[joint] = pulses(joint, at);
  return result;
}

double Kinematics::step_length(std::size_t joint) const {
  double square = 0;
  for (const Layout::Inverse& inverse : layout_.inverse) {
    for (std::size_t i = 0; i < inverse.term_count; ++i) {
      if (inverse.terms[i].axis == joint) square += inverse.terms[i].factor * inverse.terms[i].factor;
    }
  }
  return std::sqrt(square) / layout_.joints[joint].steps_per_mm;
}

Coordinates Kinematics::coordinates(const Pulses& at) const {
  Coordinates result{};
  for (std::size_t axis = 0; axis < axes(); ++axis) {
    const Layout::Inverse& inverse = layout_.inverse[axis];
    for (std::size_t i = 0; i < inverse.term_count; ++i) {
      const std::uint8_t joint = inverse.terms[i].axis;
      result[axis] += inverse.terms[i].factor * (static_cast<double>(at[joint]) / layout_.joints[joint].steps_per_mm);
    }
  }
  return result;
}

// Two joints with the matrix (a b; c d) from the plane's axes to pulses. A circle stays a circle if the columns are
// orthogonal and equally long. It becomes an ellipse along the joints if each joint has an axis of its own.
std::optional<PlaneMap> Kinematics::plane(std::size_t axis_x, std::size_t axis_y) const {
  std::array<std::uint8_t, 2> moved{};
  std::size_t count = 0;
  for (std::size_t joint = 0; joint < joints(); ++joint) {
    if (factor(joint, axis_x) == 0 && factor(joint, axis_y) == 0) continue;
    if (count == moved.size()) return std::nullopt;
    moved[count++] = static_cast<std::uint8_t>(joint);
  }
  if (count != moved.size()) return std::nullopt;
  // If each axis has a joint of its own, the first joint is that of the plane's first axis.
  if (factor(moved[0], axis_x) == 0) std::swap(moved[0], moved[1]);
  const Joint& first = layout_.joints[moved[0]];
  const Joint& second = layout_.joints[moved[1]];
  const double a = factor(moved[0], axis_x) * first.steps_per_mm;
  const double b = factor(moved[0], axis_y) * first.steps_per_mm;
  const double c = factor(moved[1], axis_x) * second.steps_per_mm;
  const double d = factor(moved[1], axis_y) * second.steps_per_mm;
  const bool further =
      first.term_count + second.term_count != static_cast<std::size_t>((a != 0) + (b != 0) + (c != 0) + (d != 0));
  if (further) return std::nullopt;  // an axis outside the plane moves them too
  PlaneMap map;
  map.joint_x = moved[0];
  map.joint_y = moved[1];
  map.mirrored = a * d - b * c < 0;
  if (b == 0 && c == 0) {
    map.scale_x = std::abs(a);
    map.scale_y = std::abs(d);
    map.circle = map.scale_x == map.scale_y;
    return map;
  }
  map.circle = a * b + c * d == 0 && a * a + c * c == b * b + d * d;
  if (!map.circle) return std::nullopt;
  map.scale_x = map.scale_y = std::sqrt(a * a + c * c);
  return map;
}

}  // namespace trammel::kinematics
