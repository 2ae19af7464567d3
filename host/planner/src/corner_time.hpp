// Whether a corner is passed sooner as it is, or by a blend: from the middle of the motion before it to the middle of
// the one behind, either as if it stood alone. Internal to the planner; pure.
#pragma once

#include <array>

#include "axis_limits.hpp"
#include "fillet.hpp"
#include "s_ramp.hpp"
#include "trammel/card_map.hpp"

namespace trammel::planner {

// One of the two motions, at the corner.
struct CornerSide {
  std::array<double, card_map::kMaxAxes> direction{};  // mm a mm of X Y Z, of all axes
  double length = 0;                                   // mm, of the whole motion
  double curvature = 0;                                // 1/mm, of any sign
  double speed = 0;                                    // mm/s, that the program wants; infinite: as fast as may be
};

class CornerTime {
 public:
  explicit CornerTime(const machine::Machine& machine);
  // `sine`: of half the angle between the directions.
  bool is_less_without(const Fillet& blend, const CornerSide& from, const CornerSide& to, double sine) const;

 private:
  struct Along {
    double speed;
    RampLimits limits;
  };
  Along along(const CornerSide& side) const;
  double corner_speed(const CornerSide& from, const CornerSide& to, double sine) const;
  double blend_speed(const Fillet& blend, const CornerSide& from, const CornerSide& to) const;
  static double seconds(const Along& along, double length, double end_speed);

  std::size_t axes_;
  double deviation_;
  std::array<AxisLimits, card_map::kMaxAxes> limits_{};
  std::array<bool, card_map::kMaxAxes> linear_{};  // X Y Z
};

}  // namespace trammel::planner
