#include "trammel/chart/chart.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace trammel::chart {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(RoundTicks, AreMultiplesOfOneTwoOrFive) {
  EXPECT_THAT(round_ticks(0, 10, 6), ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(round_ticks(0.3, 9.7, 6), ElementsAre(2, 4, 6, 8));
  EXPECT_THAT(round_ticks(-250, 700, 5), ElementsAre(-200, 0, 200, 400, 600));
  EXPECT_THAT(round_ticks(-3, -1, 3), ElementsAre(-3, -2, -1));
}

TEST(RoundTicks, AreNeverMoreThanAsked) {
  for (double span = 1e-6; span < 1e7; span *= 1.37) {
    for (std::size_t most = 2; most < 12; ++most) {
      const auto ticks = round_ticks(-0.3 * span, 0.7 * span, most);
      EXPECT_LE(ticks.size(), most);
      EXPECT_GE(ticks.size(), 1U);
      for (const double tick : ticks) {
        EXPECT_GE(tick, -0.3 * span * (1 + 1e-6));
        EXPECT_LE(tick, 0.7 * span * (1 + 1e-6));
      }
    }
  }
}

Panel one_line() {
  Panel panel;
  panel.title = "speed <b>";
  panel.x.label = "time, s";
  panel.y.label = "speed, mm/s";
  panel.series.push_back({"commanded & made", "#123456", {{0, 0}, {1, 10}}});
  return panel;
}

TEST(Figure, HasTitlesLabelsTicksAndLegend) {
  const std::string svg = grid_of({one_line()}, 1, 400, 300);
  for (const char* text :
       {"speed &lt;b&gt;", "time, s", "speed, mm/s", "commanded &amp; made", ">0.5<", ">10<", "</svg>"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
}

TEST(Figure, EndsOfTheRangeLieOnTheFrame) {
  Figure figure(400, 300);
  figure.add(one_line(), {0, 0, 400, 300});
  // The frame: x from 62 to 384, y from 260 (bottom) to 45 (top, below a title and one row of legend).
  EXPECT_THAT(figure.svg(), HasSubstr("points=\"62.0,260.0 384.0,45.0\""));
}

TEST(Figure, ARangeThatIsGivenCutsTheLine) {
  Panel panel = one_line();
  panel.y.low = 0;
  panel.y.high = 20;
  panel.series[0].points = {{0, 0}, {0.5, 20}, {0.75, 30}, {1, 10}};
  const std::string svg = grid_of({panel}, 1, 400, 300);
  EXPECT_THAT(svg, HasSubstr("points=\"62.0,260.0 223.0,45.0\""));
  EXPECT_THAT(svg, HasSubstr("points=\"384.0,152.5\""));
}

TEST(Figure, EqualScaleMakesAUnitAsLongInBothAxes) {
  Panel panel = one_line();
  panel.equal_scale = true;
  panel.series[0].mark = Mark::kDots;
  panel.series[0].points = {{0, 0}, {10, 0}, {0, 10}};
  const std::string svg = grid_of({panel}, 1, 400, 300);
  // The height sets the scale: 10 units take 96 % of 215 pixels. The three dots are centred in the frame.
  EXPECT_THAT(svg, HasSubstr("cx=\"119.8\" cy=\"255.7\""));
  EXPECT_THAT(svg, HasSubstr("cx=\"326.2\" cy=\"255.7\""));
  EXPECT_THAT(svg, HasSubstr("cx=\"119.8\" cy=\"49.3\""));
}

TEST(Figure, StairsHoldEachValue) {
  Panel panel = one_line();
  panel.series[0].mark = Mark::kStairs;
  EXPECT_THAT(grid_of({panel}, 1, 400, 300), HasSubstr("points=\"62.0,260.0 384.0,260.0 384.0,45.0\""));
}

TEST(Figure, LogarithmicTicksAreDecadesOrOneTwoFive) {
  Panel panel = one_line();
  panel.x.logarithmic = true;
  panel.series[0].points = {{100, 1}, {1000, 2}, {0, 3}, {-1, 3}};
  const std::string few = grid_of({panel}, 1, 400, 300);
  for (const char* tick : {">100<", ">200<", ">500<", ">1000<"}) EXPECT_THAT(few, HasSubstr(tick));
  panel.series[0].points = {{1e-3, 1}, {1e6, 2}};
  const std::string many = grid_of({panel}, 1, 400, 300);
  EXPECT_THAT(many, HasSubstr(">0.001<"));
  EXPECT_THAT(many, Not(HasSubstr(">2<")));
}

TEST(Figure, OfNothingOneValueOrWhatIsNoNumberIsAPictureStill) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<Point>& points :
       {std::vector<Point>{}, {{3, 3}}, {{nan, 1}, {1, nan}, {2, 2}}, {{5, 1}, {5, 1}}}) {
    Panel panel = one_line();
    panel.series[0].points = points;
    for (const bool equal : {false, true}) {
      panel.equal_scale = equal;
      const std::string svg = grid_of({panel}, 1, 400, 300);
      EXPECT_THAT(svg, Not(HasSubstr("nan")));
      EXPECT_THAT(svg, Not(HasSubstr("inf")));
      EXPECT_THAT(svg, HasSubstr("</svg>"));
    }
  }
}

TEST(Figure, ALegendTakesAsManyRowsAsItNeedsAndTheDataBeginBelow) {
  Panel panel = one_line();
  for (int i = 0; i < 6; ++i) panel.series.push_back({"a rather long label", colour(1), {{0, 0}, {1, 10}}});
  // Seven entries: about 171 pixels each, 338 per row. The first two share a row, so there are six rows of 17 pixels.
  EXPECT_THAT(grid_of({panel}, 1, 400, 300), HasSubstr("384.0,130.0\""));
}

TEST(Escaped, LeavesNothingThatMarksUp) { EXPECT_EQ(escaped("</svg>&\"\x01\n"), "&lt;/svg&gt;&amp;&quot;\n"); }

}  // namespace
}  // namespace trammel::chart
