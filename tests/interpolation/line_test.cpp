// Lines against the vectors of the papers and closed forms.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "paper_lines.hpp"
#include "walks.hpp"

namespace trammel::interpolation {
namespace {

double largest_error(Method method, const Line& line, const Options& options = {}) {
  const Walked walked = walk_all(make_interpolator(method, line, options), 1u << 24,
                                 [&](const Position& p) { return from_line(line, p); });
  EXPECT_EQ(walked.end, line.end) << info(method).name;
  return walked.largest;
}

Line random_line(std::mt19937_64& random, std::int64_t most) {
  std::uniform_int_distribution<std::int64_t> coordinate(-most, most);
  return make_line({coordinate(random), coordinate(random)}, {coordinate(random), coordinate(random)});
}

TEST(Line, SteerMakesTableOne) {
  SteerLine walk(make_line({0, 0}, {3, -7}));
  EXPECT_EQ(axes_of(walk), "yyxyyxyyyx");
  for (const std::int64_t f : {-4, -1, 2, -5, -2, 1, -6, -3, 0, 3}) {
    EXPECT_EQ(static_cast<std::int64_t>(walk.deviation()), f);
    walk.next();
  }
  EXPECT_TRUE(walk.done());
  EXPECT_EQ(walk.position(), (Position{3, -7, 0, 0}));
}

TEST(Line, ErrorsOfTheSecondPapersLines) {
  for (std::size_t i = 0; i < kPaperLines.size(); ++i) {
    for (std::size_t m = 0; m < kPaperMethods.size(); ++m) {
      EXPECT_NEAR(largest_error(kPaperMethods[m], kPaperLines[i].line()), kPaperLines[i].errors[m], 0.0005)
          << "line " << i + 1 << " " << info(kPaperMethods[m]).name;
    }
  }
}

TEST(Line, SteerTakesEveryUnitStep) {
  for (const PaperLine& paper : kPaperLines) EXPECT_EQ(SteerLine(paper.line()).total_time(), paper.steer_steps);
}

TEST(Line, IntegerDividersStrayAtFiftyMegahertz) {
  const Line first = make_line({0, 0}, {29999, 10007});
  const Line second = make_line({0, 0}, {30000, 10001});
  const auto error = [](const Line& line, std::uint64_t velocity) {
    return largest_error(Method::kDivider, line, {50'000'000, velocity, 1});
  };
  EXPECT_NEAR(error(first, 1), 4.10, 0.005);
  EXPECT_NEAR(error(first, 3), 7.59, 0.005);
  EXPECT_NEAR(error(second, 1), 3.79, 0.005);
  EXPECT_NEAR(error(second, 3), 7.59, 0.005);
}

// The position in every clock from the definition, against the walk from pulse to pulse.
TEST(Line, PulseTrainsAreTheirClosedForms) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 2000; ++i) {
    const Line line = random_line(random, 60);
    const std::uint64_t velocity = 1 + random() % 7;
    const std::uint64_t clock = velocity * (120 + random() % 100) + random() % velocity;
    for (const Method method : {Method::kOneShot, Method::kOneShotZero, Method::kDivider}) {
      auto walk = make_interpolator(method, line, {clock, velocity, 1});
      for (std::uint64_t k = 0; k <= walk.total_time(); ++k) {
        while (true) {
          auto ahead = walk;
          if (ahead.done()) break;
          ahead.next();
          if (ahead.time() > k) break;
          walk = ahead;
        }
        for (unsigned a = 0; a < 2; ++a) {
          const std::int64_t p = line.end[a] - line.start[a];
          const auto size = static_cast<std::uint64_t>(std::abs(p));
          std::uint64_t made = (2 * k * size * velocity + clock) / (2 * clock);
          if (method == Method::kOneShotZero) made = k * size * velocity / clock;
          if (method == Method::kDivider) made = size == 0 ? 0 : std::min(size, k / (clock / (velocity * size)));
          if (method != Method::kDivider) made = std::min(made, size);
          ASSERT_EQ(walk.position()[a], line.start[a] + (p < 0 ? -1 : 1) * static_cast<std::int64_t>(made))
              << info(method).name << " clock " << k;
        }
      }
      ASSERT_TRUE(walk.done()) << info(method).name;
    }
  }
}

TEST(Line, DdaTakesAPowerOfTwoOfIterations) {
  EXPECT_EQ(make_interpolator(Method::kDda, make_line({0, 0}, {7, 3})).total_time(), 8u);
  EXPECT_EQ(make_interpolator(Method::kDdaHalf, make_line({0, 0}, {3, -8})).total_time(), 16u);
  // x_k = floor(1/2 + 5k/8): pulses at 1, 3, 4, 6, 8.
  auto walk = make_interpolator(Method::kDdaHalf, make_line({0, 0}, {5, 0}));
  for (const std::uint64_t k : {1u, 3u, 4u, 6u, 8u}) {
    walk.next();
    EXPECT_EQ(walk.time(), k);
  }
}

TEST(Line, ErrorBounds) {
  std::mt19937_64 random(2);
  std::array<double, kMethodCount> largest{};
  for (int i = 0; i < 20000; ++i) {
    const Line line = random_line(random, i < 10000 ? 8 : 300);
    for (const MethodInfo& method : methods()) {
      if (method.line_axes == 0) continue;
      double& worst = largest[static_cast<std::size_t>(method.method)];
      worst = std::max(worst, largest_error(method.method, line, {600'000, 1, 1}));
    }
  }
  const auto of = [&](Method method) { return largest[static_cast<std::size_t>(method)]; };
  EXPECT_LT(of(Method::kSteer), 1);
  EXPECT_LT(of(Method::kPointByPoint), 1);
  EXPECT_LE(of(Method::kMinF4), std::sqrt(0.5) + 1e-9);
  EXPECT_LE(of(Method::kMinDeviation8), 0.5 + 1e-9);
  EXPECT_LE(of(Method::kDdaHalf), std::sqrt(0.5) + 1e-9);
  EXPECT_LE(of(Method::kOneShot), std::sqrt(0.5) + 1e-9);
  EXPECT_LT(of(Method::kOneShotZero), 1);
  EXPECT_LT(of(Method::kDda), 1);
  // Lower bounds, so that the upper bounds are not too wide.
  EXPECT_GT(of(Method::kSteer), 0.9);
  EXPECT_GT(of(Method::kMinDeviation8), 0.49);
  EXPECT_GT(of(Method::kOneShot), 0.69);
}

TEST(Line, DeviationChoosesTheStep) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 2000; ++i) {
    const Line line = random_line(random, 40);
    const std::int64_t dx = std::abs(line.end[0] - line.start[0]);
    const std::int64_t dy = std::abs(line.end[1] - line.start[1]);
    MinFLine least(line);
    MinDeviationLine eight(line);
    while (!least.done()) {
      const auto f = static_cast<std::int64_t>(least.deviation());
      const bool in_x = least.next().direction[0] != 0;
      const bool slanted = dx != 0 && dy != 0;
      ASSERT_TRUE(!slanted || std::abs(in_x ? f - dy : f + dx) <= std::abs(in_x ? f + dx : f - dy));
    }
    while (!eight.done()) {
      eight.next();
      const Position p = eight.position();
      const std::int64_t x = std::abs(p[0] - line.start[0]);
      const std::int64_t y = std::abs(p[1] - line.start[1]);
      ASSERT_EQ(static_cast<std::int64_t>(eight.deviation()), dx * y - dy * x);
      ASSERT_LE(2 * std::abs(dx * y - dy * x), std::max(dx, dy));
    }
  }
}

TEST(Line, FourAxesEndExactlyAndStayWithinHalfAPulse) {
  std::mt19937_64 random(4);
  std::uniform_int_distribution<std::int64_t> coordinate(-200, 200);
  for (int i = 0; i < 3000; ++i) {
    Line line;
    line.axes = i % 2 == 0 ? 3 : 4;
    for (unsigned a = 0; a < line.axes; ++a) {
      line.start[a] = coordinate(random);
      line.end[a] = coordinate(random);
    }
    const auto longest = static_cast<std::int64_t>(longest_axis(line));
    for (const Method method : {Method::kMinDeviation8, Method::kDda, Method::kDdaHalf, Method::kOneShot,
                                Method::kOneShotZero, Method::kDivider}) {
      auto walk = make_interpolator(method, line, {1000, 1, 1});
      const bool exact = method == Method::kMinDeviation8 || method == Method::kOneShot || method == Method::kDdaHalf;
      const auto total = static_cast<std::int64_t>(walk.total_time());
      while (!walk.done()) {
        walk.next();
        const auto k = static_cast<std::int64_t>(walk.time());
        for (unsigned a = 0; a < line.axes && exact; ++a) {
          const std::int64_t p = line.end[a] - line.start[a];
          ASSERT_LE(2 * std::abs(total * (walk.position()[a] - line.start[a]) - k * p), total) << info(method).name;
        }
      }
      ASSERT_EQ(walk.position(), line.end) << info(method).name;
      ASSERT_LE(walk.time(), walk.total_time());
    }
    ASSERT_EQ(MinDeviationSpaceLine(line).total_time(), static_cast<std::uint64_t>(longest));
  }
}

TEST(Line, EmptyAndAxisParallelLines) {
  for (const MethodInfo& method : methods()) {
    if (method.line_axes == 0) continue;
    EXPECT_TRUE(make_interpolator(method.method, make_line({5, -3}, {5, -3})).done()) << method.name;
    for (const Point& end : {Point{9, 0}, Point{-9, 0}, Point{0, 9}, Point{0, -9}}) {
      const Line line = make_line({0, 0}, end);
      auto walk = make_interpolator(method.method, line);
      std::uint64_t steps = 0;
      for (; !walk.done(); ++steps) walk.next();
      EXPECT_EQ(steps, 9u) << method.name;
      EXPECT_EQ(walk.position(), line.end) << method.name;
    }
  }
}

TEST(Line, LongestLineStaysInsideItsWidths) {
  // 2^30 pulses on both axes; the first million steps, whose deviations are exact in 128 bits.
  const std::int64_t most = kMaxLine;
  const Line line = make_line({0, 0}, {most, -(most - 1)});
  for (const MethodInfo& method : methods()) {
    if (method.line_axes == 0) continue;
    auto walk = make_interpolator(method.method, line, {std::uint64_t{1} << 32, 1, 1});
    for (int i = 0; i < 1'000'000; ++i) walk.next();
    ASSERT_LT(from_line(line, walk.position()), 1.5) << method.name;
  }
}

}  // namespace
}  // namespace trammel::interpolation
