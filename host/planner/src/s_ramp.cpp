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

double peak_speed(const Hop& hop, double most) {
  const auto excess = [&hop](double speed) {
    return ramp_length(hop.from, speed, hop.up) + ramp_length(hop.to, speed, hop.down) - hop.length;
  };
  // Without a limit of jerk the peak is not lower.
  const double up = hop.up.acceleration;
  const double down = hop.down.acceleration;
  const double squared = (2 * hop.length * up * down + hop.from * hop.from * down + hop.to * hop.to * up) / (up + down);
  double low = std::max(hop.from, hop.to);
  double high = std::min(most, std::sqrt(squared));
  if (high <= low) return low;
  double above = excess(high);
  if (above <= 0) return high;
  double below = excess(low);
  if (below >= 0) return low;
  // Regula falsi; the end that stays counts half (Illinois), every fourth step halves.
  for (int i = 0; i < 200 && high - low > 1e-13 * high; ++i) {
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

unsigned phases_of(const Ramp& ramp, std::array<Phase, 3>& phases) {
  unsigned count = 0;
  const auto add = [&](double length, double duration, double speed, double acceleration, double jerk) {
    if (!(length > 0) || !(duration > 0)) return;
    phases[count++] = {length, duration, speed, acceleration, jerk, false, ramp.short_sight};
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
