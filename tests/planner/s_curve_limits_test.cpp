// The S-curve plan with limits that differ from span to span: at random, on curves, on arcs, by rounding.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "s_curve_programs.hpp"
#include "trapezoid_plan.hpp"

namespace trammel::planner {
namespace {

using test::kInfinite;
using test::Limits;
using test::moves;
using test::plan;
using test::Random;
using test::random_limits;
using test::random_program;
using test::seconds;
using test::Spans;
using test::with_limits;

// Random limits. Few programs take longer than the trapezoid plus one rise of acceleration per ramp.
TEST(SCurvePlan, LimitsThatDifferCostLittleMore) {
  Random random(9);
  int beyond = 0;
  double worst = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Spans spans = with_limits(random, moves(random, random_limits(random), true), i % 2 == 0 ? 1.4 : 100);
    const test::Trapezoid best = test::trapezoid_of(spans);
    const double time = seconds(spans);
    ASSERT_GE(time, best.duration * (1 - 1e-9)) << i;
    const double share = (time - best.bends) / best.duration;
    beyond += share > 1 ? 1 : 0;
    worst = std::max(worst, share);
  }
  EXPECT_LE(beyond, 4);     // measured: 4
  EXPECT_LE(worst, 1.018);  // measured: 1.0176
  RecordProperty("beyond", std::to_string(beyond));
  RecordProperty("worst", std::to_string(worst));
}

// Chords of a curve on two equal axes. The limits along the path are largest at 45 degrees, so they change all along
// the curve.
Spans turning_chords(Random& random, const Limits& limits) {
  Spans spans;
  const double radius = random.logarithmic(1, 200);
  const double chord = random.logarithmic(0.02, 1);
  const double length = random.logarithmic(5, 200);
  const std::size_t kind = random.below(3);
  double heading = random.uniform(0, 6.28);
  for (double at = 0; at < length; at += chord) {
    const double curvature = (kind == 0 ? 1 : std::sin(kind == 1 ? at / radius : at)) / radius;
    heading += curvature * chord;
    const double share = std::max(std::abs(std::cos(heading)), std::abs(std::sin(heading)));
    const double angle = std::abs(curvature * chord);
    const double exit = angle > 1e-12 ? std::sqrt(limits.acceleration / share * chord / angle) : kInfinite;
    spans.push_back({chord, limits.speed / share, limits.acceleration / share, limits.jerk / share, exit});
  }
  return spans;
}

TEST(SCurvePlan, LimitsThatTurnCostAtMostOneRiseARamp) {
  Random random(11);
  int beyond = 0;
  double worst = 0;
  for (int i = 0; i < 2'000; ++i) {
    const Limits limits = random_limits(random);
    const Spans spans = turning_chords(random, limits);
    const std::vector<Phase> phases = plan(spans);
    ASSERT_EQ(test::fault_of(phases, spans), "") << i;
    const test::Trapezoid best = test::trapezoid_of(spans);
    const double time = test::duration_of(phases);
    ASSERT_GE(time, best.duration * (1 - 1e-9)) << i;
    const double share = (time - best.bends) / best.duration;
    beyond += share > 1 ? 1 : 0;
    worst = std::max(worst, share);
  }
  EXPECT_EQ(beyond, 0);
  EXPECT_LE(worst, 1);
  RecordProperty("beyond", std::to_string(beyond));
  RecordProperty("worst", std::to_string(worst));
}

// Arcs among straight spans. On an arc the acceleration is limited to the part that the present speed leaves.
Spans with_arcs(Random& random, const Limits& limits) {
  Spans spans = moves(random, limits, true);
  for (Span& span : spans) {
    if (random.below(3) == 0) continue;
    const double radius = random.logarithmic(0.5, 200);
    span.speed = std::min(
        {span.speed, std::sqrt(0.995 * limits.acceleration * radius), std::cbrt(0.8 * span.jerk * radius * radius)});
    span.curve = {limits.acceleration, 1 / radius, limits.acceleration, span.jerk, span.jerk};
    span.acceleration = span.curve.along(span.speed);
    span.jerk = span.curve.least_jerk(span.speed);
  }
  return spans;
}

TEST(SCurvePlan, ArcsUseTheirAccelerationAtEverySpeed) {
  Random random(13);
  double best = 1;
  double worst = 0;
  for (int i = 0; i < 600; ++i) {
    const Spans spans = with_arcs(random, random_limits(random));
    Spans as_at_top = spans;
    for (Span& span : as_at_top) span.curve = {};
    for (const std::size_t window : {16U, 16'384U}) {
      const std::vector<Phase> phases = plan(spans, window);
      ASSERT_EQ(test::fault_of(phases, spans), "") << i << " window " << window;
      if (window == 16) continue;
      TrapezoidPlan trapezoid(window);
      const double time = test::duration_of(phases);
      ASSERT_GE(time, test::duration_of(test::plan_all(trapezoid, spans)) * (1 - 1e-9)) << i;
      const double share = time / seconds(as_at_top, window);
      best = std::min(best, share);
      worst = std::max(worst, share);
    }
  }
  EXPECT_LE(best, 0.9);
  EXPECT_LE(worst, 1.001);
  RecordProperty("best", std::to_string(best));
  RecordProperty("worst", std::to_string(worst));
}

// The least time on an arc. At each moment the jerk along the path is the part that v^3 / r^2 and 3 v a / r leave, and
// the acceleration is the part that v^2 / r leaves. Integrates in small steps of time.
class LeastOnArc {
 public:
  LeastOnArc(double radius, double acceleration, double jerk)
      : radius_(radius), acceleration_(acceleration), jerk_(jerk) {}

  // A ramp from rest to a speed, with an acceleration of 0 at both ends.
  struct Ramp {
    double seconds = 0;
    double length = 0;
  };
  Ramp ramp(double top, double step) const {
    std::vector<State> fall{{top, 0}};  // backwards from the top speed
    while (fall.back().speed > 0) fall.push_back(moved(fall.back(), step, -1));
    Ramp ramp;
    State now{0, 0};
    while (!fall.empty()) {
      while (!fall.empty() && fall.back().speed < now.speed) fall.pop_back();
      if (!fall.empty() && now.acceleration >= fall.back().acceleration) break;
      ramp.seconds += step;
      ramp.length += now.speed * step;
      now = moved(now, step, 1);
    }
    for (const State& state : fall) ramp.length += state.speed * step;
    ramp.seconds += static_cast<double>(fall.size()) * step;
    return ramp;
  }

 private:
  struct State {
    double speed;
    double acceleration;
  };
  State moved(const State& from, double step, int direction) const {
    const double turn = from.speed / radius_;
    const double swung = std::min(jerk_, 3 * turn * from.acceleration);
    const double turned = turn * turn * from.speed;
    const double jerk = std::max(0.0, std::sqrt(jerk_ * jerk_ - swung * swung) - turned);
    const double across = turn * from.speed;
    const double left = std::sqrt(std::max(0.0, acceleration_ * acceleration_ - across * across));
    // Largest acceleration; at its second bound no jerk along the path is left.
    const double most = std::min(left, std::sqrt(std::max(0.0, jerk_ * jerk_ - turned * turned)) / (3 * turn));
    const double acceleration = std::min(from.acceleration + jerk * step, most);
    return {from.speed + direction * (from.acceleration + acceleration) / 2 * step, acceleration};
  }

  double radius_;
  double acceleration_;
  double jerk_;
};

TEST(SCurvePlan, RampsOnArcsTakeLittleMoreThanEachMomentAllows) {
  constexpr double kAcceleration = 1000;
  double worst = 0;
  for (const double jerk : {20'000.0, 50'000.0, 200'000.0}) {
    for (const double radius : {0.5, 1.0, 3.0, 10.0, 50.0}) {
      const double top = std::min(std::sqrt(0.995 * kAcceleration * radius), std::cbrt(0.8 * jerk * radius * radius));
      const double step = kAcceleration / jerk / 2000;
      const LeastOnArc::Ramp least = LeastOnArc(radius, kAcceleration, jerk).ramp(top, step);
      Span arc;
      arc.length = 2.6 * least.length;
      arc.speed = top;
      arc.curve = {kAcceleration, 1 / radius, kAcceleration, jerk, jerk};
      arc.acceleration = arc.curve.along(top);
      arc.jerk = arc.curve.least_jerk(top);
      const double wanted = 2 * least.seconds + 0.6 * least.length / top;
      const double share = seconds({arc}) / wanted;
      EXPECT_GE(share, 0.999) << "jerk " << jerk << ", R " << radius;
      worst = std::max(worst, share);
    }
  }
  EXPECT_LE(worst, 1.09);  // measured: 1.0868, where the jerk alone is the limit; 1.033 at R 10
  RecordProperty("worst", std::to_string(worst));
}

// Lines and arcs at one feed. Their speeds differ by rounding, because length / (length / feed) is not always the feed.
Spans at_one_feed(Random& random, const Limits& limits) {
  Spans spans;
  for (std::size_t i = 4 + random.below(20); i > 0; --i) {
    const double speed = limits.speed * (1 - static_cast<double>(random.below(4)) * 0x1p-53);
    const double exit = random.below(2) == 0 ? kInfinite : random.uniform(0, limits.speed);
    const double share = random.uniform(0.5, 1);
    spans.push_back({random.logarithmic(0.5, 100), speed, limits.acceleration * share, limits.jerk * share, exit});
    if (random.below(3) != 0) continue;
    Span& arc = spans.back();
    const double across = random.uniform(0, 0.9) * limits.acceleration;
    arc.curve = {limits.acceleration, across / (speed * speed), limits.acceleration};
    arc.acceleration = std::sqrt(limits.acceleration * limits.acceleration - across * across);
  }
  return spans;
}

TEST(SCurvePlan, SpeedsThatDifferByRoundingMakeNoRamps) {
  Random random(14);
  for (int i = 0; i < 1'000; ++i) {
    const Spans spans = at_one_feed(random, random_limits(random));
    for (const std::size_t window : {16U, 16'384U}) {
      ASSERT_EQ(test::fault_of(plan(spans, window), spans), "") << "program " << i << " window " << window;
    }
  }
}

}  // namespace
}  // namespace trammel::planner
