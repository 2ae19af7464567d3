#include "trammel/driver/feed_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "trammel/card_map.hpp"

namespace trammel::driver {
namespace {

constexpr double kRateUnit = 1.0 / 18446744073709551616.0;  // 2^-64 ticks a clock
constexpr double kFloorUnit = 1.0 / 4294967296.0;           // 2^-32
constexpr double kUpdate = card_map::constant::kUpdateClocks;

// Rate over time without the floor: start + slope t + bend t^2 / 2, ticks a clock.
struct Course {
  double start;
  double slope;
  double bend;
  double floor;

  // Ticks after t clocks.
  double ticks(double t) const {
    // Where the rate crosses the floor.
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

// With a constant slope.
double by_root(const Course& course, double ticks) {
  const double start = std::max(course.start, course.floor);
  const double square = start * start + 2 * course.slope * ticks;
  if (square >= course.floor * course.floor) return 2 * ticks / (start + std::sqrt(square));
  // Down to the floor, and on at it.
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

}  // namespace trammel::driver
