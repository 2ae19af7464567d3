// The comparison of the real methods: the table for the lines of the second paper, properties that every method must
// have, and random lines.
#include "trammel/measure/comparison.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "paper_lines.hpp"

namespace trammel::measure {
namespace {

using interpolation::Curve;
using interpolation::Line;
using interpolation::make_circle;
using interpolation::make_ellipse;
using interpolation::make_line;
using interpolation::Method;

MethodMeasures measures_of(Method method, const Curve& curve) {
  Trace trace;
  record(method, curve, {}, trace);
  return measure_method(method, trace, ideal_of(curve));
}

TEST(Comparison, SecondPapersLinesToThreeDecimals) {
  for (const interpolation::PaperLine& paper : interpolation::kPaperLines) {
    for (std::size_t m = 0; m < paper.errors.size(); ++m) {
      const MethodMeasures measures = measures_of(interpolation::kPaperMethods[m], paper.line());
      EXPECT_NEAR(measures.distances.perpendicular.largest, paper.errors[m], 5e-4);
    }
    EXPECT_EQ(measures_of(Method::kSteer, paper.line()).steps, paper.steer_steps);
  }
}

TEST(Comparison, OperationsOfFigure5) {
  const Line line = interpolation::kPaperLines[0].line();
  EXPECT_EQ(measures_of(Method::kPointByPoint, line).cost.operations, 60U);
  EXPECT_EQ(measures_of(Method::kOneShot, line).cost.operations, 1U);
  // 19 words from FREQUENCY_LO[3] to START: 4 words for each of 4 axes, LENGTH and START.
  EXPECT_EQ(measures_of(Method::kOneShot, line).cost.register_writes, 19U);
  // 64 iterations: the smallest power of two above 40.
  EXPECT_EQ(measures_of(Method::kDda, line).cost.operations, 64U);
}

TEST(Comparison, WhatTheCardRunsCostsItsBlock) {
  const Curve circle = make_circle(25);
  // 38 and 33 halfwords, according to docs/reference/commands.md.
  EXPECT_EQ(measures_of(Method::kSteer, circle).cost.operations, 1U);
  EXPECT_EQ(measures_of(Method::kRotation, circle).cost.operations, 1U);
  EXPECT_EQ(measures_of(Method::kMinDeviation8, circle).cost.operations, 1U);
  EXPECT_EQ(measures_of(Method::kSteer, circle).cost.register_writes, 19U);
  EXPECT_EQ(measures_of(Method::kRotation, circle).cost.register_writes, 17U);
  // On the host the same rule walks lines, and a DDA walks circles.
  EXPECT_EQ(measures_of(Method::kSteer, make_line({0, 0}, {20, 40})).cost.operations, 60U);
  EXPECT_GT(measures_of(Method::kDda, circle).cost.operations, 200U);
}

TEST(Comparison, EveryMethodThatCanDoACurveEndsOnIt) {
  const std::vector<Curve> curves = {make_line({3, -4}, {-50, 21}), make_circle(25), make_circle(25, true),
                                     make_ellipse(40, 25, true)};
  const std::vector<std::size_t> able = {9, 5, 5, 2};
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::vector<Method> methods = methods_for(curves[i]);
    EXPECT_EQ(methods.size(), able[i]);
    for (const Method method : methods) {
      Trace trace;
      record(method, curves[i], {}, trace);
      TracePosition position = trace.start();
      for (const Event& event : trace.events()) {
        for (std::size_t a = 0; a < 2; ++a) position[a] += event.direction[a];
      }
      const Vector end = ideal_of(curves[i]).at(1);
      EXPECT_NEAR(static_cast<double>(position[0]), end[0], 1e-9) << interpolation::info(method).name;
      EXPECT_NEAR(static_cast<double>(position[1]), end[1], 1e-9) << interpolation::info(method).name;
      const MethodMeasures measures = measure_method(method, trace, ideal_of(curves[i]));
      // A differential analyser integrates forwards: on a circle it drifts outwards by some pulses per turn. Dividers
      // deviate too.
      const bool analyser = i > 0 && (method == Method::kDda || method == Method::kDdaHalf);
      const bool strays = analyser || method == Method::kDivider;
      EXPECT_LT(measures.distances.perpendicular.largest, strays ? 6 : 1.01) << interpolation::info(method).name;
    }
  }
}

TEST(Comparison, OneShotIsEvenToAClockAndSteerIsNot) {
  const Line line = make_line({0, 0}, {53, 31});
  const MethodMeasures one_shot = measures_of(Method::kOneShot, line);
  // An interval is a whole number of clocks and differs from its mean by less than one clock, which is p / L of it.
  EXPECT_LT(one_shot.evenness[0].largest, 53.0 / 2000);
  EXPECT_LT(one_shot.evenness[1].largest, 31.0 / 2000);
  EXPECT_LT(one_shot.ripple.largest, 0.05);
  // On each axis within half a pulse of the running point in every clock: the theorem of the card's pulse generator.
  EXPECT_LE(one_shot.distances.axis[0].largest, 0.5);
  EXPECT_LE(one_shot.distances.axis[1].largest, 0.5);
  // The x intervals of STEER are one or two steps; an even interval would be 84/53.
  const MethodMeasures steer = measures_of(Method::kSteer, line);
  EXPECT_NEAR(steer.evenness[0].largest, 1 - 53.0 / 84, 1e-9);
  EXPECT_GT(highest_line(steer.spectrum[0]).amplitude, 0.1);
  EXPECT_LT(highest_line(one_shot.spectrum[0]).amplitude, 0.02);
}

TEST(Comparison, LineAndArcPulsesAreKnownBefore) {
  EXPECT_EQ(pulses_along(make_line({0, 0}, {20, -40})), 60U);
  EXPECT_EQ(pulses_along(make_circle(25)), 200U);
  EXPECT_EQ(pulses_along(make_ellipse(40, 25)), 260U);
}

RandomLines some_lines(std::uint64_t count) {
  RandomLines lines;
  lines.count = count;
  lines.seed = 7;
  return lines;
}

TEST(RandomLinesTest, KeepTheirBounds) {
  const std::vector<RandomMeasures> all = measure_random_lines(some_lines(3000));
  ASSERT_EQ(all.size(), 9U);
  for (const RandomMeasures& measures : all) {
    const auto name = interpolation::info(measures.method).name;
    EXPECT_EQ(measures.wrong_ends, 0U) << name;
    EXPECT_GT(measures.mean_perpendicular, 0) << name;
    EXPECT_LE(measures.mean_perpendicular, measures.largest_perpendicular) << name;
    EXPECT_GE(measures.largest_horizontal, measures.largest_perpendicular) << name;
    switch (measures.method) {
      case Method::kMinDeviation8:
        EXPECT_LE(measures.largest_perpendicular, 0.5);
        break;
      case Method::kOneShot:
        EXPECT_LE(measures.largest_perpendicular, std::sqrt(0.5) + 1e-9);
        EXPECT_LE(measures.largest_axis, 0.5 + 1e-9);
        EXPECT_EQ(measures.mean_operations, 1);
        break;
      case Method::kSteer:
      case Method::kPointByPoint:
      case Method::kMinF4:
        EXPECT_LT(measures.largest_perpendicular, 1) << name;
        break;
      default:
        break;
    }
  }
}

TEST(RandomLinesTest, DoNotDependOnTheThreads) {
  RandomLines lines = some_lines(1500);
  lines.threads = 1;
  const std::vector<RandomMeasures> one = measure_random_lines(lines);
  lines.threads = 5;
  const std::vector<RandomMeasures> five = measure_random_lines(lines);
  ASSERT_EQ(one.size(), five.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].mean_perpendicular, five[i].mean_perpendicular);
    EXPECT_EQ(one[i].mean_rms_ripple, five[i].mean_rms_ripple);
    EXPECT_EQ(one[i].mean_steps, five[i].mean_steps);
    EXPECT_EQ(one[i].worst_line.end, five[i].worst_line.end);
  }
}

TEST(RandomLinesTest, AgreeWithASingleLineMeasuredAlone) {
  RandomLines lines = some_lines(1);
  const Line line = random_line(lines, 0);
  for (const RandomMeasures& random : measure_random_lines(lines)) {
    const MethodMeasures alone = measures_of(random.method, line);
    EXPECT_EQ(random.largest_perpendicular, alone.distances.perpendicular.largest);
    EXPECT_EQ(random.mean_rms_ripple, alone.ripple.rms);
    EXPECT_EQ(random.mean_operations, static_cast<double>(alone.cost.operations));
  }
}

TEST(RandomLinesTest, CoverAllDirectionsWithinTheLargest) {
  RandomLines lines = some_lines(1);
  lines.largest = 3;
  std::array<std::array<int, 7>, 7> seen{};
  for (std::uint64_t i = 0; i < 5000; ++i) {
    const Line line = random_line(lines, i);
    ++seen.at(static_cast<std::size_t>(line.end[0] + 3)).at(static_cast<std::size_t>(line.end[1] + 3));
  }
  for (std::size_t x = 0; x < 7; ++x) {
    for (std::size_t y = 0; y < 7; ++y) {
      if (x == 3 && y == 3) {
        EXPECT_EQ(seen[x][y], 0);
      } else {
        EXPECT_NEAR(seen[x][y], 5000.0 / 48, 60);
      }
    }
  }
}

TEST(RandomLinesTest, RefuseALineFasterThanTheClock) {
  RandomLines lines = some_lines(10);
  lines.largest = 2001;  // 2,000 clocks per line
  EXPECT_THROW(measure_random_lines(lines), std::invalid_argument);
}

}  // namespace
}  // namespace trammel::measure
