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
#include "s_curve_programs.hpp"
#include "trapezoid_plan.hpp"

namespace trammel::planner {
namespace {

using test::chords;
using test::kInfinite;
using test::Limits;
using test::moves;
using test::plan;
using test::Random;
using test::random_chords;
using test::random_limits;
using test::random_program;
using test::seconds;
using test::Spans;
using test::with_limits;

constexpr std::size_t kWindows[] = {1, 2, 16, 256, 16'384};

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

// A plan with a window of several stopping distances takes the time of a plan over the whole path, and never stops.
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

// A host that must stop throws in this call. A window may have thousands of ramps, so one call per window is too few.
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

// Number of phases in mid path that begin at rest or nearly at rest.
std::size_t stops_of(const std::vector<Phase>& phases) {
  constexpr double kRest = 1e-3;  // mm/s
  std::size_t stops = 0;
  for (std::size_t i = 1; i < phases.size(); ++i) stops += phases[i].speed < kRest ? 1U : 0U;
  return stops;
}

// The plan stops only where a trapezoid plan with the same window stops. If lengths of spans differ by four decades, a
// window of 16 may be too short for this rule.
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
