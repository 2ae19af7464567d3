// Kinematics: the one place between the path, in coordinates of the machine's axes, and the joints, in pulses of the
// card's axes. Everything that multiplies by steps/mm or divides by it does so here.
//
// Every member is linear: a joint's length is a sum of axis coordinates, each times a factor. So a line of the path is
// a line of pulses, which the card keeps exactly. Members: "cartesian" (a joint for each axis), "corexy" (the first two
// joints are the motors A = X + Y and B = X - Y of crossed belts); in both, an axis with `second_motor` has a second
// joint that makes the same steps, behind the others. A new member is a row of the table in src/members.cpp.
//
// Immutable once made: safe from any thread.
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

// mm (or degrees) to pulses, half away from zero. Sums of decimal fractions miss a half by some 1e-13: they count as
// it. |mm * steps_per_mm| below 2^52.
std::int64_t to_pulses(double mm, double steps_per_mm);

// Lengths in mm of the joint (of belt, where a belt moves it).
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
  std::uint8_t settings = 0;   // machine axis whose step times it has
  bool inverted = false;       // its DIR pin
  // Limits of the joint itself, beside its axes' limits; infinite where these alone hold.
  machine::JointLimits limits;
};

// The joints that make a circle of a plane: alone, and so that a circle stays one.
struct PlaneMap {
  std::uint8_t joint_x = 0;
  std::uint8_t joint_y = 0;
  double scale_x = 0;  // pulses per mm of the plane, along any direction where `circle`
  double scale_y = 0;
  bool circle = false;    // a circle is a circle of pulses; else an ellipse along the joints
  bool mirrored = false;  // clockwise turns into counter-clockwise
};

// The joints that a member gives a machine.
struct Layout {
  // An axis's coordinate: the sum of the joints' lengths, each times a factor (a term's `axis` is a joint here).
  struct Inverse {
    std::array<Joint::Term, Joint::kMaxTerms> terms{};
    std::size_t term_count = 0;
  };
  std::vector<Joint> joints;
  std::vector<Inverse> inverse;  // by axis
};

class Kinematics {
 public:
  // The member that the machine names, with its joints. The machine was checked when it was read (machine.hpp).
  explicit Kinematics(const machine::Machine& machine);
  // A card without a machine: its coordinates are pulses.
  static Kinematics in_pulses(std::size_t axes);

  std::size_t axes() const { return layout_.inverse.size(); }
  std::size_t joints() const { return layout_.joints.size(); }
  const Joint& joint(std::size_t joint) const { return layout_.joints[joint]; }
  // No joint moves with two axes.
  bool joint_for_each_axis() const;
  // The axes that move a joint, bit n: axis n.
  unsigned axes_of(std::size_t joint) const;
  // Of the joints that move with an axis, the most axes that one of them has.
  std::size_t max_terms(std::size_t axis) const;
  // Whether a joint has limits beside those of the axes.
  bool has_joint_limits() const { return has_joint_limits_; }

  // Absolute positions: nothing drifts.
  std::int64_t pulses(std::size_t joint, const Coordinates& at) const;
  Pulses pulses(const Coordinates& at) const;
  // The inverse: where the axes are when the joints stand so.
  Coordinates coordinates(const Pulses& at) const;

  // mm of the joint per mm of path, signed; and pulses.
  double joint_rate(std::size_t joint, const Direction& direction) const;
  double pulse_rate(std::size_t joint, const Direction& direction) const {
    return joint_rate(joint, direction) * layout_.joints[joint].steps_per_mm;
  }
  // mm (degrees) by which the machine moves with one pulse of the joint alone; 0 for an axis's second motor, which
  // moves with the first.
  double step_length(std::size_t joint) const;
  // Most pulses that a joint makes for a mm of this axis alone.
  double finest(std::size_t axis) const { return finest_[axis]; }
  // The largest |joint_rate| of the directions in a plane, given by two unit vectors at right angles.
  double max_in_plane(std::size_t joint, const Direction& first, const Direction& second) const;
  // Nothing where other joints move as well, or where a circle of the plane is neither a circle nor an ellipse along
  // the joints.
  std::optional<PlaneMap> plane(std::size_t axis_x, std::size_t axis_y) const;

 private:
  explicit Kinematics(Layout layout);
  double factor(std::size_t joint, std::size_t axis) const;

  Layout layout_;
  std::array<double, card_map::kMaxAxes> finest_{};
  bool has_joint_limits_ = false;
};

}  // namespace trammel::kinematics
