// Arcs from the driver's mathematics, walked by the golden model: the end point, the number of steps, the distance to
// the curve. Distances are measured after every step, at the lattice point reached.
#include "trammel/driver/arc.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>

#include "trammel/model/deviation_accumulator.hpp"

namespace trammel::driver {
namespace {

using model::DeviationPath;

constexpr double kPi = 3.14159265358979323846;

DeviationPath path_of(const Arc& arc) {
  const auto aligned = [](int128 value) { return static_cast<DeviationPath::Word>(value) << DeviationPath::kAlign; };
  DeviationPath path;
  path.state.deviation = aligned(arc.deviation);
  path.state.gradient_x = aligned(arc.gradient_x);
  path.state.gradient_y = aligned(arc.gradient_y);
  path.state.half_x = arc.half_x;
  path.state.half_y = arc.half_y;
  path.state.left_x = static_cast<std::uint32_t>(arc.end_x);
  path.state.left_y = static_cast<std::uint32_t>(arc.end_y);
  path.state.quadrants = arc.quadrants;
  path.state.clockwise = arc.clockwise;
  path.begin();
  return path;
}

// Walks the arc and shows `visit(x, y)` every point after a step, relative to the start. Expects the end point after
// exactly L steps, and not before.
template <class Visit>
bool walk(const Arc& arc, Visit&& visit) {
  DeviationPath path = path_of(arc);
  std::int64_t x = 0;
  std::int64_t y = 0;
  for (std::uint64_t i = 0; i < arc.path_ticks; ++i) {
    if (path.at_end()) return false;
    const auto step = path.step();
    (step.in_x ? x : y) += step.negative ? -1 : 1;
    visit(x, y);
  }
  return path.at_end() && x == arc.end_x && y == arc.end_y;
}

// A real arc, and what rounding makes of it: start and end to whole pulses, the centre to 1/256.
struct RandomArc {
  ArcGeometry geometry;
  double radius;             // of the real arc
  double real_x, real_y;     // its centre, from the rounded start
  double centre_x, centre_y;  // the rounded centre, from the rounded start
};

RandomArc random_arc(std::mt19937_64& random, double smallest, double largest) {
  std::uniform_real_distribution<double> uniform(0, 1);
  RandomArc made{};
  made.radius = smallest * std::exp(std::log(largest / smallest) * uniform(random));
  const double from = 2 * kPi * uniform(random);
  const bool clockwise = uniform(random) < 0.5;
  const double sweep = 2 * kPi * uniform(random);
  const double x = uniform(random);  // the centre's place between lattice points
  const double y = uniform(random);
  const double to = from + (clockwise ? -sweep : sweep);
  const double start_x = std::round(x + made.radius * std::cos(from));
  const double start_y = std::round(y + made.radius * std::sin(from));
  made.real_x = x - start_x;
  made.real_y = y - start_y;
  ArcGeometry& g = made.geometry;
  g.centre_x = std::llround(256 * made.real_x);
  g.centre_y = std::llround(256 * made.real_y);
  made.centre_x = static_cast<double>(g.centre_x) / 256;
  made.centre_y = static_cast<double>(g.centre_y) / 256;
  g.end_x = static_cast<std::int32_t>(std::lround(x + made.radius * std::cos(to)) - std::lround(start_x));
  g.end_y = static_cast<std::int32_t>(std::lround(y + made.radius * std::sin(to)) - std::lround(start_y));
  g.clockwise = clockwise;
  g.sweep = sweep;
  return made;
}

struct Extremes {
  double ring = 0;  // outside the ring between the rounded start's and end's distance from the rounded centre
  double mean = 0;  // from the circle of their mean radius
  double real = 0;  // from the circle before any rounding
};

void expect_random_arcs(std::uint64_t seed, int count, double smallest, double largest, Extremes& worst) {
  std::mt19937_64 random(seed);
  for (int i = 0; i < count; ++i) {
    const RandomArc made = random_arc(random, smallest, largest);
    const ArcGeometry& g = made.geometry;
    Arc arc;
    try {
      arc = prepare(g);
    } catch (const std::invalid_argument&) {
      // Rounding left nothing to walk, or a circle smaller than a pulse.
      ASSERT_TRUE((g.end_x == 0 && g.end_y == 0) || made.radius < 2) << "arc " << i;
      continue;
    }
    const double first = std::hypot(made.centre_x, made.centre_y);
    const double last = std::hypot(g.end_x - made.centre_x, g.end_y - made.centre_y);
    double least = first;
    double most = first;
    double real_least = made.radius;
    double real_most = made.radius;
    const bool ended = walk(arc, [&](std::int64_t x, std::int64_t y) {
      const double px = static_cast<double>(x);
      const double py = static_cast<double>(y);
      const double r2 = (px - made.centre_x) * (px - made.centre_x) + (py - made.centre_y) * (py - made.centre_y);
      const double d = std::sqrt(r2);
      least = std::min(least, d);
      most = std::max(most, d);
      const double q2 = (px - made.real_x) * (px - made.real_x) + (py - made.real_y) * (py - made.real_y);
      const double q = std::sqrt(q2);
      real_least = std::min(real_least, q);
      real_most = std::max(real_most, q);
    });
    ASSERT_TRUE(ended) << "arc " << i << " of seed " << seed << ": radius " << made.radius << " sweep " << g.sweep;
    const double mean = (first + last) / 2;
    worst.ring = std::max({worst.ring, most - std::max(first, last), std::min(first, last) - least});
    worst.mean = std::max({worst.mean, most - mean, mean - least});
    worst.real = std::max({worst.real, real_most - made.radius, made.radius - real_least});
  }
}

TEST(Arc, RandomArcsEndExactlyWithinTheirError) {
  Extremes worst;
  expect_random_arcs(1, 90000, 2, 500, worst);
  expect_random_arcs(2, 10000, 500, 10000, worst);
  RecordProperty("ring", std::to_string(worst.ring));
  RecordProperty("mean", std::to_string(worst.mean));
  RecordProperty("real", std::to_string(worst.real));
  std::printf("ring %.4f mean %.4f real %.4f\n", worst.ring, worst.mean, worst.real);
  EXPECT_LT(worst.ring, 1.1);
}

}  // namespace
}  // namespace trammel::driver
