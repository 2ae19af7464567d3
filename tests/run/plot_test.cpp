#include "trammel/run/plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace trammel::run {
namespace {

using ::testing::HasSubstr;

TEST(ThinnedPath, KeepsABoundedShareEvenlyAndTheLastPoint) {
  ThinnedPath path(100);
  for (int i = 0; i < 100'000; ++i) path.add({i * 1.0, 0, 0});
  const std::vector<Point> points = path.points();
  EXPECT_LE(points.size(), 201U);
  EXPECT_GE(points.size(), 100U);
  EXPECT_TRUE(path.thinned());
  EXPECT_EQ(path.given(), 100'000U);
  EXPECT_EQ(points.front()[0], 0);
  EXPECT_EQ(points.back()[0], 99'999);
  for (std::size_t i = 2; i + 1 < points.size(); ++i) {
    EXPECT_EQ(points[i][0] - points[i - 1][0], points[1][0] - points[0][0]);
  }
}

TEST(SpeedOverTime, IsExactInBinsThatDouble) {
  SpeedOverTime speed(1000);
  // 0.5 mm every 10 clocks at 1 kHz: 50 mm/s, for longer than the first bins reach.
  for (std::uint64_t cycle = 0; cycle < 20'480; cycle += 10) speed.add(cycle, 0, 0.5);
  const auto samples = speed.samples();
  EXPECT_LE(samples.size(), 1024U);
  double travelled = 0;
  for (const auto& sample : samples) travelled += sample.speed;
  const double width = samples[1].seconds - samples[0].seconds;
  EXPECT_NEAR(travelled * width, 1024, 1e-6);
}

TEST(Svg, ShowsPathsDetailAndSpeed) {
  Plot plot;
  plot.title = "a<b>&c.ngc";
  plot.commanded = {{0, 0, 0}, {10, 5, 0}};
  plot.executed = plot.commanded;
  plot.detail_executed = {{0, 0, 0}, {0.0125, 0, 0}};
  plot.speed = {{0.1, 10}, {0.2, 20}};
  const std::string text = svg(plot);
  EXPECT_THAT(text, HasSubstr("a&lt;b&gt;&amp;c.ngc"));
  EXPECT_THAT(text, HasSubstr("class=\"commanded\""));
  EXPECT_THAT(text, HasSubstr("X 0.00 .. 10.00 mm, Y 0.00 .. 5.00 mm"));
  EXPECT_THAT(text, HasSubstr("class=\"pulse\""));
  EXPECT_THAT(text, HasSubstr("</svg>"));
}

TEST(Svg, OfNothingIsAPictureStill) { EXPECT_THAT(svg(Plot{}), HasSubstr("</svg>")); }

}  // namespace
}  // namespace trammel::run
