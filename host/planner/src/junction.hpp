// The speed at which the corner between two blocks may be passed. Internal to the planner; pure.
#pragma once

#include <array>

#include "trammel/machine/machine.hpp"
#include "trammel/planner/block.hpp"

namespace trammel::planner {

struct Junction {
  double speed = 0;  // mm/s, the most at the corner; 0: a stop
  double jump = 0;   // the largest jump of an axis's velocity, per mm/s of speed
  // 1/mm, the jump of curvature if the path has no corner. Times v^2, it is the jump of the acceleration.
  double bend = 0;
};

// Square of the highest speed of X, Y and Z at a corner, by junction deviation and centripetal limit. `acceleration`:
// the most along the change of direction; `sine`: of half the angle; `shorter`: the shorter of the two lengths.
double corner_speed_square(double acceleration, double deviation, double sine, double shorter);

class Junctions {
 public:
  // Square of the largest difference of directions that counts as none. Numbers in programs have some five digits.
  static constexpr double kTangentSquare = 1e-4 * 1e-4;
  static constexpr double kReversal = -0.9999;  // cosine of the angle; below it: less than a degree off a reversal

  explicit Junctions(const machine::Machine& machine);
  // Both blocks must move. If motions without a pulse lie between them, the speed is that of the corners as programmed,
  // if that is higher: rounding may turn two corners into a reversal.
  Junction between(const Block& from, const Block& to) const;
  // Speed at this corner without such motions; 0: a stop.
  double speed(const Block& from, const Heading& to) const;

 private:
  // Change of direction, over the axes that count for the angle.
  struct Turn {
    double square;  // of the difference of the directions
    double cosine;
    bool even;  // both directions have length 1 over these axes
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
  // mm/s^2, infinite if only its axes have limits.
  std::array<double, card_map::kMaxAxes> joint_acceleration_{};
  double deviation_;  // mm
};

}  // namespace trammel::planner
