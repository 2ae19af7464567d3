// Random programs for the S-curve plan, and their plans.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "random.hpp"
#include "speed_plan_judge.hpp"
#include "trammel/planner/s_curve_plan.hpp"

namespace trammel::test {

using Spans = std::vector<Span>;

inline constexpr double kInfinite = std::numeric_limits<double>::infinity();

inline std::vector<Phase> plan(const Spans& spans, std::size_t window = 16'384) {
  planner::SCurvePlan plan(window);
  return plan_all(plan, spans);
}

inline double seconds(const Spans& spans, std::size_t window = 16'384) { return duration_of(plan(spans, window)); }

struct Limits {
  double speed;
  double acceleration;
  double jerk;
};

inline Limits random_limits(Random& random) {
  return {random.logarithmic(5, 500), random.logarithmic(100, 10'000), random.logarithmic(1'000, 1e6)};
}

// Lengths over four decades, corners of any speed, and stops; different speeds if `speeds` is set.
inline Spans moves(Random& random, const Limits& limits, bool speeds) {
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

inline Spans with_limits(Random& random, Spans spans, double factor) {
  for (Span& span : spans) {
    span.acceleration *= random.logarithmic(1, factor);
    span.jerk *= random.logarithmic(1, factor);
  }
  return spans;
}

// Chords of a curve, with corner speeds by the centripetal limit. `noise`: relative error of the angles, as rounded
// ends cause it.
inline Spans chords(Random& random, const Limits& limits, const std::function<double(double)>& curvature,
                    double noise) {
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

inline Spans random_chords(Random& random, const Limits& limits) {
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

// A program with one acceleration and jerk for all its spans.
inline Spans random_program(Random& random) {
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

}  // namespace trammel::test
