// Ramps between two speeds with limited jerk and no acceleration at either end. A ramp from a lower to a higher speed
// and its mirror image have the same length. Pure functions of + - * / and sqrt: the same on every host. Internal to
// the planner.
#pragma once

namespace trammel::planner {

struct RampLimits {
  double acceleration = 0;  // > 0
  double jerk = 0;          // > 0, may be infinite
};

// Length of the ramp from `low` to `high`.
double ramp_length(double low, double high, RampLimits limits);

// The least length in which the speed rises from `low`, without acceleration there, to `high`, where it may go on
// rising. At most ramp_length().
double reach_length(double low, double high, RampLimits limits);

// The speed at the end of a ramp of this length.
double ramp_end(double low, double length, RampLimits limits);

// Time in which a part, whose acceleration is not below 0, covers `length`; at most `most`.
double rising_time(double length, double speed, double acceleration, double jerk, double most);

constexpr int kMaxTries = 100;  // of highest(), in addition to both ends

// The highest value from `low` to `high`, accurate to `share` of it, at which `excess` is not above 0. `excess` rises
// with the value and is not above 0 at `low`.
template <typename Excess>
double highest(double low, double high, Excess excess, double share = 1e-13) {
  double above = excess(high);
  if (above <= 0) return high;
  double below = excess(low);
  // Regula falsi. The end that stays counts half (Illinois); every fourth step bisects.
  for (int i = 0; i < kMaxTries && high - low > share * high; ++i) {
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

}  // namespace trammel::planner
