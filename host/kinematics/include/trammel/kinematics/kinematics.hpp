// Kinematics: converts between the path, in coordinates of the machine's axes, and the joints, in pulses of the card's
// axes. All multiplications and divisions by steps/mm are here.
//
// Every member is linear: the length of a joint is a sum of axis coordinates, each times a factor. So a line of the
// path is a line in pulses, which the card follows exactly. Members: "cartesian" (one joint per axis) and "corexy" (the
// first two joints are the motors A = X + Y and B = X - Y of crossed belts). In both, an axis with `second_motor` has a
// second joint, numbered after all first joints, that makes the same steps. A new member is a row of the table in
// src/members.cpp.
//
// Immutable after construction: safe from any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "trammel/card_map.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::kinematics {

// By axis of the machine: machine coordinates in mm (degrees for A, B and C).
using Coordinates = std::array<double, card_map::kMaxAxes>;
// By axis of the machine: mm of the axis per mm of path.
using Direction = std::array<double, card_map::kMaxAxes>;
// By joint: pulses.
using Pulses = std::array<std::int64_t, card_map::kMaxAxes>;

// mm (or degrees) to pulses, rounded half away from zero. A value up to 1e-9 pulses below a half counts as a half: sums
// of decimal fractions miss it by some 1e-13. |mm * steps_per_mm| below 2^52.
std::int64_t to_pulses(double mm, double steps_per_mm);

// Lengths are in mm of the joint (mm of belt if it drives a belt).
struct Joint {
  // `factor` mm of the joint per mm of the axis.
  struct Term {
    std::uint8_t axis;
    double factor;
  };
  static constexpr std::size_t kMaxTerms = 2;

  double steps_per_mm = 0;  // pulses, > 0
  std::array<Term, kMaxTerms> terms{};
  std::size_t term_count = 0;  // 1 or 2
  std::uint8_t settings = 0;   // machine axis that gives its step times
  bool inverted = false;       // its DIR pin is inverted
  // Limits of the joint itself, in addition to those of its axes; infinite if there are none.
  machine::JointLimits limits;
};

// The two joints that make a circle in a plane, if no other joint moves and a circle stays a circle or becomes an
// ellipse along the joints.
struct PlaneMap {
  std::uint8_t joint_x = 0;
  std::uint8_t joint_y = 0;
  double scale_x = 0;  // pulses per mm in the plane, in any direction if `circle`
  double scale_y = 0;
  bool circle = false;    // a circle is a circle in pulses; else it is an ellipse along the joints
  bool mirrored = false;  // clockwise turns into counter-clockwise
};

// The joints of a machine, as a member defines them.
struct Layout {
  // The coordinate of an axis: the sum of the joints' lengths, each times a factor (`axis` of a term is a joint here).
  struct Inverse {
    std::array<Joint::Term, Joint::kMaxTerms> terms{};
    std::size_t term_count = 0;
  };
  std::vector<Joint> joints;
  std::vector<Inverse> inverse;  // by axis
};

class Kinematics {
 public:
  // The member that the machine names, with its joints. The machine has passed the checks of its file (machine.hpp).
  explicit Kinematics(const machine::Machine& machine);
  // A card without a machine file: coordinates are pulses.
  static Kinematics in_pulses(std::size_t axes);

  std::size_t axes() const { return layout_.inverse.size(); }
  std::size_t joints() const { return layout_.joints.size(); }
  const Joint& joint(std::size_t joint) const { return layout_.joints[joint]; }
  // Whether every joint moves with one axis only.
  bool joint_for_each_axis() const;
  // The axes that move a joint, bit n: axis n.
  unsigned axes_of(std::size_t joint) const;
  // Among the joints that move with an axis: the largest number of axes that move one of them.
  std::size_t max_terms(std::size_t axis) const;
  // Whether a joint has limits in addition to those of the axes.
  bool has_joint_limits() const { return has_joint_limits_; }

  // From absolute positions, so that errors do not add up.
  std::int64_t pulses(std::size_t joint, const Coordinates& at) const;
  Pulses pulses(const Coordinates& at) const;
  // The inverse: coordinates of the axes at these joint positions.
  Coordinates coordinates(const Pulses& at) const;

  // mm of the joint per mm of path, signed; pulse_rate(): pulses per mm of path.
  double joint_rate(std::size_t joint, const Direction& direction) const;
  double pulse_rate(std::size_t joint, const Direction& direction) const {
    return joint_rate(joint, direction) * layout_.joints[joint].steps_per_mm;
  }
  // mm (degrees) that the machine moves per pulse of this joint alone; 0 for the second motor of an axis, which moves
  // with the first.
  double step_length(std::size_t joint) const;
  // The most pulses that a joint makes per mm of this axis alone.
  double finest(std::size_t axis) const { return finest_[axis]; }
  // The largest |joint_rate| of the directions in a plane, given by two unit vectors at right angles.
  double max_in_plane(std::size_t joint, const Direction& first, const Direction& second) const;
  // Empty if other joints move too, or if a circle of the plane becomes neither a circle nor an ellipse along the
  // joints.
  std::optional<PlaneMap> plane(std::size_t axis_x, std::size_t axis_y) const;

 private:
  explicit Kinematics(Layout layout);
  double factor(std::size_t joint, std::size_t axis) const;

  Layout layout_;
  std::array<double, card_map::kMaxAxes> finest_{};
  bool has_joint_limits_ = false;
};

}  // namespace trammel::kinematics
