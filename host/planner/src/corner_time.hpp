// Compares the time that a corner takes with the time of its blend, from the middle of the motion before to the middle
// of the motion after. The other ends of the two motions are not considered. Internal to the planner; pure.
#pragma once

#include <array>

#include "axis_limits.hpp"
#include "fillet.hpp"
#include "s_ramp.hpp"
#include "trammel/card_map.hpp"

namespace trammel::planner {

// A motion at the corner.
struct CornerSide {
  std::array<double, card_map::kMaxAxes> direction{};  // mm of each axis per mm of X Y Z
  double length = 0;                                   // mm, of the whole motion
  double curvature = 0;                                // 1/mm, either sign
  double speed = 0;                                    // mm/s, of the program; infinite: as fast as possible
};

class CornerTime {
 public:
  explicit CornerTime(const machine::Machine& machine);
  // Whether the corner takes less time without the blend. `sine`: of half the angle between the directions.
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
