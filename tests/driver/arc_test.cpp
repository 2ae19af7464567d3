// Circular arcs from the driver's mathematics, walked by the golden model. Checks the end point, the number of steps
// and the distance to the curve. Distances are measured after every step, at the lattice point reached.
#include "trammel/driver/arc.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "arc_walk.hpp"

namespace trammel::driver {
namespace {

// An arc before and after rounding: start and end to whole pulses, the centre to 1/256 pulse.
struct RandomArc {
  ArcGeometry geometry;
  double radius;              // radius before rounding
  double real_x, real_y;      // centre before rounding, from the rounded start
  double centre_x, centre_y;  // the rounded centre, from the rounded start
};

RandomArc random_arc(std::mt19937_64& random, double smallest, double largest) {
  std::uniform_real_distribution<double> uniform(0, 1);
  RandomArc made{};
  made.radius = smallest * std::exp(std::log(largest / smallest) * uniform(random));
  const double from = 2 * kPi * uniform(random);
  const bool clockwise = uniform(random) < 0.5;
  const double sweep = 2 * kPi * uniform(random);
  const double x = uniform(random);  // position of the centre between lattice points
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

// The driver finds whole turns by divisions. This test finds them by angles, for radii down to the smallest.
TEST(ArcTurns, AreTheNearestByAngles) {
  std::mt19937_64 random(7);
  int compared = 0;
  for (int i = 0; i < 50'000; ++i) {
    RandomArc made = random_arc(random, 1, 300);
    ArcGeometry& g = made.geometry;
    g.turns = static_cast<std::uint32_t>(i % 3);
    ArcCommand arc;
    try {
      arc = prepare(g);
    } catch (const std::invalid_argument&) {
      continue;
    }
    const auto cx = static_cast<double>(g.centre_x) / 256;
    const auto cy = static_cast<double>(g.centre_y) / 256;
    const double x = g.end_x - cx;
    const double y = g.end_y - cy;
    double ahead = (g.clockwise ? -1 : 1) * (std::atan2(y, x) - std::atan2(-cy, -cx));
    if (ahead < 0) ahead += 2 * kPi;
    const auto quadrant = [](double px, double py) { return py >= 0 ? (px >= 0 ? 0 : 1) : (px >= 0 ? 3 : 2); };
    int changes = ((g.clockwise ? -1 : 1) * (quadrant(x, y) - quadrant(-cx, -cy)) + 4) % 4;
    if (changes == 0 && ahead > kPi) changes = 4;
    changes += 4 * static_cast<int>(std::llround((g.sweep - ahead) / (2 * kPi)) + g.turns);
    ASSERT_EQ(arc.quadrants, std::max(changes, 0))
        << "arc " << i << ", radius " << made.radius << ", sweep " << g.sweep;
    ++compared;
  }
  EXPECT_GT(compared, 46'000);
}

// Largest radial distances found, pulses.
struct Extremes {
  double ring = 0;  // outside the ring between the rounded start's and end's distances from the rounded centre
  double mean = 0;  // from the circle about the rounded centre with the mean of the two as its radius
  double real = 0;  // from the circle before any rounding
};

constexpr double kMaxInEight = 0.66;

void expect_random_arcs(std::uint64_t seed, int count, double smallest, double largest, Extremes& worst,
                        StepRule rule = StepRule::kFourDirections) {
  std::mt19937_64 random(seed);
  for (int i = 0; i < some_of(count); ++i) {
    const RandomArc made = random_arc(random, smallest, largest);
    const ArcGeometry& g = made.geometry;
    ArcCommand arc;
    try {
      arc = prepare(g, rule);
    } catch (const std::invalid_argument&) {
      // Rounding left an empty arc or a circle that is too small.
      ASSERT_TRUE((g.end_x == 0 && g.end_y == 0) || made.radius < 2.5) << "arc " << i;
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
    // Bound: one pulse, plus the addition by a sideways step on a small circle. In 8 directions: half a pulse, or the
    // difference between the mean radius and the radii of the ends.
    const bool eight = rule == StepRule::kEightDirections;
    ASSERT_LT(std::max(most - mean, mean - least), eight ? kMaxInEight : 1 + 0.3 / mean)
        << "arc " << i << " of seed " << seed;
    worst.ring = std::max({worst.ring, most - std::max(first, last), std::min(first, last) - least});
    worst.mean = std::max({worst.mean, most - mean, mean - least});
    worst.real = std::max({worst.real, real_most - made.radius, made.radius - real_least});
  }
}

TEST(ArcCommand, RandomArcsEndExactlyWithinTheirError) {
  Extremes small;
  expect_random_arcs(1, 30000, 2, 4, small);
  Extremes large;
  expect_random_arcs(2, 60000, 4, 500, large);
  expect_random_arcs(3, 10000, 500, 10000, large);
  expect_random_arcs(4, 4, 100000, 1000000, large);
  RecordProperty("small", fmt::format("ring {:.4f} mean {:.4f} real {:.4f}", small.ring, small.mean, small.real));
  RecordProperty("large", fmt::format("ring {:.4f} mean {:.4f} real {:.4f}", large.ring, large.mean, large.real));
  EXPECT_LT(small.ring, 1.13);
  EXPECT_LT(large.ring, 1.1);
  EXPECT_LT(large.mean, 1.1);
  // Rounding moves start and end by up to 0.71 pulse, and with them the circle.
  EXPECT_LT(large.real, 1.1 + 0.71);
}

TEST(ArcInEightDirections, RandomArcsEndExactlyWithinTheirError) {
  Extremes small;
  expect_random_arcs(21, 30000, 2, 4, small, StepRule::kEightDirections);
  Extremes large;
  expect_random_arcs(22, 60000, 4, 500, large, StepRule::kEightDirections);
  expect_random_arcs(23, 10000, 500, 10000, large, StepRule::kEightDirections);
  expect_random_arcs(24, 4, 100000, 1000000, large, StepRule::kEightDirections);
  RecordProperty("small", fmt::format("ring {:.4f} mean {:.4f} real {:.4f}", small.ring, small.mean, small.real));
  RecordProperty("large", fmt::format("ring {:.4f} mean {:.4f} real {:.4f}", large.ring, large.mean, large.real));
  EXPECT_LT(small.ring, 0.61);
  EXPECT_LT(large.ring, 0.56);
}

// Lattice points to which points of a circle of `r` pulses about a whole-pulse centre may be rounded.
std::vector<std::pair<int, int>> rounded_circle(int r) {
  std::vector<std::pair<int, int>> points;
  for (int x = -r - 1; x <= r + 1; ++x) {
    for (int y = -r - 1; y <= r + 1; ++y) {
      if (std::abs(std::hypot(x, y) - r) < 0.7072) points.emplace_back(x, y);
    }
  }
  return points;
}

// Largest distance that is allowed between a walk and the circle with the mean of start's and end's radius.
double most_off(StepRule rule, double mean) {
  if (rule == StepRule::kFourDirections) return 1 + 1 / (4 * mean) + 1e-9;
  return mean < 2 ? 0.83 : kMaxInEight;
}

// Checks arcs about a whole-pulse centre, with 0 and 1 further turn, and returns their number. Arcs below the least
// radius are refused. The others end exactly at the end point, stay near the circle and never come near the centre.
std::uint64_t expect_small_arcs(StepRule rule, int r, std::pair<int, int> start, std::pair<int, int> end,
                                bool clockwise) {
  const auto [sx, sy] = start;
  const auto [ex, ey] = end;
  ArcGeometry g;
  g.centre_x = -256 * sx;
  g.centre_y = -256 * sy;
  g.end_x = ex - sx;
  g.end_y = ey - sy;
  g.clockwise = clockwise;
  g.sweep = sweep_between(std::atan2(sy, sx), std::atan2(ey, ex), clockwise);
  g.turns = start == end ? 1 : 0;
  const double mean = (std::hypot(sx, sy) + std::hypot(ex, ey)) / 2;
  if (mean < (rule == StepRule::kFourDirections ? 1.5 : 1.0)) {
    EXPECT_THROW(prepare(g, rule), std::invalid_argument);
    return 0;
  }
  std::int64_t nearest = INT64_MAX;  // squared distance to the centre, pulses^2
  std::int64_t farthest = 0;
  for (int more = 0; more < 2; ++more, ++g.turns) {
    EXPECT_TRUE(walk(prepare(g, rule),
                     [&, x0 = sx, y0 = sy](std::int64_t x, std::int64_t y) {
                       const std::int64_t square = (x0 + x) * (x0 + x) + (y0 + y) * (y0 + y);
                       nearest = std::min(nearest, square);
                       farthest = std::max(farthest, square);
                     }))
        << "r " << r << " from " << sx << ',' << sy << " to " << ex << ',' << ey << " clockwise " << clockwise;
  }
  // Start and end are points of the path: with radii far apart they themselves are farther off the mean.
  const double off = std::max(most_off(rule, mean), std::abs(std::hypot(sx, sy) - mean) + 1e-9);
  EXPECT_GE(std::sqrt(nearest), std::max(mean - off, 1.0 / 3)) << "r " << r;
  EXPECT_LE(std::sqrt(farthest), mean + off) << "r " << r;
  return 2;
}

// Every start and end on the rounded circles of 1 to 20 pulses, including starts on an axis, in both directions, with
// and without a further turn. In 8 directions up to 8 pulses (20 under TRAMMEL_LONG); on an emulated host up to 6.
TEST(ArcCommand, EverySmallArcEndsExactlyAndNearItsCircle) {
  const bool all = std::getenv("TRAMMEL_LONG") != nullptr;
  for (const StepRule rule : {StepRule::kFourDirections, StepRule::kEightDirections}) {
    const bool eight = rule == StepRule::kEightDirections;
    std::uint64_t arcs = 0;
    for (int r = 1; r <= (kFewCases ? 6 : eight && !all ? 8 : 20); ++r) {
      const auto points = rounded_circle(r);
      for (const auto& start : points) {
        for (const auto& end : points) {
          for (const bool clockwise : {false, true}) arcs += expect_small_arcs(rule, r, start, end, clockwise);
        }
      }
      ASSERT_FALSE(::testing::Test::HasFailure());
    }
    EXPECT_GT(arcs, kFewCases ? 5000U : eight ? 30'000U : 500'000U);
  }
}

// In 4 directions a semi-axis of 1 pulse is refused, like a circle below the least radius.
TEST(ArcCommand, NarrowEllipsesInFourDirections) {
  EllipseGeometry g;
  g.semi_x = 1;
  g.semi_y = 10;
  g.start_x = 1;
  g.sweep = 2 * kPi;
  EXPECT_THROW(prepare(g), std::invalid_argument);
  EXPECT_NO_THROW(prepare(g, StepRule::kEightDirections));
  g.semi_x = g.start_x = 2;
  std::int64_t nearest = INT64_MAX;
  EXPECT_TRUE(walk(prepare(g),
                   [&](std::int64_t x, std::int64_t y) { nearest = std::min(nearest, (x + 2) * (x + 2) + y * y); }));
  EXPECT_GE(nearest, 1);
}

ArcGeometry full_circle(std::int64_t r, bool clockwise) {
  ArcGeometry g;
  g.centre_x = -256 * r;
  g.clockwise = clockwise;
  g.sweep = 2 * kPi;
  return g;
}

TEST(ArcCommand, FullCirclesHaveEightRadiiSteps) {
  for (std::int64_t r = 2; r <= 2000; ++r) {
    EXPECT_EQ(prepare(full_circle(r, false)).path_ticks, static_cast<std::uint64_t>(8 * r));
    EXPECT_EQ(prepare(full_circle(r, true)).path_ticks, static_cast<std::uint64_t>(8 * r));
  }
  const ArcCommand largest = prepare(full_circle(std::int64_t{1} << 24, true));
  EXPECT_EQ(largest.path_ticks, std::uint64_t{1} << 27);
}

TEST(ArcCommand, FieldsOfGoldbergsCircle) {
  const ArcCommand arc = make_arc(full_circle(25, false), 1000);
  EXPECT_EQ(arc.ticks, 1000u);
  EXPECT_EQ(arc.path_ticks, 200u);
  EXPECT_EQ(arc.prescale, (std::uint64_t{200} << 40) / 1000);
  EXPECT_EQ(arc.quadrants, 4);
  EXPECT_FALSE(arc.clockwise);
  EXPECT_TRUE(arc.deviation == 65536 / 2);    // Table 3's 0, plus one half, which does not change its signs
  EXPECT_TRUE(arc.gradient_x == 50 * 65536);  // Table 3's 50, in squares of 1/256 pulse
  EXPECT_TRUE(arc.gradient_y == 0);
  EXPECT_EQ(arc.half_x, 65536u);
  EXPECT_EQ(arc.half_y, 65536u);
}

// A nearly full and a nearly empty arc between the same rounded points differ only in their sweep.
TEST(ArcCommand, SweepTellsShortFromFull) {
  ArcGeometry g = full_circle(100, false);
  g.end_y = 1;
  g.sweep = 0.01;
  EXPECT_EQ(prepare(g).path_ticks, 1u);
  g.sweep = 2 * kPi - 0.01;  // rounding puts the end past the start: one turn and a step
  EXPECT_EQ(prepare(g).quadrants, 4);
  g.end_y = -1;  // behind the start
  // The mean radius is a little over 100, so the walk may turn at 101 on each axis crossing.
  EXPECT_NEAR(static_cast<double>(prepare(g).path_ticks), 800, 4);
  EXPECT_TRUE(walk(prepare(g), [](std::int64_t, std::int64_t) {}));
  g.sweep = 0.01;
  const ArcCommand back = prepare(g);
  EXPECT_EQ(back.path_ticks, 1u);
  EXPECT_EQ(back.quadrants, 0);
  EXPECT_TRUE(walk(back, [](std::int64_t, std::int64_t) {}));
}

TEST(ArcCommand, TurnsAdd) {
  ArcGeometry g = full_circle(30, true);
  for (g.turns = 0; g.turns < 20; ++g.turns) {
    const ArcCommand arc = prepare(g);
    EXPECT_EQ(arc.quadrants, 4 * (g.turns + 1));
    EXPECT_EQ(arc.path_ticks, 240u * (g.turns + 1));
    EXPECT_TRUE(walk(arc, [](std::int64_t, std::int64_t) {}));
  }
  g.turns = 16382;
  EXPECT_EQ(prepare(g).quadrants, 65532);
  g.turns = 16383;
  EXPECT_THROW(prepare(g), std::invalid_argument);
}

// In 8 directions the driver counts the steps by its own walk. The model must reach the end with exactly this number.
TEST(ArcInEightDirections, SmallArcsAndTurnsEndExactly) {
  std::mt19937_64 random(31);
  for (int i = 0; i < some_of(20000); ++i) {
    RandomArc made = random_arc(random, 1, 60);
    made.geometry.turns = static_cast<std::uint32_t>(random() % 12);
    ArcCommand arc;
    try {
      arc = prepare(made.geometry, StepRule::kEightDirections);
    } catch (const std::invalid_argument&) {
      continue;
    }
    ASSERT_TRUE(arc.eight_directions);
    ASSERT_TRUE(walk(arc, [](std::int64_t, std::int64_t) {})) << "arc " << i << ", radius " << made.radius;
  }
}

TEST(ArcInEightDirections, FullCirclesHaveTheirSteps) {
  for (std::int64_t r = 2; r <= 2000; ++r) {
    const auto steps = 4 * static_cast<std::uint64_t>(std::lround(std::sqrt(2.0) * static_cast<double>(r)));
    EXPECT_EQ(prepare(full_circle(r, false), StepRule::kEightDirections).path_ticks, steps) << r;
    EXPECT_EQ(prepare(full_circle(r, true), StepRule::kEightDirections).path_ticks, steps) << r;
  }
  // The driver does not walk repeated turns: this many would take hours.
  ArcGeometry g = full_circle(1'000'000, false);
  g.turns = 16382;
  const ArcCommand arc = prepare(g, StepRule::kEightDirections);
  EXPECT_EQ(arc.quadrants, 65532);
  EXPECT_EQ(arc.path_ticks, std::uint64_t{4} * 1'414'214 * 16383);
}

// At the bounds: a quarter of a circle whose centre is 2^24 pulses away and not on a whole pulse. The end is exact, and
// the walk stays within its error of the circle.
TEST(ArcBounds, LargestCircle) {
  if (kFewCases) GTEST_SKIP() << "too long for an emulated host";
  constexpr double kRadius = 0x1p24;
  for (const StepRule rule : {StepRule::kFourDirections, StepRule::kEightDirections}) {
    ArcGeometry g;
    g.centre_x = -kMaxCentreDistance + 77;  // 77/256 pulses right of the bound
    g.centre_y = 129;
    g.end_x = static_cast<std::int32_t>(std::lround(-kRadius + 77.0 / 256));
    g.end_y = static_cast<std::int32_t>(std::lround(kRadius + 129.0 / 256)) - 1;
    g.sweep = kPi / 2;
    const double cx = static_cast<double>(g.centre_x) / 256;
    const double cy = static_cast<double>(g.centre_y) / 256;
    const double first = std::hypot(cx, cy);
    const double last = std::hypot(g.end_x - cx, g.end_y - cy);
    double worst = 0;
    std::uint64_t steps = 0;
    EXPECT_TRUE(walk(prepare(g, rule), [&](std::int64_t x, std::int64_t y) {
      // One step in 1009; doubles resolve these distances to about 2^-29.
      if (++steps % 1009 != 0) return;
      const double r = std::hypot(static_cast<double>(x) - cx, static_cast<double>(y) - cy);
      worst = std::max({worst, r - std::max(first, last), std::min(first, last) - r});
    }));
    EXPECT_GT(steps, std::uint64_t{23'000'000});
    EXPECT_LT(worst, rule == StepRule::kEightDirections ? 0.51 : 1.01);
  }
}

std::string refusal(const ArcGeometry& geometry) {
  try {
    prepare(geometry);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(ArcCommand, RefusesWhatTheCardCannotDo) {
  using ::testing::HasSubstr;
  ArcGeometry g = full_circle(0, false);
  EXPECT_THAT(refusal(g), HasSubstr("radius of 0 pulses, at least 1.5 in 4 directions"));
  g = full_circle(1, false);
  EXPECT_THAT(refusal(g), HasSubstr("radius of 1 pulses"));
  g = full_circle((std::int64_t{1} << 24) + 1, false);
  EXPECT_THAT(refusal(g), HasSubstr("from the start"));
  g.centre_x = INT64_MIN;
  EXPECT_THAT(refusal(g), HasSubstr("from the start"));
  g = full_circle(10, false);
  g.end_x = INT32_MAX;
  EXPECT_THAT(refusal(g), HasSubstr("from the end"));
  g.end_x = 0;
  g.end_y = INT32_MIN;
  EXPECT_THAT(refusal(g), HasSubstr("from the end"));
  for (const std::int64_t far : {-kMaxCentreDistance - 1, kMaxCentreDistance + 1}) {
    g = full_circle(10, false);
    g.centre_y = far;
    EXPECT_THAT(refusal(g), HasSubstr("from the start"));
  }
  g = full_circle(10, false);
  g.sweep = 0;
  EXPECT_THAT(refusal(g), HasSubstr("no step"));
  g.sweep = 1e6;
  EXPECT_THAT(refusal(g), HasSubstr("sweep of 1000000 radians"));
  g.sweep = -1;
  EXPECT_THAT(refusal(g), HasSubstr("sweep"));
  g.sweep = std::nan("");
  EXPECT_THAT(refusal(g), HasSubstr("sweep"));
  g = full_circle(10, false);
  g.axis_y = 0;
  EXPECT_THAT(refusal(g), HasSubstr("plane"));
  g.axis_y = 8;
  EXPECT_THAT(refusal(g), HasSubstr("plane"));
  g = full_circle(10, false);
  g.turns = UINT32_MAX;
  EXPECT_THAT(refusal(g), HasSubstr("quadrants"));
  g = full_circle(std::int64_t{1} << 24, false);
  g.turns = 8192;
  EXPECT_THAT(refusal(g), HasSubstr("2^40"));
}

// The centre is far from the circle and has no direction, but an arc can end there.
TEST(ArcCommand, AnEndAtTheCentreIsReached) {
  ArcGeometry g = full_circle(10, false);
  g.end_x = static_cast<std::int32_t>(g.centre_x / kCentreUnitsPerPulse);
  g.end_y = static_cast<std::int32_t>(g.centre_y / kCentreUnitsPerPulse);
  ASSERT_EQ(std::abs(g.end_x) + std::abs(g.end_y), 10);
  for (const StepRule rule : {StepRule::kFourDirections, StepRule::kEightDirections}) {
    std::int64_t x = 0;
    std::int64_t y = 0;
    EXPECT_EQ(prepare(g, rule).quadrants, 4) << "the whole turn first";
    EXPECT_TRUE(walk(prepare(g, rule), [&](std::int64_t at_x, std::int64_t at_y) {
      x = at_x;
      y = at_y;
    }));
    EXPECT_EQ(x, g.end_x);
    EXPECT_EQ(y, g.end_y);
  }
}

TEST(ArcCommand, TicksBoundThePath) {
  const ArcCommand arc = prepare(full_circle(25, false));
  EXPECT_THROW(with_ticks(arc, 199), std::invalid_argument);
  EXPECT_THROW(with_ticks(arc, std::uint64_t{1} << 40), std::invalid_argument);
  EXPECT_EQ(with_ticks(arc, 200).prescale, std::uint64_t{1} << 40);
  EXPECT_EQ(with_ticks(arc, 300).prescale, 733007751851u);  // 2/3 * 2^40 = ...850.67
}

}  // namespace
}  // namespace trammel::driver
