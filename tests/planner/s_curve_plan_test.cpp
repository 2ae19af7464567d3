#include "trammel/planner/s_curve_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "counted_allocations.hpp"
#include "random.hpp"
#include "speed_plan_judge.hpp"
#include "trapezoid_plan.hpp"

namespace trammel::planner {
namespace {

using Spans = std::vector<Span>;
using test::Random;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr std::size_t kWindows[] = {1, 2, 16, 256, 16'384};

std::vector<Phase> plan(const Spans& spans, std::size_t window = 16'384) {
  SCurvePlan plan(window);
  return test::plan_all(plan, spans);
}

double seconds(const Spans& spans, std::size_t window = 16'384) { return test::duration_of(plan(spans, window)); }

struct Limits {
  double speed;
  double acceleration;
  double jerk;
};

Limits random_limits(Random& random) {
  return {random.logarithmic(5, 500), random.logarithmic(100, 10'000), random.logarithmic(1'000, 1e6)};
}

// Lengths over four decades, corners of any speed, stops; speeds that differ when told.
Spans moves(Random& random, const Limits& limits, bool speeds) {
  Spans spans;
  const std::size_t count = 1 + random.below(60);
  const std::size_t stops = 2 + random.below(12);
  for (std::size_t i = 0; i < count; ++i) {
    const double speed = speeds ? random.logarithmic(limits.speed / 50, limits.speed) : limits.speed;
    const std::size_t kind = random.below(4 * stops);
    const double exit = kind == 0 ? 0 : kind % 4 == 1 ? random.uniform(0, limits.speed) : kInfinite;
    spans.push_back({random.logarithmic(0.005, 50), speed, limits.acceleration, limits.jerk, exit});
  }
  return spans;
}

Spans with_limits(Random& random, Spans spans, double factor) {
  for (Span& span : spans) {
    span.acceleration *= random.logarithmic(1, factor);
    span.jerk *= random.logarithmic(1, factor);
  }
  return spans;
}

// Chords of a curve, corners by their centripetal limit; `noise` of the angles, as rounded ends have it.
Spans chords(Random& random, const Limits& limits, const std::function<double(double)>& curvature, double noise) {
  Spans spans;
  const double chord = random.below(2) == 0 ? 0.02 : random.logarithmic(0.02, 1);
  const double length = random.logarithmic(5, 200);
  for (double at = 0; at < length; at += chord) {
    const double angle = std::abs(curvature(at)) * chord * (1 + noise * random.uniform(-1, 1));
    const double exit = angle > 1e-12 ? std::sqrt(limits.acceleration * chord / angle) : kInfinite;
    spans.push_back({chord, limits.speed, limits.acceleration, limits.jerk, exit});
  }
  return spans;
}

Spans random_chords(Random& random, const Limits& limits) {
  const double radius = random.logarithmic(1, 50);
  const double noise = random.below(2) == 0 ? 0 : 1;
  switch (random.below(3)) {
    case 0:
      return chords(
          random, limits, [=](double) { return 1 / radius; }, noise);
    case 1:
      return chords(
          random, limits, [=](double at) { return 1 / (radius + std::sqrt(at)); }, noise);
    default:
      return chords(
          random, limits, [=](double at) { return std::sin(at / radius) / radius; }, noise);
  }
}

// One acceleration and jerk for all spans of a program.
Spans random_program(Random& random) {
  const Limits limits = random_limits(random);
  switch (random.below(3)) {
    case 0:
      return moves(random, limits, false);
    case 1:
      return moves(random, limits, true);
    default:
      return random_chords(random, limits);
  }
}

double lone_move(double length, const Limits& limits) {
  const double rise = limits.acceleration / limits.jerk;
  const auto ramp = [&](double speed) {
    return speed >= limits.acceleration * rise ? speed / limits.acceleration + rise
                                               : 2 * std::sqrt(speed / limits.jerk);
  };
  if (limits.speed * ramp(limits.speed) <= length) return length / limits.speed + ramp(limits.speed);
  if (length >= 2 * limits.acceleration * rise * rise) {  // v (v / a + a / j) = length
    const double top = (std::sqrt(rise * rise + 4 * length / limits.acceleration) - rise) * limits.acceleration / 2;
    return 2 * ramp(top);
  }
  return 4 * std::cbrt(length / (2 * limits.jerk));
}

TEST(SCurvePlan, LoneMovesTakeTheirClosedFormTime) {
  const Limits limits = {100, 1'000, 10'000};  // a rise takes 0.1 s, a ramp to full speed 0.2 s and 10 mm
  struct {
    double length;
    std::size_t phases;
  } const cases[] = {{100, 5}, {20, 4}, {15, 4}, {1, 4}, {1e-6, 4}, {1e4, 5}};
  for (const auto& lone : cases) {
    const std::vector<Phase> phases = plan({{lone.length, limits.speed, limits.acceleration, limits.jerk, 0}});
    EXPECT_EQ(phases.size(), lone.phases) << lone.length;
    EXPECT_NEAR(test::duration_of(phases) / lone_move(lone.length, limits), 1, 1e-9) << lone.length;
  }
  Random random(1);
  for (int i = 0; i < 10'000; ++i) {
    const Limits some = random_limits(random);
    const double length = random.logarithmic(1e-3, 1e3);
    const Spans spans = {{length, some.speed, some.acceleration, some.jerk, 0}};
    ASSERT_NEAR(seconds(spans) / lone_move(length, some), 1, 1e-9) << i;
  }
}

TEST(SCurvePlan, RandomProgramsKeepTheirLimits) {
  Random random(2);
  for (int i = 0; i < 600; ++i) {
    Spans spans = random_program(random);
    if (random.below(2) == 0) spans = with_limits(random, spans, random.below(2) == 0 ? 1.4 : 100);
    for (const std::size_t window : kWindows) {
      if (window < 256 && i % 4 != 0) continue;  // many plans
      ASSERT_EQ(test::fault_of(plan(spans, window), spans), "") << "program " << i << " window " << window;
    }
  }
}

TEST(SCurvePlan, TakesAtMostOneRiseMoreThanTheTrapezoidARamp) {
  Random random(3);
  for (int i = 0; i < 4'000; ++i) {
    const Spans spans = random_program(random);
    const test::Trapezoid best = test::trapezoid_of(spans);
    const double time = seconds(spans);
    ASSERT_GE(time, best.duration * (1 - 1e-9)) << i;
    ASSERT_LE(time, best.duration + best.bends) << i;
  }
}

// Limits at random. Few programs take longer than one rise a ramp more.
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
  EXPECT_LE(worst, 1.018);  // 1.0176
  RecordProperty("beyond", std::to_string(beyond));
  RecordProperty("worst", std::to_string(worst));
}

// Chords of a curve on two equal axes: the path has most where it goes at 45 degrees, so limits change all along.
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

// Arcs among straight spans; on them the acceleration is what the speed of the moment leaves.
Spans with_arcs(Random& random, const Limits& limits) {
  constexpr double kAlong = 0.43588989435406736;  // where 0.9 of it is across
  Spans spans = moves(random, limits, true);
  for (Span& span : spans) {
    if (random.below(3) == 0) continue;
    const double radius = random.logarithmic(0.5, 200);
    span.speed = std::min(span.speed, std::sqrt(0.9 * limits.acceleration * radius));
    const double across = span.speed * span.speed / radius;
    span.curve = {limits.acceleration, 1 / radius, limits.acceleration};
    span.acceleration = std::sqrt(limits.acceleration * limits.acceleration - across * across);
    span.jerk *= kAlong;
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

// Lines and arcs at one feed, which differ by rounding: length / (length / feed) is not always the feed.
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

TEST(SCurvePlan, ATrapezoidFailsItsJudge) {
  Random random(4);
  for (int i = 0; i < 300; ++i) {
    const Spans spans = random_program(random);
    const std::vector<Phase> phases = test::trapezoid_of(spans).phases;
    ASSERT_EQ(test::fault_of(phases, spans, true), "") << i;
    ASSERT_NE(test::fault_of(phases, spans).find("acceleration jumps"), std::string::npos) << i;
  }
}

TEST(SCurvePlan, ItsJudgeSeesEachLimit) {
  Random random(5);
  const Span span = {30, 100, 1'000, 10'000, 0};
  const std::vector<Phase> phases = plan({span, span, span});
  ASSERT_EQ(test::fault_of(phases, {span, span, span}), "");
  for (int i = 1; i < 4; ++i) {
    Span less = span;
    (i == 1 ? less.speed : i == 2 ? less.acceleration : less.jerk) *= 0.999;
    EXPECT_NE(test::fault_of(phases, {i == 1 ? span : less, less, span}), "") << i;
  }
  Span corner = span;
  corner.exit_speed = 99.9;
  const Span free = {30, 100, 1'000, 10'000, kInfinite};
  EXPECT_EQ(test::fault_of(plan({free, free}), {free, free}), "");
  EXPECT_NE(test::fault_of(plan({free, free}), {corner, free}), "");
  EXPECT_NE(test::fault_of(plan({free, free}), {free, free, free}), "");
}

TEST(SCurvePlan, OneRampSpansThousandsOfChords) {
  const Spans spans(5'000, {0.02, 300, 3'000, 100'000, kInfinite});
  const std::vector<Phase> phases = plan(spans);
  EXPECT_EQ(phases.size(), 7U);
  EXPECT_NEAR(test::duration_of(phases) / lone_move(100, {300, 3'000, 100'000}), 1, 1e-9);
}

TEST(SCurvePlan, NoAccelerationIsLostAtABorderInsideARamp) {
  const Span half = {5, 100, 1'000, 10'000, kInfinite};
  const std::vector<Phase> whole = plan({{10, 100, 1'000, 10'000, 0}});
  const std::vector<Phase> halves = plan({half, half});
  ASSERT_EQ(halves.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_NEAR(halves[i].length, whole[i].length, 1e-9);
  const Span quarter = {2.5, 100, 1'000, 10'000, kInfinite};
  EXPECT_NEAR(seconds({quarter, quarter, quarter, quarter}), test::duration_of(whole), 1e-9);
}

TEST(SCurvePlan, NoiseOfCornersCostsNoRamps) {
  Spans spans(5'000, {0.02, 300, 3'000, 100'000, 54.77});
  for (std::size_t i = 0; i < spans.size(); i += 3) spans[i].exit_speed *= 1.0001;
  EXPECT_LE(plan(spans).size(), 7U);
}

TEST(SCurvePlan, WithoutALimitOfJerkItIsATrapezoid) {
  Random random(6);
  for (int i = 0; i < 500; ++i) {
    Spans spans = moves(random, random_limits(random), true);
    for (Span& span : spans) span.jerk = kInfinite;
    const std::vector<Phase> phases = plan(spans);
    ASSERT_EQ(test::fault_of(phases, spans, true), "") << i;
    // Peaks of less than 1/256 are left out.
    ASSERT_NEAR(test::duration_of(phases) / test::trapezoid_of(spans).duration, 1, 1.0 / 256) << i;
  }
}

TEST(SCurvePlan, LongerWindowsAreNotSlower) {
  const Spans spans(5'000, {0.02, 300, 3'000, 100'000, kInfinite});
  const double whole = seconds(spans);
  double before = kInfinite;
  for (const std::size_t window : {16U, 64U, 256U, 1'024U, 4'096U}) {
    const double time = seconds(spans, window);
    EXPECT_LT(time, before) << window;
    before = time;
  }
  EXPECT_LT(before, whole * 1.001);
}

// A window that is some stopping distances long takes the time of the whole path, and stops nowhere.
TEST(SCurvePlan, AWindowOfSomeStoppingDistancesIsEnough) {
  Spans spans;
  for (int i = 0; i < 20'000; ++i) {
    const double corner = 150 + 120 * std::sin(i * 0.001) + (i % 7);
    spans.push_back({0.02, 300, 3'000, 100'000, corner});
  }
  const std::vector<Phase> phases = plan(spans, 4'096);
  EXPECT_NEAR(test::duration_of(phases) / seconds(spans, 20'000), 1, 1e-3);
  for (std::size_t i = 2; i < phases.size(); ++i) EXPECT_GT(phases[i].speed + (i + 1 == phases.size()) * 10, 10) << i;
  EXPECT_EQ(std::count_if(phases.begin(), phases.end(), [](const Phase& phase) { return phase.short_sight; }), 0);
}

// A host that is told to stop throws there: a window may have thousands of ramps.
TEST(SCurvePlan, CallsBeforeEachRamp) {
  Random random(7);
  const Spans spans = moves(random, {100, 1'000, 1e5}, true);
  std::uint64_t calls = 0;
  SCurvePlan whole(1'000, [&] { ++calls; });
  test::plan_all(whole, spans);
  EXPECT_EQ(calls, whole.work().ramps);
  EXPECT_GT(calls, spans.size());
  std::uint64_t left = calls / 2;
  SCurvePlan stopped(1'000, [&] {
    if (--left == 0) throw std::runtime_error("stop");
  });
  EXPECT_THROW(test::plan_all(stopped, spans), std::runtime_error);
  EXPECT_EQ(left, 0U);
}

TEST(SCurvePlan, IsAFunctionOfTheSpansAlone) {
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const Spans spans = random_program(random);
    const std::vector<Phase> wanted = plan(spans, 16);
    SCurvePlan other(16);
    std::vector<Phase> phases;
    Phase phase;
    for (const Span& span : spans) {
      while (other.full()) {
        ASSERT_TRUE(other.next(phase));
        phases.push_back(phase);
      }
      if (random.below(3) == 0 && other.next(phase)) phases.push_back(phase);
      other.push(span);
    }
    other.finish();
    while (other.next(phase)) phases.push_back(phase);
    ASSERT_EQ(phases.size(), wanted.size());
    for (std::size_t k = 0; k < phases.size(); ++k) {
      ASSERT_EQ(phases[k].duration, wanted[k].duration);
      ASSERT_EQ(phases[k].length, wanted[k].length);
    }
  }
}

TEST(SCurvePlan, AfterAStopItBeginsFromRest) {
  const Span span = {30, 100, 1'000, 10'000, kInfinite};
  SCurvePlan plan(4);
  const std::vector<Phase> first = test::plan_all(plan, {span});
  const std::vector<Phase> second = test::plan_all(plan, {span});
  ASSERT_EQ(first.size(), second.size());
  EXPECT_EQ(test::fault_of(first, {span}), "");
  EXPECT_EQ(test::fault_of(second, {span}), "");
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].stop, i + 1 == first.size());
}

TEST(SCurvePlan, AStopInMidPathIsNotOneThatFinishAskedFor) {
  const Span span = {30, 100, 1'000, 10'000, 0};
  const std::vector<Phase> phases = plan({span, span});
  EXPECT_EQ(std::count_if(phases.begin(), phases.end(), [](const Phase& phase) { return phase.stop; }), 1);
  EXPECT_TRUE(phases.back().stop);
}

// Stops in mid path, or all but.
std::size_t stops_of(const std::vector<Phase>& phases) {
  constexpr double kRest = 1e-3;  // mm/s
  std::size_t stops = 0;
  for (std::size_t i = 1; i < phases.size(); ++i) stops += phases[i].speed < kRest ? 1U : 0U;
  return stops;
}

// Where a trapezoid with that window does not stop either. Of spans whose lengths differ by four decades a window of
// 16 may show too little for that.
TEST(SCurvePlan, AShortWindowOnlySlows) {
  Random random(12);
  std::size_t slowed = 0;
  for (int i = 0; i < 120; ++i) {
    Spans spans =
        i % 4 == 0 ? moves(random, random_limits(random), true) : random_chords(random, random_limits(random));
    if (i % 3 == 1) spans = with_limits(random, spans, 1.4);
    for (const std::size_t window : {2U, 16U, 256U}) {
      if (i % 4 == 0 && window != 256) continue;
      TrapezoidPlan trapezoid(window);
      const std::vector<Phase> phases = plan(spans, window);
      ASSERT_EQ(stops_of(phases), stops_of(test::plan_all(trapezoid, spans))) << i << " window " << window;
      slowed +=
          std::any_of(phases.begin(), phases.end(), [](const Phase& phase) { return phase.short_sight; }) ? 1U : 0U;
    }
  }
  EXPECT_GT(slowed, 40U);
}

TEST(SCurvePlan, SaysWhereTheWindowIsTooShort) {
  const Spans spans(2'000, {0.02, 300, 3'000, 100'000, kInfinite});
  const auto short_sighted = [&](std::size_t window) {
    const std::vector<Phase> phases = plan(spans, window);
    return std::count_if(phases.begin(), phases.end(), [](const Phase& phase) { return phase.short_sight; });
  };
  EXPECT_GT(short_sighted(16), 0);
  EXPECT_EQ(short_sighted(16'384), 0);
}

TEST(SCurvePlan, AllocatesNothingASpan) {
  Random random(8);
  Spans spans;
  while (spans.size() < 20'000) {
    const Spans more = random_program(random);
    spans.insert(spans.end(), more.begin(), more.end());
  }
  SCurvePlan plan(256);
  Phase phase;
  std::size_t phases = 0;
  const std::size_t before = test::allocations();
  for (const Span& span : spans) {
    while (plan.full() && plan.next(phase)) ++phases;
    plan.push(span);
  }
  plan.finish();
  while (plan.next(phase)) ++phases;
  EXPECT_EQ(test::allocations(), before);
  EXPECT_GT(phases, 1'000U);
}

}  // namespace
}  // namespace trammel::planner
