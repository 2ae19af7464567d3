// The S-curve plan against the least time, found by an optimiser that does not assume ramps.
#include "least_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "s_curve_programs.hpp"

namespace trammel::planner {
namespace {

using test::kInfinite;
using test::least_seconds;
using test::Random;
using test::seconds;
using test::Spans;

TEST(LeastTime, OfLoneMovesIsTheClosedForms) {
  for (const double length : {0.05, 1.0, 10.0, 100.0}) {
    const Spans spans = {{length, 100, 1000, 30'000, 0}};
    EXPECT_NEAR(least_seconds(spans, 400) / seconds(spans), 1, 1e-4) << length;
  }
}

TEST(LeastTime, OfAZigzagIsThePlans) {
  Spans spans(10, {5, 150, 1155, 57'735, 5});
  spans.back().exit_speed = 0;
  const double least = least_seconds(spans, 800);
  EXPECT_NEAR(seconds(spans) / least, 1, 1e-3);
}

// Each program has one acceleration and jerk, different speeds, and corners. The least time keeps some acceleration at
// places where the plan has none: where a ramp ends at a limit of speed, or where two short ramps meet.
TEST(LeastTime, OfRandomProgramsIsLittleLessThanThePlans) {
  Random random(101);
  double worst = 0;
  double mean = 0;
  for (int i = 0; i < 20; ++i) {
    const test::Limits limits = test::random_limits(random);
    Spans spans;
    for (std::size_t count = 2 + random.below(11); count > 0; --count) {
      const double speed = random.logarithmic(limits.speed / 20, limits.speed);
      const double exit = random.below(2) != 0 ? kInfinite : random.uniform(0.02, 1) * limits.speed;
      spans.push_back({random.logarithmic(0.1, 50), speed, limits.acceleration, limits.jerk, exit});
    }
    spans.back().exit_speed = 0;
    const double gap = seconds(spans) / least_seconds(spans, 800) - 1;
    EXPECT_GT(gap, -0.01) << i;  // measured: -0.007, by few nodes in short ramps beside a long way
    worst = std::max(worst, gap);
    mean += gap / 20;
  }
  // Measured 0.020 and 0.0021. With 0.95 of the acceleration the mean is 0.0037, with 0.8 of the jerk the worst 0.042.
  EXPECT_LE(worst, 0.025);
  EXPECT_LE(mean, 0.003);
  RecordProperty("worst", std::to_string(worst));
  RecordProperty("mean", std::to_string(mean));
}

}  // namespace
}  // namespace trammel::planner
