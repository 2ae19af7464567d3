// Every line and every arc of small curves on the RTL, in both directions: the number of steps equals the driver's,
// the end is the commanded one, and no point is farther away than the rule's bound. If 8 directions are built in
// (TRAMMEL_EIGHT), both rules are tested.
#include <Vdut.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "trammel/driver/arc.hpp"
#include "trammel/model/buses.hpp"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

using driver::ArcCommand;
using driver::StepRule;
namespace load_target = model::load_target;
using Point = std::pair<int, int>;

constexpr double kPi = 3.14159265358979323846;
const std::vector<StepRule> kRules = TRAMMEL_EIGHT != 0
                                         ? std::vector{StepRule::kFourDirections, StepRule::kEightDirections}
                                         : std::vector{StepRule::kFourDirections};

class Accumulator {
 public:
  Accumulator() {
    dut_->rst_i = 1;
    dut_.clock();
    dut_->rst_i = 0;
  }

  void start(const ArcCommand& arc) {
    load(load_target::kDeviation, arc.deviation, 5);
    load(load_target::kGradientX, arc.gradient_x, 5);
    load(load_target::kGradientY, arc.gradient_y, 5);
    load(load_target::kHalfX, static_cast<std::int64_t>(arc.half_x), 3);
    load(load_target::kHalfY, static_cast<std::int64_t>(arc.half_y), 3);
    load(load_target::kEndX, arc.end_x, 2);
    load(load_target::kEndY, arc.end_y, 2);
    load(load_target::kQuadrants, arc.quadrants, 1);
    load(load_target::kPlane, (arc.clockwise ? 1 : 0) | (arc.eight_directions ? 2 : 0), 1);
    dut_->start_i = 1;
    dut_.clock();
    dut_->start_i = 0;
    for (int clock = arc.eight_directions ? 9 : 1; clock != 0; --clock) dut_.clock();
    period_ = arc.eight_directions ? 17 : 9;
    position_ = {0, 0};
  }

  bool at_end() { return dut_->ready_o && dut_->at_end_o; }

  // One tick, and the clocks until the next one.
  void tick() {
    dut_->tick_i = 1;
    for (int clock = 0; clock < period_; ++clock) {
      dut_.clock();
      dut_->tick_i = 0;
      if (dut_->step_x_o) position_.first += dut_->dir_x_o ? -1 : 1;
      if (dut_->step_y_o) position_.second += dut_->dir_y_o ? -1 : 1;
    }
  }

  const Point& position() const { return position_; }

 private:
  void load(unsigned target, const driver::Int128& value, int halfwords) {
    for (int i = 0; i < halfwords; ++i) {
      const auto word = static_cast<std::uint16_t>((value.bits() >> (16 * static_cast<unsigned>(i))).low());
      dut_->load_i = load_wire({true, static_cast<std::uint16_t>(target), word});
      dut_.clock();
    }
    dut_->load_i = 0;
  }

  Simulated<Vdut> dut_{kZeros};  // inputs that a test does not set are 0
  Point position_;
  int period_ = 9;  // clocks
};

// Walks and calls `see` at every point; false if the number of steps is not `steps`, or the end is wrong.
template <class See>
bool walk(Accumulator& accumulator, const ArcCommand& arc, std::uint64_t steps, const See& see) {
  accumulator.start(arc);
  for (std::uint64_t i = 0; i < steps; ++i) {
    if (accumulator.at_end()) return false;
    accumulator.tick();
    see(accumulator.position());
  }
  return accumulator.at_end() && accumulator.position() == Point(arc.end_x, arc.end_y);
}

// The points of the ellipse, rounded.
std::vector<Point> points(int a, int b) {
  std::set<Point> found;
  const int samples = 64 * (a + b);
  for (int i = 0; i < samples; ++i) {
    const double angle = 2 * kPi * i / samples;
    found.emplace(static_cast<int>(std::lround(a * std::cos(angle))),
                  static_cast<int>(std::lround(b * std::sin(angle))));
  }
  return {found.begin(), found.end()};
}

// The angle from start to end in the arc's direction; a full turn if both points are the same.
double sweep_between(const Point& start, const Point& end, bool clockwise) {
  double sweep = std::atan2(end.second, end.first) - std::atan2(start.second, start.first);
  if (clockwise) sweep = -sweep;
  return start == end || sweep <= 0 ? sweep + 2 * kPi : sweep;
}

TEST(EveryLine, TakesSteersSteps) {
  Accumulator accumulator;
  constexpr int kLongest = 24;
  int lines = 0;
  double worst = 0;
  for (int dx = -kLongest; dx <= kLongest; ++dx) {
    for (int dy = -kLongest; dy <= kLongest; ++dy) {
      if (dx == 0 || dy == 0) continue;
      ++lines;
      const int sx = dx > 0 ? 1 : -1;
      const int sy = dy > 0 ? 1 : -1;
      ArcCommand line;
      line.deviation = std::abs(dx) - std::abs(dy) - 1;
      line.gradient_x = -sx * std::abs(dy);
      line.gradient_y = sy * std::abs(dx);
      line.clockwise = sx * sy > 0;
      line.end_x = dx;
      line.end_y = dy;
      int f = std::abs(dx) - std::abs(dy);  // STEER's F, computed for comparison
      Point steer{0, 0};
      const auto see = [&](const Point& at) {
        const bool in_x = f > 0;
        f += in_x ? -std::abs(dy) : std::abs(dx);
        (in_x ? steer.first : steer.second) += in_x ? sx : sy;
        ASSERT_EQ(at, steer);
        worst = std::max(worst, std::abs(at.first * dy - at.second * dx) / std::hypot(dx, dy));
      };
      ASSERT_TRUE(walk(accumulator, line, static_cast<std::uint64_t>(std::abs(dx) + std::abs(dy)), see))
          << dx << ", " << dy;
      ASSERT_FALSE(HasFatalFailure()) << dx << ", " << dy;
    }
  }
  EXPECT_EQ(lines, 4 * kLongest * kLongest);
  EXPECT_LT(worst, 1);
  RecordProperty("lines", std::to_string(lines));
  RecordProperty("largest_distance", std::to_string(worst));
}

constexpr double kMinRadius = 1.5;  // pulses, for the driver's arcs in 4 directions

// Every arc between rounded points of a circle, with one rule.
void expect_arcs_of_circle(Accumulator& accumulator, int r, StepRule rule, int& arcs) {
  double worst = 0;
  const auto expect = [&](const Point& start, const Point& end, bool clockwise) {
    driver::ArcGeometry geometry;
    geometry.centre_x = -start.first * driver::kCentreUnitsPerPulse;
    geometry.centre_y = -start.second * driver::kCentreUnitsPerPulse;
    geometry.end_x = end.first - start.first;
    geometry.end_y = end.second - start.second;
    geometry.clockwise = clockwise;
    geometry.sweep = sweep_between(start, end, clockwise);
    const double first = std::hypot(start.first, start.second);
    const double second = std::hypot(end.first, end.second);
    // The driver refuses arcs that may come near the centre (arc.hpp); only r = 2 has such points.
    if (rule == StepRule::kFourDirections && first + second < 2 * kMinRadius) {
      EXPECT_EQ(r, 2);
      EXPECT_THROW(driver::prepare(geometry, rule), std::invalid_argument);
      return;
    }
    const ArcCommand arc = driver::prepare(geometry, rule);
    const auto see = [&](const Point& at) {
      const double radius = std::hypot(at.first + start.first, at.second + start.second);
      worst = std::max({worst, std::min(first, second) - radius, radius - std::max(first, second)});
    };
    ASSERT_TRUE(walk(accumulator, arc, arc.path_ticks, see))
        << "r " << r << " from " << start.first << ", " << start.second << " to " << end.first << ", " << end.second
        << " clockwise " << clockwise << " eight " << arc.eight_directions;
    ++arcs;
  };
  for (const Point& start : points(r, r)) {
    for (const Point& end : points(r, r)) {
      for (const bool clockwise : {false, true}) ASSERT_NO_FATAL_FAILURE(expect(start, end, clockwise));
    }
  }
  // The distance outside the ring between the radii of start and end.
  EXPECT_LE(worst, rule == StepRule::kEightDirections ? 0.6 : 1 + 0.3 / r) << "r " << r;
}

TEST(EveryArc, OfSmallCirclesStaysNearAndEnds) {
  Accumulator accumulator;
  constexpr int kLargest = 9;
  int arcs = 0;
  for (const StepRule rule : kRules) {
    for (int r = 2; r <= kLargest; ++r) ASSERT_NO_FATAL_FAILURE(expect_arcs_of_circle(accumulator, r, rule, arcs));
  }
  EXPECT_GT(arcs, 10000 * static_cast<int>(kRules.size()));
  RecordProperty("arcs", std::to_string(arcs));
}

// Every arc between rounded points of an ellipse, with one rule.
void expect_arcs_of_ellipse(Accumulator& accumulator, int a, int b, StepRule rule, int& arcs) {
  const auto expect = [&](const Point& start, const Point& end, bool clockwise) {
    driver::EllipseGeometry geometry;
    geometry.semi_x = a;
    geometry.semi_y = b;
    geometry.start_x = start.first;
    geometry.start_y = start.second;
    geometry.end_x = end.first - start.first;
    geometry.end_y = end.second - start.second;
    geometry.clockwise = clockwise;
    geometry.sweep = sweep_between(start, end, clockwise);
    const ArcCommand arc = driver::prepare(geometry, rule);
    // Never more than one pulse outside the bounding box (lemmas deviation_range and eight_directions).
    const auto see = [&](const Point& at) {
      ASSERT_LE(std::abs(at.first + start.first), a + 1);
      ASSERT_LE(std::abs(at.second + start.second), b + 1);
    };
    ASSERT_TRUE(walk(accumulator, arc, arc.path_ticks, see))
        << a << ", " << b << " from " << start.first << ", " << start.second << " to " << end.first << ", "
        << end.second << " clockwise " << clockwise << " eight " << arc.eight_directions;
    ++arcs;
  };
  for (const Point& start : points(a, b)) {
    for (const Point& end : points(a, b)) {
      for (const bool clockwise : {false, true}) ASSERT_NO_FATAL_FAILURE(expect(start, end, clockwise));
    }
  }
}

TEST(EveryArc, OfSmallEllipsesEnds) {
  Accumulator accumulator;
  constexpr int kLargest = 5;
  int arcs = 0;
  for (const StepRule rule : kRules) {
    const int smallest = rule == StepRule::kEightDirections ? 1 : 2;
    for (int a = smallest; a <= kLargest; ++a) {
      for (int b = smallest; b <= kLargest; ++b) {
        ASSERT_NO_FATAL_FAILURE(expect_arcs_of_ellipse(accumulator, a, b, rule, arcs));
      }
    }
  }
  EXPECT_GT(arcs, 10000 * static_cast<int>(kRules.size()));
  RecordProperty("arcs", std::to_string(arcs));
}

}  // namespace
}  // namespace trammel::lockstep
