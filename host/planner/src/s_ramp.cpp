#include "s_ramp.hpp"

#include <algorithm>
#include <cmath>

namespace trammel::planner {
namespace {

// Dividing by the jerk, instead of multiplying by it, gives the right limit for an infinite jerk.
double rise_time(RampLimits limits) { return limits.acceleration / limits.jerk; }

double ramp_time(double change, RampLimits limits) {
  if (!(change > 0)) return 0;
  const double rise = rise_time(limits);
  return change >= limits.acceleration * rise ? change / limits.acceleration + rise
                                              : 2 * std::sqrt(change / limits.jerk);
}

}  // namespace

double ramp_length(double low, double high, RampLimits limits) {
  return (low + high) / 2 * ramp_time(high - low, limits);
}

double reach_length(double low, double high, RampLimits limits) {
  const double change = high - low;
  if (!(change > 0)) return 0;
  const double rise = rise_time(limits);
  const double gain = limits.acceleration * rise / 2;
  if (change <= gain) return (low + change / 3) * std::sqrt(2 * change / limits.jerk);
  const double middle = low + gain;
  return (low + gain / 3) * rise + (high - middle) * (high + middle) / (2 * limits.acceleration);
}

double ramp_end(double low, double length, RampLimits limits) {
  const double rise = rise_time(limits);
  const double least = limits.acceleration * rise;  // gained by a ramp that just reaches the full acceleration
  if (ramp_length(low, low + least, limits) <= length) {
    const double square = least * least + 4 * (low * low - least * low + 2 * limits.acceleration * length);
    return std::max(low, (std::sqrt(square) - least) / 2);
  }
  // Newton's method from above for half the ramp's time: (2 low + jerk t^2) t = length.
  double time = rise;
  for (int i = 0; i < 100; ++i) {
    const double square = limits.jerk * time * time;
    const double step = ((2 * low + square) * time - length) / (2 * low + 3 * square);
    time -= step;
    if (!(step > 1e-15 * time)) break;
  }
  return low + limits.jerk * time * time;
}

// Newton's method converges from above, because the speed only rises.
double rising_time(double length, double speed, double acceleration, double jerk, double most) {
  double time = length < most * speed ? length / speed : most;
  for (int i = 0; i < 100; ++i) {
    const double more = (speed + (acceleration / 2 + jerk / 6 * time) * time) * time - length;
    const double step = more / (speed + (acceleration + jerk / 2 * time) * time);
    if (!(step > 0x1p-50 * time)) break;
    time -= step;
  }
  return time;
}

}  // namespace trammel::planner
