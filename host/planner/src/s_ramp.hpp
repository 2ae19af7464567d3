// Ramps between two speeds, jerk limited, with no acceleration at either end. A ramp from a lower to a higher speed and
// its mirror image have the same length. Pure functions of + - * / and sqrt: the same on every host. Internal to the
// planner.
#pragma once

#include <array>

#include "trammel/planner/speed_plan.hpp"

namespace trammel::planner {

struct RampLimits {
  double acceleration = 0;  // > 0
  double jerk = 0;          // > 0, may be infinite
};

// A ramp, or a stretch at one speed where the two are equal.
struct Ramp {
  double length = 0;
  double from = 0;
  double to = 0;
  RampLimits limits;
  bool short_sight = false;  // as the phases'
};

// Of the ramp from `low` to `high`.
double ramp_length(double low, double high, RampLimits limits);

// The least length in which `high` is reached from `low` without acceleration at first; at `high` the speed goes on
// rising. At most ramp_length().
double reach_length(double low, double high, RampLimits limits);

// The speed that a ramp of the length ends at.
double ramp_end(double low, double length, RampLimits limits);

// The highest speed from `low` to `high` at which `excess`, which rises with it, is not above 0. It is not at `low`.
template <typename Excess>
double highest_speed(double low, double high, Excess excess) {
  double above = excess(high);
  if (above <= 0) return high;
  double below = excess(low);
  // Regula falsi; the end that stays counts half (Illinois), every fourth step halves.
  for (int i = 0; i < 100 && high - low > 1e-13 * high; ++i) {
    double middle = i % 4 == 3 ? (low + high) / 2 : low + (high - low) * (below / (below - above));
    if (!(middle > low && middle < high)) middle = (low + high) / 2;
    const double value = excess(middle);
    if (value > 0) {
      high = middle;
      above = value;
      below /= 2;
    } else {
      low = middle;
      below = value;
      above /= 2;
    }
  }
  return low;
}

// Parts of constant jerk, as many as are returned.
unsigned phases_of(const Ramp& ramp, std::array<Phase, 3>& phases);

}  // namespace trammel::planner
