// The 8-direction rule of the accumulator against closed forms: distances to the true curve, the least deviation among
// the candidates, numbers of steps, exact ends. Short full turns also run through the block, clock by clock.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include "trammel/model/deviation_accumulator.hpp"

namespace trammel::model {
namespace {

__extension__ typedef __int128 int128;
using Step = DeviationPath::Step;

DeviationPath::Word aligned_8(int128 value) { return static_cast<DeviationPath::Word>(value) << DeviationPath::kAlign; }

// F = weight_x x^2 + weight_y y^2 - n around a whole pulse; 64 bits suffice for semi-axes of some thousands.
struct Curve {
  std::int64_t weight_x;
  std::int64_t weight_y;
  std::int64_t n;

  std::int64_t f(std::int64_t x, std::int64_t y) const { return weight_x * x * x + weight_y * y * y - n; }
};

Curve circle(std::int64_t n) { return {1, 1, n}; }
Curve ellipse(std::int64_t a, std::int64_t b) { return {b * b, a * a, a * a * b * b}; }

// A whole turn or a part of it: whole quadrants and the rest.
struct Walk {
  Walk(const Curve& along, std::int64_t sx, std::int64_t sy, std::int64_t ex, std::int64_t ey, unsigned quadrants,
       bool clockwise)
      : curve(along), x(sx), y(sy) {
    path.state.deviation = aligned_8(curve.f(x, y));
    path.state.gradient_x = aligned_8(2 * curve.weight_x * x);
    path.state.gradient_y = aligned_8(2 * curve.weight_y * y);
    path.state.half_x = static_cast<std::uint64_t>(curve.weight_x);
    path.state.half_y = static_cast<std::uint64_t>(curve.weight_y);
    path.state.left_x = static_cast<std::uint32_t>(ex - sx);
    path.state.left_y = static_cast<std::uint32_t>(ey - sy);
    path.state.quadrants = static_cast<std::uint16_t>(quadrants);
    path.state.clockwise = clockwise;
    path.state.eight_directions = true;
    path.begin();
  }

  // False at the end, or after more steps than any walk can take.
  bool goes_on(std::int64_t most) const { return !path.at_end() && steps < most; }
  Step step() {
    const Step made = path.step();
    if (made.in_x) x += made.negative_x ? -1 : 1;
    if (made.in_y) y += made.negative_y ? -1 : 1;
    ++steps;
    return made;
  }

  Curve curve;
  DeviationPath path;
  std::int64_t x;
  std::int64_t y;
  std::int64_t steps = 0;
};

Walk full_turn(const Curve& curve, std::int64_t x, std::int64_t y, bool clockwise) {
  return {curve, x, y, x, y, 4, clockwise};
}

double distance(std::int64_t x, std::int64_t y) {
  return std::sqrt(static_cast<double>(x) * static_cast<double>(x) + static_cast<double>(y) * static_cast<double>(y));
}

// Full turns from the rightmost point.
TEST(EightDirections, IntegerCirclesStayWithinHalfAPulse) {
  double worst = 0;
  for (std::int64_t r = 1; r <= 500; ++r) {
    for (const bool clockwise : {false, true}) {
      Walk walk = full_turn(circle(r * r), r, 0, clockwise);
      while (walk.goes_on(8 * r)) {
        walk.step();
        const double error = std::abs(distance(walk.x, walk.y) - static_cast<double>(r));
        ASSERT_LE(error, 0.5) << "r " << r << " clockwise " << clockwise << " step " << walk.steps;
        worst = std::max(worst, error);
      }
      ASSERT_TRUE(walk.path.at_end() && walk.x == r && walk.y == 0) << "r " << r;
      // In each octant one step per pulse of the longer coordinate; the octants meet at R / sqrt(2).
      const auto octants = static_cast<std::int64_t>(std::lround(std::sqrt(2.0) * static_cast<double>(r)));
      ASSERT_EQ(walk.steps, r == 1 ? 6 : 4 * octants) << "r " << r;
    }
  }
  EXPECT_GT(worst, 0.49);
  RecordProperty("worst", std::to_string(worst));
}

// Circles through any lattice point; most radii are not whole numbers.
TEST(EightDirections, CirclesThroughLatticePointsStayNear) {
  double worst = 0;
  double worst_large = 0;
  for (std::int64_t sx = 0; sx <= 120; ++sx) {
    for (std::int64_t sy = 0; sy <= sx; ++sy) {
      if (sx * sx + sy * sy < 2) continue;
      const double radius = distance(sx, sy);
      for (const bool clockwise : {false, true}) {
        Walk walk = full_turn(circle(sx * sx + sy * sy), sx, sy, clockwise);
        while (walk.goes_on(2000)) {
          walk.step();
          const double error = std::abs(distance(walk.x, walk.y) - radius);
          worst = std::max(worst, error);
          if (radius > 7.1) worst_large = std::max(worst_large, error);
        }
        ASSERT_TRUE(walk.path.at_end() && walk.x == sx && walk.y == sy) << sx << ", " << sy;
      }
    }
  }
  EXPECT_LE(worst, 0.518);
  EXPECT_LE(worst_large, 0.512);
}

// Distance to the ellipse by subdivision: each of 12 rounds keeps the two parts around the nearest of 13 points.
double distance_to_ellipse(double a, double b, double x, double y) {
  x = std::abs(x);
  y = std::abs(y);
  double low = 0;
  double high = std::acos(-1.0) / 2;
  for (int round = 0; round < 12; ++round) {
    constexpr int kParts = 12;
    int best = 0;
    double least = 1e300;
    for (int i = 0; i <= kParts; ++i) {
      const double t = low + (high - low) * i / kParts;
      const double dx = a * std::cos(t) - x;
      const double dy = b * std::sin(t) - y;
      if (dx * dx + dy * dy < least) {
        least = dx * dx + dy * dy;
        best = i;
      }
    }
    const double part = (high - low) / kParts;
    const double middle = low + part * best;
    low = std::max(0.0, middle - part);
    high = std::min(std::acos(-1.0) / 2, middle + part);
  }
  const double t = (low + high) / 2;
  return std::sqrt(std::pow(a * std::cos(t) - x, 2) + std::pow(b * std::sin(t) - y, 2));
}

TEST(EightDirections, EllipsesStayNear) {
  double worst = 0;
  for (std::int64_t a = 20; a <= 120; a += 4) {
    for (std::int64_t b = 20; b <= 120; b += a % 3 + 3) {
      for (const bool clockwise : {false, true}) {
        Walk walk = full_turn(ellipse(a, b), a, 0, clockwise);
        while (walk.goes_on(8 * (a + b))) {
          walk.step();
          worst = std::max(worst, distance_to_ellipse(static_cast<double>(a), static_cast<double>(b),
                                                      static_cast<double>(walk.x), static_cast<double>(walk.y)));
        }
        ASSERT_TRUE(walk.path.at_end() && walk.x == a && walk.y == 0) << a << ", " << b;
      }
    }
  }
  EXPECT_GT(worst, 0.49);
  EXPECT_LE(worst, 0.506);
  RecordProperty("worst", std::to_string(worst));
}

// Computes the three candidates from the formula of the curve. The step taken has the least |F|. Outside the curve, the
// outward axis (whose coordinate moves away from 0) never steps alone when its gradient is the larger one. If the
// inward coordinate is within half a pulse of 0, F with both steps does not lie between those with one step, and the
// outward axis alone may be nearer.
void expect_least(Walk& walk, const std::string& what) {
  const Curve& c = walk.curve;
  const std::int64_t x = walk.x;
  const std::int64_t y = walk.y;
  const std::int64_t f = c.f(x, y);
  const Step made = walk.step();
  const int step_x = (y >= 0) == walk.path.state.clockwise ? 1 : -1;
  const int step_y = (x >= 0) == walk.path.state.clockwise ? -1 : 1;
  ASSERT_TRUE(!made.in_x || walk.x == x + step_x) << what;
  ASSERT_TRUE(!made.in_y || walk.y == y + step_y) << what;
  const bool x_inward = (step_x > 0) != (x >= 0);
  const std::int64_t gradient_x = c.weight_x * std::abs(x);
  const std::int64_t gradient_y = c.weight_y * std::abs(y);
  const bool outward_alone = x_inward ? !made.in_x : !made.in_y;
  if (f >= 0 && outward_alone) {
    ASSERT_LE(x_inward ? gradient_y : gradient_x, x_inward ? gradient_x : gradient_y)
        << what << " at " << x << ", " << y;
  }
  if ((x_inward ? x : y) == 0) return;
  const std::int64_t by_x = std::abs(c.f(x + step_x, y));
  const std::int64_t by_y = std::abs(c.f(x, y + step_y));
  const std::int64_t by_both = std::abs(c.f(x + step_x, y + step_y));
  ASSERT_EQ(std::abs(c.f(walk.x, walk.y)), std::min({by_x, by_y, by_both})) << what << " at " << x << ", " << y;
}

TEST(EightDirections, TakesTheLeastDeviation) {
  std::int64_t steps = 0;
  const auto judge = [&](Walk walk, std::int64_t most, const std::string& what) {
    // Until the fourth change of quadrant; the rest of the walk is straight.
    while (walk.path.state.quadrants != 0 && walk.goes_on(most)) {
      expect_least(walk, what);
      if (::testing::Test::HasFatalFailure()) return;
    }
    ASSERT_EQ(walk.path.state.quadrants, 0) << what;
    steps += walk.steps;
  };
  for (const bool clockwise : {false, true}) {
    for (std::int64_t sx = -40; sx <= 40; ++sx) {
      for (std::int64_t sy = -40; sy <= 40; ++sy) {
        if (sx == 0 && sy == 0) continue;
        judge(full_turn(circle(sx * sx + sy * sy), sx, sy, clockwise), 1000,
              "circle from " + std::to_string(sx) + ", " + std::to_string(sy));
      }
    }
    // Includes very thin ellipses.
    for (const std::int64_t a : {1, 2, 3, 5, 8, 20, 33, 100, 1000, 3000}) {
      for (const std::int64_t b : {1, 2, 3, 5, 8, 20, 33, 100, 1000, 3000}) {
        const std::string what = "ellipse " + std::to_string(a) + ", " + std::to_string(b);
        judge(full_turn(ellipse(a, b), a, 0, clockwise), 8 * (a + b), what);
        judge(full_turn(ellipse(a, b), 0, -b, clockwise), 8 * (a + b), what);
      }
    }
  }
  EXPECT_GT(steps, 1'000'000);
}

// F = |dx| y - |dy| x for a line to the right and up, with F0 = 0: at most half a pulse along either axis, and as many
// steps as the longer axis has pulses.
TEST(EightDirections, LinesStayWithinHalfAPulse) {
  for (int dx = -40; dx <= 40; ++dx) {
    for (int dy = -40; dy <= 40; ++dy) {
      if (dx == 0 || dy == 0) continue;
      DeviationPath path;
      path.state.gradient_x = aligned_8(dx > 0 ? -std::abs(dy) : std::abs(dy));
      path.state.gradient_y = aligned_8(dy > 0 ? std::abs(dx) : -std::abs(dx));
      path.state.left_x = static_cast<std::uint32_t>(dx);
      path.state.left_y = static_cast<std::uint32_t>(dy);
      path.state.clockwise = (dx > 0) == (dy > 0);
      path.state.eight_directions = true;
      path.begin();
      int x = 0;
      int y = 0;
      const int longest = std::max(std::abs(dx), std::abs(dy));
      for (int i = 0; i < longest; ++i) {
        ASSERT_FALSE(path.at_end()) << dx << ", " << dy;
        const Step made = path.step();
        if (made.in_x) x += made.negative_x ? -1 : 1;
        if (made.in_y) y += made.negative_y ? -1 : 1;
        // Distance from the line along the shorter axis.
        ASSERT_LE(2 * std::abs(dx * y - dy * x), longest) << dx << ", " << dy << " step " << i;
      }
      ASSERT_TRUE(path.at_end() && x == dx && y == dy) << dx << ", " << dy;
    }
  }
}

// The largest values of the card: semi-axes of 2^20 (66 bits for F and gradients), in both rules.
TEST(EightDirections, LargestEllipseComesRound) {
  constexpr std::int64_t kSemiAxis = std::int64_t{1} << 20;
  for (const bool eight : {false, true}) {
    DeviationPath path;
    const auto weight = static_cast<int128>(kSemiAxis) * kSemiAxis;
    path.state.gradient_x = aligned_8(2 * weight * kSemiAxis);
    path.state.half_x = path.state.half_y = static_cast<std::uint64_t>(weight);
    path.state.quadrants = 4;
    path.state.eight_directions = eight;
    path.begin();
    std::int64_t steps = 0;
    int128 largest = 0;
    const auto value = [](DeviationPath::Word word) {
      const int128 all = static_cast<int128>(word) >> DeviationPath::kAlign;
      return all < 0 ? -all : all;
    };
    for (; !path.at_end() && steps < 9 * kSemiAxis; ++steps) {
      path.step();
      largest =
          std::max({largest, value(path.state.deviation), value(path.state.gradient_x), value(path.state.gradient_y)});
    }
    EXPECT_TRUE(path.at_end());
    // 8 a steps, or 4 sqrt(2) a in 8 directions.
    EXPECT_EQ(steps, eight ? 4 * std::llround(std::sqrt(2.0) * static_cast<double>(kSemiAxis)) : 8 * kSemiAxis);
    // With the sign and two more bits for the sums of candidates this makes 66 bits.
    EXPECT_GE(largest, int128{1} << 61);
    EXPECT_LT(largest, int128{1} << 63);
  }
}

class EightRig {
 public:
  explicit EightRig(const DeviationPath::State& state) {
    const auto shift = [this](unsigned chain, std::uint64_t word) {
      DeviationAccumulator::Inputs in;
      in.load = {true, static_cast<std::uint16_t>(chain), static_cast<std::uint16_t>(word)};
      block.clock(in);
    };
    for (int i = 0; i < 5; ++i) {
      shift(load_target::kDeviation, static_cast<std::uint64_t>(state.deviation >> (48 + 16 * i)));
      shift(load_target::kGradientX, static_cast<std::uint64_t>(state.gradient_x >> (48 + 16 * i)));
      shift(load_target::kGradientY, static_cast<std::uint64_t>(state.gradient_y >> (48 + 16 * i)));
    }
    for (int i = 0; i < 3; ++i) {
      shift(load_target::kHalfX, state.half_x >> (16 * i));
      shift(load_target::kHalfY, state.half_y >> (16 * i));
    }
    for (int i = 0; i < 2; ++i) {
      shift(load_target::kEndX, state.left_x >> (16 * i));
      shift(load_target::kEndY, state.left_y >> (16 * i));
    }
    shift(load_target::kQuadrants, state.quadrants);
    shift(load_target::kPlane, (state.clockwise ? 1U : 0U) | (state.eight_directions ? 2U : 0U));
  }

  DeviationAccumulator block;
};

TEST(EightDirections, KeepsItsLatencies) {
  Walk walk = full_turn(circle(25 * 25), 25, 0, false);
  EightRig rig(walk.path.state);
  DeviationAccumulator::Inputs start;
  start.start = true;
  rig.block.clock(start);
  for (int clock = 1; clock < 10; ++clock) {
    EXPECT_FALSE(rig.block.outputs().ready) << clock;
    EXPECT_EQ(rig.block.stepping(), clock <= 5) << clock;
    rig.block.clock({});
  }
  ASSERT_TRUE(rig.block.outputs().ready);
  DeviationAccumulator::Inputs tick;
  tick.tick = true;
  int diagonal = 0;
  while (walk.goes_on(1000)) {
    const Step step = walk.step();
    diagonal += step.in_x && step.in_y ? 1 : 0;
    rig.block.clock(tick);
    for (int age = 1; age < 17; ++age) {
      const DeviationAccumulator::Outputs& out = rig.block.outputs();
      ASSERT_FALSE(out.ready) << age;
      ASSERT_EQ(rig.block.stepping(), age <= 12) << age;
      ASSERT_EQ(out.step_x, age == 2 && step.in_x) << age;
      ASSERT_EQ(out.step_y, age == 2 && step.in_y) << age;
      ASSERT_TRUE(!out.step_x || out.dir_x == step.negative_x);
      ASSERT_TRUE(!out.step_y || out.dir_y == step.negative_y);
      rig.block.clock({});
    }
    ASSERT_TRUE(rig.block.outputs().ready);
    ASSERT_EQ(rig.block.outputs().at_end, walk.path.at_end());
  }
  EXPECT_TRUE(rig.block.outputs().at_end);
  EXPECT_GT(diagonal, 20);
  rig.block.clock(tick);
  EXPECT_TRUE(rig.block.outputs().ready);  // no step beyond the end
}

}  // namespace
}  // namespace trammel::model
