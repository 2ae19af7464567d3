#include "s_ramp.hpp"

#include <algorithm>
#include <cmath>

namespace trammel::planner {
namespace {

// Nothing is multiplied by the jerk, so that an infinite one gives what has no limit.
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
  const double least = limits.acceleration * rise;  // gained where the whole acceleration is reached
  if (ramp_length(low, low + least, limits) <= length) {
    const double square = least * least + 4 * (low * low - least * low + 2 * limits.acceleration * length);
    return std::max(low, (std::sqrt(square) - least) / 2);
  }
  // Half the ramp's time: (2 low + jerk t^2) t = length, from above.
  double time = rise;
  for (int i = 0; i < 100; ++i) {
    const double square = limits.jerk * time * time;
    const double step = ((2 * low + square) * time - length) / (2 * low + 3 * square);
    time -= step;
    if (!(step > 1e-15 * time)) break;
  }
  return low + limits.jerk * time * time;
}

unsigned phases_of(const Ramp& ramp, std::array<Phase, 3>& phases) {
  unsigned count = 0;
  const auto add = [&](double length, double duration, double speed, double acceleration, double jerk) {
    if (!(length > 0) || !(duration > 0)) return;
    phases[count++] = {length, duration, speed, acceleration, jerk, 0, false, ramp.short_sight};
  };
  const double sign = ramp.to < ramp.from ? -1 : 1;
  const double change = sign * (ramp.to - ramp.from);
  if (!(change > 0)) {
    add(ramp.length, ramp.length / ramp.from, ramp.from, 0, 0);
    return count;
  }
  const double rise = rise_time(ramp.limits);
  const bool full = change >= ramp.limits.acceleration * rise;
  const double bend = full ? rise : std::sqrt(change / ramp.limits.jerk);
  const double steady = full ? change / ramp.limits.acceleration - rise : 0;
  const double acceleration = sign * (full ? ramp.limits.acceleration : change / bend);
  const double jerk = bend > 0 ? acceleration / bend : 0;
  const double gain = acceleration * bend / 2;
  const double first = (ramp.from + gain / 3) * bend;
  const double last = (ramp.to - gain / 3) * bend;
  add(first, bend, ramp.from, 0, jerk);
  add(ramp.length - first - last, steady, ramp.from + gain, acceleration, 0);
  add(steady > 0 ? last : ramp.length - first, bend, ramp.to - gain, acceleration, -jerk);
  return count;
}

}  // namespace trammel::planner
