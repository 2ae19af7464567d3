// G5 and G5.1: distance between the lines and the curve.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "reading.hpp"

namespace trammel::gcode {
namespace {

using ::testing::HasSubstr;

constexpr double kTolerance = 0.002;  // mm, as docs/user/g-code.md says

struct Point {
  double x, y;
};

// De Casteljau's construction, which the reader does not use.
Point on_curve(std::vector<Point> points, double t) {
  for (; points.size() > 1; points.pop_back()) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      points[i] = {points[i].x + t * (points[i + 1].x - points[i].x),
                   points[i].y + t * (points[i + 1].y - points[i].y)};
    }
  }
  return points[0];
}

double to_segment(const Point& p, const Point& a, const Point& b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double share = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  return std::hypot(p.x - a.x - share * dx, p.y - a.y - share * dy);
}

// Largest distance of the curve from the lines of a program that begins at `controls[0]`.
double largest_distance(const std::vector<Motion>& motions, const std::vector<Point>& controls) {
  std::vector<Point> path{controls.front()};
  for (const Motion& motion : motions) path.push_back({motion.target[0], motion.target[1]});
  double largest = 0;
  for (int i = 0; i <= 20000; ++i) {
    const Point p = on_curve(controls, i / 20000.0);
    double nearest = 1e9;
    for (std::size_t k = 0; k + 1 < path.size(); ++k) nearest = std::min(nearest, to_segment(p, path[k], path[k + 1]));
    largest = std::max(largest, nearest);
  }
  return largest;
}

std::vector<Motion> spline_lines(const std::string& text) {
  Reading program = read_text(text);
  EXPECT_FALSE(program.error) << describe(*program.error);
  std::vector<Motion> lines;
  for (const Motion& motion : program.motions) {
    if (motion.kind == MotionKind::kLine) lines.push_back(motion);
  }
  return lines;
}

std::string spline_refusal(const std::string& text) { return read_text(text).message(); }

TEST(Spline, CubicKeepsToTheTolerance) {
  const std::vector<Point> controls = {{0, 0}, {0, 30}, {40, -20}, {40, 10}};
  const std::vector<Motion> lines = spline_lines("F600\nG5 I0 J30 P0 Q-30 X40 Y10");
  ASSERT_GT(lines.size(), 20U);
  EXPECT_LE(largest_distance(lines, controls), kTolerance);
  EXPECT_GT(largest_distance(lines, controls), kTolerance / 10) << "far more lines than it needs";
  EXPECT_EQ(lines.back().target[0], 40);
  EXPECT_EQ(lines.back().target[1], 10);
  EXPECT_EQ(lines.front().feed, 10);
}

TEST(Spline, QuadraticKeepsToTheTolerance) {
  const std::vector<Motion> lines = spline_lines("F600\nG20\nG5.1 X2 I0 J1");
  EXPECT_LE(largest_distance(lines, {{0, 0}, {0, 25.4}, {50.8, 0}}), kTolerance);
  EXPECT_GT(lines.size(), 20U);
}

TEST(Spline, TheNextOneGoesOnSmoothly) {
  const std::vector<Motion> lines = spline_lines("F600\nG5 I0 J10 P-5 Q5 X20 Y0\nP0 Q10 X40\n");
  const std::vector<Motion> same = spline_lines("F600\nG5 I0 J10 P-5 Q5 X20 Y0\nI5 J-5 P0 Q10 X40\n");
  ASSERT_EQ(lines.size(), same.size());
  for (std::size_t i = 0; i < lines.size(); ++i) EXPECT_EQ(lines[i].target, same[i].target);
}

TEST(Spline, AStraightOneIsALine) {
  EXPECT_EQ(spline_lines("F600\nG5 I10 J10 P-10 Q-10 X30 Y30").size(), 1U);
  EXPECT_EQ(spline_lines("F600\nG91\nG5.1 I5 X10").size(), 1U);
}

TEST(Spline, ExactStopIsForItsEnd) {
  const std::vector<Motion> lines = spline_lines("F600 G61.1\nG5 I0 J10 P-5 Q5 X20 Y0");
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) EXPECT_EQ(lines[i].path_control, PathControl::kContinuous);
  EXPECT_EQ(lines.back().path_control, PathControl::kExactStop);
}

TEST(Spline, RefusesWhatIsNoCurve) {
  EXPECT_THAT(spline_refusal("F60 G5 X10 P1 Q1"), HasSubstr("G5 needs I and J"));
  EXPECT_THAT(spline_refusal("F60 G5 X10 I1 J1"), HasSubstr("G5 needs P and Q"));
  EXPECT_THAT(spline_refusal("F60 G5 X10 I1 P1 Q1"), HasSubstr("G5 needs I and J"));
  EXPECT_THAT(spline_refusal("F60 G5 X10 I1 J1 P1 Q1\nG1 X11\nG5 X20 P1 Q1"), HasSubstr("G5 needs I and J"));
  EXPECT_THAT(spline_refusal("F60 G5.1 X10"), HasSubstr("G5.1 needs I or J"));
  EXPECT_THAT(spline_refusal("F60 G18 G5 X10 I1 J1 P1 Q1"), HasSubstr("in the plane XY"));
  EXPECT_THAT(spline_refusal("F60 G5 X10 Z1 I1 J1 P1 Q1"), HasSubstr("X and Y alone"));
  EXPECT_THAT(spline_refusal("F60 G93 G5 X10 I1 J1 P1 Q1"), HasSubstr("G94, not G93"));
  EXPECT_THAT(spline_refusal("F60 G5 I1 J1 P1 Q1"), HasSubstr("without an axis word"));
  EXPECT_THAT(spline_refusal("F60 G5 X10 I1 J1000000000 P1 Q1"), HasSubstr("more than 10000 lines"));
  EXPECT_THAT(spline_refusal("F60 G1 X10 P-1"), HasSubstr("P without"));
  EXPECT_THAT(spline_refusal("F60 G5 X10 I1 J1 P1"), HasSubstr("G5 needs P and Q"));
  EXPECT_THAT(spline_refusal("F60 G5 X10 I1 J1 Q1"), HasSubstr("G5 needs P and Q"));
  EXPECT_EQ(spline_refusal("F60 G5.1 I1 J1"), "G5.1 without an axis word");
  EXPECT_EQ(spline_refusal("G5.1 X10 I1 J1"), "motion with feed, but no F word before");
}

TEST(Spline, NeedsXAndY) {
  for (const std::size_t lacking : {0U, 1U}) {
    machine::Machine machine = machine::default_machine();
    const std::string letter(1, machine.axes[lacking].letter);
    machine.axes.erase(machine.axes.begin() + static_cast<std::ptrdiff_t>(lacking));
    EXPECT_EQ(read_text("F60 G5.1 Z1 I1", machine).message(),
              "a spline in this plane needs an axis " + letter + ", which the machine lacks");
  }
}

}  // namespace
}  // namespace trammel::gcode
