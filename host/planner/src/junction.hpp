// How fast the corner between two blocks may be passed. Internal to the planner; pure.
#pragma once

#include <array>

#include "trammel/machine/machine.hpp"
#include "trammel/planner/block.hpp"

namespace trammel::planner {

struct Junction {
  double speed = 0;  // mm/s, the most; 0: a stop
  double jump = 0;   // the largest jump of an axis's velocity at a speed of 1
  double bend = 0;   // 1/mm, the jump of curvature; the acceleration's at a speed of 1 where the path has no corner
};

// Of X, Y and Z at a corner: deviation formula and centripetal limit. `acceleration`: the most along the change of
// direction; `sine`: of half the angle; `shorter`: of the two lengths.
double corner_speed_square(double acceleration, double deviation, double sine, double shorter);

class Junctions {
 public:
  // Directions that differ by less are the same: a program's numbers have some five digits. The square of it.
  static constexpr double kTangentSquare = 1e-4 * 1e-4;
  static constexpr double kReversal = -0.9999;  // cosine; less than a degree off

  explicit Junctions(const machine::Machine& machine);
  // Both move. Where motions without a pulse lie between them, the speed is that past the corners as the program has
  // them, if it is more: rounding may make a reversal of two corners.
  Junction between(const Block& from, const Block& to) const;
  // Past the corner alone; 0: a stop.
  double speed(const Block& from, const Heading& to) const;

 private:
  // Of the axes whose directions make the angle, or of the others: all that the two rules need.
  struct Turn {
    double square;  // of the difference of the directions
    double cosine;
    bool even;  // both directions are as long as the path
    bool tangent() const { return square <= kTangentSquare; }
  };
  bool in_angle(std::size_t axis, const Block& block) const { return linear_[axis] || !block.linear; }
  Turn turn(const Block& from, const Heading& to) const;
  double speed(const Block& from, const Heading& to, const Turn& turn) const;
  double corner_square(const Block& from, const Heading& to, const Turn& turn) const;
  double joints_allow(const Direction& change, double size) const;
  double jump_speed(const Block& from, const Heading& to, bool all) const;

  std::size_t axes_;
  std::array<bool, card_map::kMaxAxes> linear_{};          // X Y Z
  std::array<double, card_map::kMaxAxes> acceleration_{};  // mm/s^2
  kinematics::Kinematics kinematics_;
  std::array<double, card_map::kMaxAxes> joint_acceleration_{};  // mm/s^2, infinite where the axes' alone hold
  double deviation_;                                             // mm
};

}  // namespace trammel::planner
