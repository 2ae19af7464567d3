#include "trammel/run/plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace trammel::run {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(PathPoints, KeepsABoundedShareByDistanceAndTheLastPoint) {
  PathPoints path(100);
  for (int i = 0; i < 100'000; ++i) path.add({{i * 1.0, 0, 0}, false});
  const auto points = path.points();
  EXPECT_LE(points.size(), 201U);
  EXPECT_GE(points.size(), 50U);
  EXPECT_TRUE(path.thinned());
  EXPECT_EQ(points.front().at[0], 0);
  EXPECT_EQ(points.back().at[0], 99'999);
}

TEST(PathPoints, KeepsARapidAmongManyFeeds) {
  PathPoints path(100);
  for (int i = 0; i < 50'000; ++i) path.add({{i * 0.01, 0, 0}, false});
  path.add({{500, 300, 0}, true});
  for (int i = 0; i < 50'000; ++i) path.add({{500 - i * 0.01, 300, 0}, false});
  int rapids = 0;
  for (const PathPoint& point : path.points()) rapids += point.rapid;
  EXPECT_EQ(rapids, 1);
}

TEST(PathPoints, OfFewPointsAreAllOfThem) {
  PathPoints path(100);
  for (int i = 0; i < 150; ++i) path.add({{0, 0, i % 2 * 1.0}, false});
  EXPECT_EQ(path.points().size(), 150U);
  EXPECT_FALSE(path.thinned());
}

double way_of(const std::vector<PathSpeed::Sample>& samples) {
  double way = 0;
  for (const auto& sample : samples) way += sample.speed;
  return way * 2 * samples.front().seconds;  // the first sample is at half a bin
}

TEST(PathSpeed, AConstantSpeedComesOutConstant) {
  PathSpeed speed(1'000'000);
  // 80 steps/mm at 10 mm/s: a step every 1,250 clocks; some come a clock or two late. The width of a bin is not a
  // multiple of 1,250 clocks.
  for (std::uint64_t i = 0; i < 2'000; ++i) speed.add(625 + 1'250 * i + i % 3, 0, 1.0 / 80);
  const auto samples = speed.samples();
  EXPECT_LE(samples.size(), 1024U);
  for (std::size_t i = 1; i + 2 < samples.size(); ++i) ASSERT_NEAR(samples[i].speed, 10, 0.03) << i;
  EXPECT_NEAR(way_of(samples), 25, 1e-6);
}

TEST(PathSpeed, TwoAxesAreOneSpeedWhateverTheirSlope) {
  PathSpeed speed(1'000'000);
  // A slope of 1 in 50 at 100 steps/mm: x steps every 1,000 clocks, y every 50,000.
  for (std::uint64_t i = 0; i < 3'000; ++i) {
    speed.add(500 + 1'000 * i, 0, 0.01);
    if (i % 50 == 25) speed.add(500 + 1'000 * i, 1, 0.01);
  }
  const auto samples = speed.samples();
  for (std::size_t i = 20; i + 20 < samples.size(); ++i) ASSERT_NEAR(samples[i].speed, std::hypot(10, 0.2), 0.01) << i;
}

// Each sample spans a sixteenth of a turn.
TEST(PathSpeed, IsConstantOnCirclesThatASampleDoesNotResolve) {
  PathSpeed speed(1'000'000);
  constexpr double kRadius = 10;  // mm
  constexpr double kSpeed = 20;   // mm/s
  constexpr double kScale = 80;   // steps/mm
  std::array<double, 2> at{kRadius * kScale, 0};
  for (std::uint64_t cycle = 0; cycle < 200'000'000; cycle += 50) {
    const double angle = kSpeed / kRadius * static_cast<double>(cycle) * 1e-6;
    const std::array<double, 2> now{std::round(kRadius * kScale * std::cos(angle)),
                                    std::round(kRadius * kScale * std::sin(angle))};
    for (std::size_t a = 0; a < 2; ++a) {
      if (now[a] != at[a]) speed.add(cycle, a, 1 / kScale);
    }
    at = now;
  }
  const auto samples = speed.samples();
  EXPECT_LE(samples.size(), 1024U);
  for (std::size_t i = 1; i + 2 < samples.size(); ++i) ASSERT_NEAR(samples[i].speed, kSpeed, 0.04 * kSpeed) << i;
}

TEST(PathSpeed, IsZeroWhereTheAxisStandsStill) {
  PathSpeed speed(1'000'000);
  for (std::uint64_t i = 0; i < 500; ++i) speed.add(500 + 1'000 * i, 0, 0.01);
  for (std::uint64_t i = 0; i < 500; ++i) speed.add(1'500'500 + 1'000 * i, 0, 0.01);
  for (const auto& sample : speed.samples()) {
    if (sample.seconds > 0.505 && sample.seconds < 1.495) {
      ASSERT_EQ(sample.speed, 0) << sample.seconds;
    } else if (sample.seconds > 0.01 && sample.seconds < 0.49) {
      ASSERT_NEAR(sample.speed, 10, 0.01) << sample.seconds;
    }
  }
  EXPECT_NEAR(way_of(speed.samples()), 10, 1e-6);
}

Plot plot_of(std::vector<PathPoint> points) {
  Plot plot;
  plot.title = "a<b>&c.ngc";
  plot.commanded = points;
  plot.executed = std::move(points);
  plot.detail_commanded = {{0, 0, 0}, {0.0125, 0, 0}};
  plot.detail_executed = plot.detail_commanded;
  plot.speed = {{0.1, 10}, {0.2, 20}};
  return plot;
}

TEST(Plot, ShowsThePlaneThatMatters) {
  const std::string text = svg(plot_of({{{0, 0, 0}, false}, {{10, 5, 0}, false}}));
  for (const char* part : {"a&lt;b&gt;&amp;c.ngc", "X, mm", "Y, mm", "mm/s", ">start<", ">end<", "</svg>"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  EXPECT_THAT(text, Not(HasSubstr("Z, mm")));
  EXPECT_THAT(text, Not(HasSubstr("rapids")));
}

TEST(Plot, ShowsThreeViewsWhereThreeAxesMove) {
  const std::string text = svg(plot_of({{{0, 0, 0}, false}, {{10, 5, 3}, true}, {{20, 5, 3}, false}}));
  for (const char* part : {"from above", "from the front", "from the right", "rapids", "stroke-dasharray"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
}

TEST(Plot, OfZAloneIsAVerticalLine) {
  Plot plot = plot_of({{{0, 0, 0}, false}, {{0, 0, -8}, false}});
  plot.detail_executed = {{0, 0, 0}, {0, 0, -0.1}};
  const std::string text = svg(plot);
  EXPECT_THAT(text, HasSubstr("Z, mm"));
  EXPECT_THAT(text, Not(HasSubstr("Y, mm")));
}

TEST(Plot, OfNothingIsAPictureStill) {
  const std::string text = svg(Plot{});
  EXPECT_THAT(text, HasSubstr("</svg>"));
  EXPECT_THAT(text, Not(HasSubstr("nan")));
}

TEST(Plot, OfManyPointsStaysSmall) {
  PathPoints path(20'000);
  for (int i = 0; i < 1'000'000; ++i) path.add({{std::cos(0.01 * i) * i, std::sin(0.01 * i) * i, i * 1.0}, false});
  EXPECT_LT(svg(plot_of(path.points())).size(), 5'000'000U);
}

}  // namespace
}  // namespace trammel::run
