// Arcs of ellipses from the driver's mathematics, walked by the golden model. Checks the end point, the number of steps
// and the distance to the curve after every step.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <utility>

#include "arc_walk.hpp"

namespace trammel::driver {
namespace {

// Distance of a point to the ellipse, by bisection for the foot point's parameter in the first quadrant.
double distance_to_ellipse(double a, double b, double x, double y) {
  x = std::abs(x);
  y = std::abs(y);
  double low = 0;
  double high = kPi / 2;
  for (int i = 0; i < 40; ++i) {
    const double t = (low + high) / 2;
    // Half the derivative of the squared distance. Its sign changes once if the point is near the curve and the ellipse
    // is not too flat.
    const double slope = -a * std::sin(t) * (a * std::cos(t) - x) + b * std::cos(t) * (b * std::sin(t) - y);
    (slope < 0 ? low : high) = t;
  }
  return std::hypot(a * std::cos(low) - x, b * std::sin(low) - y);
}

EllipseGeometry random_ellipse_arc(std::mt19937_64& random, std::int64_t a, std::int64_t b) {
  std::uniform_real_distribution<double> uniform(0, 2 * kPi);
  const double from = uniform(random);
  const double to = uniform(random);
  EllipseGeometry g;
  g.semi_x = a;
  g.semi_y = b;
  const auto da = static_cast<double>(a);
  const auto db = static_cast<double>(b);
  g.start_x = std::llround(da * std::cos(from));
  g.start_y = std::llround(db * std::sin(from));
  g.end_x = static_cast<std::int32_t>(std::llround(da * std::cos(to)) - g.start_x);
  g.end_y = static_cast<std::int32_t>(std::llround(db * std::sin(to)) - g.start_y);
  g.clockwise = random() % 2 != 0;
  const double ray_from = std::atan2(db * std::sin(from), da * std::cos(from));
  const double ray_to = std::atan2(db * std::sin(to), da * std::cos(to));
  g.sweep = sweep_between(ray_from, ray_to, g.clockwise);
  return g;
}

TEST(Ellipse, ArcsEndExactlyWithinTheirError) {
  std::mt19937_64 random(11);
  double worst = 0;
  for (int i = 0; i < some_of(4000); ++i) {
    const auto a = static_cast<std::int64_t>(20 + random() % 100);
    const auto b = static_cast<std::int64_t>(20 + random() % 100);
    const EllipseGeometry g = random_ellipse_arc(random, a, b);
    if (g.end_x == 0 && g.end_y == 0) continue;
    const bool ended = walk(prepare(g), [&](std::int64_t x, std::int64_t y) {
      const double distance =
          distance_to_ellipse(static_cast<double>(a), static_cast<double>(b), static_cast<double>(g.start_x + x),
                              static_cast<double>(g.start_y + y));
      worst = std::max(worst, distance);
    });
    ASSERT_TRUE(ended) << "ellipse " << a << ' ' << b << ", arc " << i;
  }
  RecordProperty("worst", fmt::format("{:.4f}", worst));
  EXPECT_LT(worst, 1.1);
}

// Ellipses of any shape, including very flat ones, and semi-axes at the bound: end and number of steps are exact.
TEST(Ellipse, EveryShapeEndsExactly) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < some_of(3000); ++i) {
    const auto a = std::llround(std::pow(2.0, 1 + 11 * uniform(random)));
    const auto b = std::llround(std::pow(2.0, 1 + 11 * uniform(random)));
    EllipseGeometry g = random_ellipse_arc(random, a, b);
    g.turns = static_cast<std::uint32_t>(random() % 2);
    if (g.end_x == 0 && g.end_y == 0) g.turns = 1;
    ASSERT_TRUE(walk(prepare(g), [](std::int64_t, std::int64_t) {})) << "ellipse " << a << ' ' << b << ", arc " << i;
  }
  ASSERT_TRUE(
      walk(prepare(random_ellipse_arc(random, kMaxSemiAxis, kMaxSemiAxis - 3)), [](std::int64_t, std::int64_t) {}));
}

TEST(Ellipse, FullTurnReturns) {
  for (const auto& [a, b] : {std::pair<int, int>{40, 25}, {25, 40}, {1000, 3}, {2, 2}, {7, 7}}) {
    EllipseGeometry g;
    g.semi_x = a;
    g.semi_y = b;
    g.start_x = a;
    g.sweep = 2 * kPi;
    for (const bool clockwise : {false, true}) {
      g.clockwise = clockwise;
      const ArcCommand arc = make_ellipse(g, 1 << 20);
      // The walk cuts off the tip of a flat ellipse where it is narrower than a pulse.
      EXPECT_GE(arc.path_ticks, static_cast<std::uint64_t>(3 * (a + b)));
      EXPECT_LE(arc.path_ticks, static_cast<std::uint64_t>(4 * (a + b) + 4));
      EXPECT_TRUE(walk(arc, [](std::int64_t, std::int64_t) {})) << a << ' ' << b;
    }
  }
}

TEST(ArcInEightDirections, EllipsesOfEveryShapeEndExactly) {
  std::mt19937_64 random(32);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < some_of(3000); ++i) {
    const auto a = std::llround(std::pow(2.0, 12 * uniform(random)));
    const auto b = std::llround(std::pow(2.0, 12 * uniform(random)));
    EllipseGeometry g = random_ellipse_arc(random, a, b);
    g.turns = static_cast<std::uint32_t>(random() % 3);
    if (g.end_x == 0 && g.end_y == 0) g.turns = 1;
    ASSERT_TRUE(walk(prepare(g, StepRule::kEightDirections), [](std::int64_t, std::int64_t) {}))
        << "ellipse " << a << ' ' << b << ", arc " << i;
  }
}

// At the bound, semi-axes of 2^20: the end is exact, and F and the gradients fit in 66 bits.
TEST(ArcBounds, LargestEllipse) {
  for (const StepRule rule : {StepRule::kFourDirections, StepRule::kEightDirections}) {
    EllipseGeometry g;
    g.semi_x = kMaxSemiAxis;
    g.semi_y = kMaxSemiAxis;
    g.start_x = kMaxSemiAxis;
    g.end_x = -kMaxSemiAxis;
    g.end_y = kMaxSemiAxis;
    g.sweep = kPi / 2;
    const ArcCommand arc = prepare(g, rule);
    DeviationPath path = path_of(arc);
    using Word = DeviationPath::Word;
    Word largest{0};
    const auto see = [&](Word word) {
      const bool negative = (word >> 127) != Word{0};
      const Word size = (negative ? Word{0} - word : word) >> DeviationPath::kAlign;
      if (largest < size) largest = size;
    };
    for (std::uint64_t i = 0; i < arc.path_ticks; ++i) {
      path.step();
      see(path.state.deviation);
      see(path.state.gradient_x);
      see(path.state.gradient_y);
    }
    EXPECT_TRUE(path.at_end());
    EXPECT_FALSE(largest < Word{1} << 61);
    EXPECT_TRUE(largest < Word{1} << 65);
  }
}

TEST(Ellipse, RefusesWhatTheCardCannotDo) {
  EllipseGeometry g;
  g.semi_x = 10;
  g.semi_y = 5;
  g.start_x = 10;
  g.sweep = 2 * kPi;
  EXPECT_NO_THROW(prepare(g));
  g.semi_y = 0;
  EXPECT_THROW(prepare(g), std::invalid_argument);
  g.semi_y = kMaxSemiAxis + 1;
  EXPECT_THROW(prepare(g), std::invalid_argument);
  g.semi_y = 5;
  g.start_x = 3;  // far inside the ellipse
  EXPECT_THROW(prepare(g), std::invalid_argument);
  g.start_x = INT64_MAX;
  EXPECT_THROW(prepare(g), std::invalid_argument);
}

// The refusal of an arc on an ellipse with semi-axes 10 and 5 from its right end, after one change.
template <class Change>
std::string ellipse_refusal(Change change) {
  EllipseGeometry g;
  g.semi_x = 10;
  g.semi_y = 5;
  g.start_x = 10;
  g.end_x = -10;
  g.end_y = 5;
  g.sweep = kPi / 2;
  change(g);
  try {
    prepare(g);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(Ellipse, RefusalsNameWhatIsWrong) {
  const auto refusal = [](auto change) { return ellipse_refusal(change); };
  EXPECT_EQ(refusal([](EllipseGeometry&) {}), "");
  EXPECT_EQ(refusal([](EllipseGeometry& g) { g.axis_x = 8; }), "arc: axes 8 and 1 span no plane");
  EXPECT_EQ(refusal([](EllipseGeometry& g) { g.axis_y = 8; }), "arc: axes 0 and 8 span no plane");
  EXPECT_EQ(refusal([](EllipseGeometry& g) { g.axis_y = 0; }), "arc: axes 0 and 0 span no plane");
  EXPECT_EQ(refusal([](EllipseGeometry& g) { g.sweep = -0.5; }), "arc: sweep of -0.5 radians");
  EXPECT_EQ(refusal([](EllipseGeometry& g) { g.sweep = 1e6; }), "arc: sweep of 1000000 radians");
  EXPECT_EQ(refusal([](EllipseGeometry& g) { g.semi_x = 1; }),
            "arc: semi-axes 1 and 5 are not within 2 .. 2^20 pulses, in 4 directions");
  EXPECT_EQ(refusal([](EllipseGeometry& g) { g.semi_x = kMaxSemiAxis + 1; }),
            "arc: semi-axes 1048577 and 5 are not within 2 .. 2^20 pulses, in 4 directions");
  // Rounding may put the start 1 pulse outside the box, but not 2 pulses.
  for (const std::int64_t x : {-12, 12})
    EXPECT_EQ(refusal([x](EllipseGeometry& g) { g.start_x = x; }),
              "arc: the start is outside the ellipse's bounding box");
  for (const std::int64_t y : {-7, 7})
    EXPECT_EQ(refusal([y](EllipseGeometry& g) { g.start_y = y; }),
              "arc: the start is outside the ellipse's bounding box");
  EXPECT_EQ(refusal([](EllipseGeometry& g) {
              g.start_y = 5;
              g.end_y = 0;
            }),
            "arc: the start is not on the ellipse");
  EXPECT_EQ(refusal([](EllipseGeometry& g) { g.end_y = 7; }), "arc: the end is outside the ellipse's bounding box");
  EXPECT_EQ(refusal([](EllipseGeometry& g) { g.end_y = 2; }), "arc: the end is not on the ellipse");
}

}  // namespace
}  // namespace trammel::driver
