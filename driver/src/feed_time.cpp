#include "trammel/driver/feed_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "trammel/card_map.hpp"

namespace trammel::driver {
namespace {

constexpr double kRateUnit = 1.0 / 18446744073709551616.0;  // 2^-64 ticks per clock
constexpr double kFloorUnit = 1.0 / 4294967296.0;           // 2^-32 ticks per clock
constexpr double kUpdate = card_map::constant::kUpdateClocks;

// Rate over time without the floor: start + slope t + bend t^2 / 2, ticks per clock.
struct Course {
  double start;
  double slope;
  double bend;
  double floor;

  // Number of ticks after t clocks.
  double ticks(double t) const {
    // Times at which the rate crosses the floor.
    std::array<double, 4> cuts{0, t, t, t};
    const double above = start - floor;
    const double discriminant = slope * slope - 2 * bend * above;
    if (discriminant > 0 && bend != 0) {
      cuts[1] = std::clamp((-slope - std::sqrt(discriminant)) / bend, 0.0, t);
      cuts[2] = std::clamp((-slope + std::sqrt(discriminant)) / bend, 0.0, t);
      if (cuts[1] > cuts[2]) std::swap(cuts[1], cuts[2]);
    }
    double sum = floor * t;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const double middle = (cuts[i] + cuts[i + 1]) / 2;
      if (above + slope * middle + bend * middle * middle / 2 > 0) sum += gain(cuts[i + 1]) - gain(cuts[i]);
    }
    return sum;
  }
  // Integral of the rate above the floor.
  double gain(double t) const { return (start - floor) * t + slope * t * t / 2 + bend * t * t * t / 6; }
};

double by_bisection(const Course& course, double ticks) {
  double least = 0;
  double most = ticks / course.floor;
  for (int i = 0; i < 60; ++i) {
    const double middle = (least + most) / 2;
    (course.ticks(middle) < ticks ? least : most) = middle;
  }
  return most;
}

// The duration for a constant slope.
double by_root(const Course& course, double ticks) {
  const double start = std::max(course.start, course.floor);
  const double square = start * start + 2 * course.slope * ticks;
  if (square >= course.floor * course.floor) return 2 * ticks / (start + std::sqrt(square));
  // Falls to the floor, and continues at the floor.
  const double falling = (start * start - course.floor * course.floor) / (-2 * course.slope);
  return 2 * falling / (start + course.floor) + (ticks - falling) / course.floor;
}

}  // namespace

double feed_clocks(const FeedCommand& piece) {
  const auto ticks = static_cast<double>(piece.ticks);
  const Course course{
      static_cast<double>(piece.rate) * kRateUnit, static_cast<double>(piece.acceleration) * kRateUnit / kUpdate,
      static_cast<double>(piece.jerk) * kRateUnit / (kUpdate * kUpdate), std::max<double>(piece.floor, 1) * kFloorUnit};
  return course.bend != 0 ? by_bisection(course, ticks) : by_root(course, ticks);
}

std::optional<double> ticks_to_reversal(const FeedCommand& piece) {
  constexpr double kSlack = 2;  // ticks
  constexpr double kFits = 0.999;
  constexpr double kFloorUpdates = 4;  // plus the ticks that the floor gives in that time
  const double rate = static_cast<double>(piece.rate) * kRateUnit;
  const double gain = static_cast<double>(piece.acceleration) * kRateUnit;
  const double jerk = static_cast<double>(piece.jerk) * kRateUnit;
  // In update k the rate is rate + k gain + k (k - 1) / 2 jerk. Finds the first k > 0 at which it is 0.
  const double linear = gain - jerk / 2;
  const double discriminant = linear * linear - 2 * jerk * rate;
  if (discriminant < 0) return std::nullopt;
  const double divisor = -linear + std::sqrt(discriminant);
  // The smaller positive root of rate + linear k + jerk k^2 / 2, in a form without cancellation.
  if (!(divisor > 0)) return std::nullopt;
  const double updates = 2 * rate / divisor;
  const double ticks = kUpdate * updates * (rate + (updates - 1) / 2 * gain + (updates - 1) * (updates - 2) / 6 * jerk);
  const double last = kUpdate * std::abs(gain + updates * jerk);  // ticks by one update's change of the rate
  const double short_by = static_cast<double>(piece.ticks) * kFits - ticks;
  const double at_floor = kFloorUpdates * kUpdate * piece.floor * kFloorUnit;
  if (short_by <= kSlack + last + at_floor) return std::nullopt;
  return ticks;
}

}  // namespace trammel::driver
