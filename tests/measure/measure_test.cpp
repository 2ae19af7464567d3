// The measures against traces with results that are known by hand or in closed form.
#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "trammel/measure/cost.hpp"
#include "trammel/measure/distance.hpp"
#include "trammel/measure/evenness.hpp"
#include "trammel/measure/ideal_curve.hpp"
#include "trammel/measure/trace.hpp"

namespace trammel::measure {
namespace {

constexpr double kTurn = 6.283185307179586476925;

struct Pulse {
  std::uint64_t time;
  Directions direction;
};

Trace trace_of(std::size_t axes, std::uint64_t total, const std::vector<Pulse>& pulses, TracePosition start = {}) {
  Trace trace;
  trace.clear(axes, start);
  for (const Pulse& pulse : pulses) trace.add(pulse.time, pulse.direction);
  trace.finish(total);
  return trace;
}

// (0,0) to (2,1): y at 1, then x at 2 and 3, in 3 time units.
Trace small_line() { return trace_of(2, 3, {{1, {0, 1}}, {2, {1, 0}}, {3, {1, 0}}}); }

TEST(Trace, KnowsTheTimesOfEachAxis) {
  const Trace trace = trace_of(2, 4, {{1, {1, -1}}, {3, {0, -1}}, {4, {1, 0}}});
  EXPECT_EQ(pulses_of(trace), 4U);
  EXPECT_THAT(trace.times(0), testing::ElementsAre(1, 4));
  EXPECT_THAT(trace.times(1), testing::ElementsAre(1, 3));
}

TEST(Distance, OfALineByHand) {
  const IdealCurve curve = IdealCurve::line(2, {}, {2, 1});
  const Distances distances = measure_distances(small_line(), curve);
  // Visited: (0,1), (1,1), (2,1); |x - 2 y| / sqrt(5) = 2, 1, 0 over sqrt(5).
  EXPECT_NEAR(distances.perpendicular.largest, 2 / std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(distances.perpendicular.mean, 1 / std::sqrt(5.0), 1e-12);
  ASSERT_TRUE(distances.horizontal.has_value());
  EXPECT_NEAR(distances.horizontal->largest, 2, 1e-12);
  EXPECT_NEAR(distances.horizontal->mean, 1, 1e-12);
  // After one of three units x is at 0 and the running point at 2/3; y is at 1 and the running point at 1/3.
  EXPECT_NEAR(distances.axis[0].largest, 2.0 / 3, 1e-12);
  EXPECT_NEAR(distances.axis[1].largest, 2.0 / 3, 1e-12);
  EXPECT_NEAR(distances.axis[0].mean, (2.0 / 3 + 1.0 / 3 + 0) / 3, 1e-12);
}

TEST(Distance, TwoAxesAgreeWithTheGeneralFormula) {
  // The same line with a third axis at rest uses the general code.
  const Distances plane = measure_distances(small_line(), IdealCurve::line(2, {}, {2, 1}));
  Trace trace = trace_of(3, 3, {{1, {0, 1}}, {2, {1, 0}}, {3, {1, 0}}});
  const Distances space = measure_distances(trace, IdealCurve::line(3, {}, {2, 1, 0}));
  EXPECT_NEAR(plane.perpendicular.largest, space.perpendicular.largest, 1e-12);
  EXPECT_NEAR(plane.perpendicular.mean, space.perpendicular.mean, 1e-12);
  for (std::size_t a = 0; a < 2; ++a) {
    EXPECT_NEAR(plane.axis[a].largest, space.axis[a].largest, 1e-12);
    EXPECT_NEAR(plane.axis[a].mean, space.axis[a].mean, 1e-12);
  }
  EXPECT_FALSE(space.horizontal.has_value());
}

TEST(Distance, NoHorizontalOneAlongX) {
  const Trace trace = trace_of(2, 2, {{1, {1, 0}}, {2, {1, 0}}});
  EXPECT_FALSE(measure_distances(trace, IdealCurve::line(2, {}, {2, 0})).horizontal.has_value());
}

TEST(Distance, OfAnArcIsOutsideTheAnnulusOfItsEnds) {
  RoundShape shape;
  shape.a = shape.b = 5;
  shape.start = {5, 0};
  shape.end = {0, 4};
  const IdealCurve curve = IdealCurve::round(shape);
  EXPECT_NEAR(curve.distance({0, 3, 0, 0}), 1, 1e-12);
  EXPECT_NEAR(curve.distance({3, 3, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(curve.distance({6, 0, 0, 0}), 1, 1e-12);
}

TEST(Distance, ToAnEllipse) {
  EXPECT_NEAR(distance_to_ellipse(0, 0, 5, 2), 2, 1e-9);
  EXPECT_NEAR(distance_to_ellipse(7, 0, 5, 2), 2, 1e-9);
  EXPECT_NEAR(distance_to_ellipse(0, -5, 5, 2), 3, 1e-9);
  EXPECT_NEAR(distance_to_ellipse(3, 4, 5, 5), 0, 1e-9);
  // Against the minimum over many points, for positions all around and inside, in both orientations.
  for (int i = 0; i < 400; ++i) {
    const double x = -7 + 0.7 * (i % 20);
    const double y = -6 + 0.6 * (i / 20);
    double least = 1e9;
    for (int k = 0; k < 20000; ++k) {
      const double angle = kTurn * k / 20000;
      least = std::min(least, std::hypot(5 * std::cos(angle) - x, 2 * std::sin(angle) - y));
    }
    EXPECT_NEAR(distance_to_ellipse(x, y, 5, 2), least, 2e-5) << x << ' ' << y;
    EXPECT_NEAR(distance_to_ellipse(y, x, 2, 5), least, 2e-5) << x << ' ' << y;
  }
}

TEST(IdealCurve, RunsAtConstantSpeed) {
  RoundShape shape;
  shape.a = 30;
  shape.b = 10;
  shape.start = shape.end = {30, 0};
  for (const bool clockwise : {false, true}) {
    shape.clockwise = clockwise;
    const IdealCurve curve = IdealCurve::round(shape);
    EXPECT_TRUE(curve.is_closed());
    // Perimeter by Ramanujan's second approximation, good to 1e-6 here.
    const double h = 400.0 / 1600;
    EXPECT_NEAR(curve.length(), kTurn / 2 * 40 * (1 + 3 * h / (10 + std::sqrt(4 - 3 * h))), 1e-3);
    Vector last = curve.at(0);
    for (int i = 1; i <= 1000; ++i) {
      const Vector now = curve.at(i / 1000.0);
      EXPECT_NEAR(std::hypot(now[0] - last[0], now[1] - last[1]), curve.length() / 1000, 2e-4 * curve.length() / 1000);
      const Vector tangent = curve.tangent((i - 0.5) / 1000);
      EXPECT_NEAR((now[0] - last[0]) * tangent[1] - (now[1] - last[1]) * tangent[0], 0, 1e-4);
      EXPECT_GT((now[0] - last[0]) * tangent[0] + (now[1] - last[1]) * tangent[1], 0);
      last = now;
    }
    EXPECT_EQ(curve.at(0.1)[1] < 0, clockwise);
  }
}

TEST(IdealCurve, ArcGoesTheCommandedWayRound) {
  RoundShape shape;
  shape.centre = {10, 0};
  shape.a = shape.b = 10;
  shape.start = {20, 0};
  shape.end = {10, 10};
  EXPECT_NEAR(IdealCurve::round(shape).length(), 10 * kTurn / 4, 1e-4);
  shape.clockwise = true;
  EXPECT_NEAR(IdealCurve::round(shape).length(), 10 * kTurn * 3 / 4, 1e-4);
  EXPECT_NEAR(IdealCurve::round(shape).at(1)[1], 10, 1e-9);
}

TEST(Evenness, OfALineByHand) {
  // 4 pulses of x in 40 units: mean interval 10. Intervals 10, 4, 16: deviations 0, -0.6, 0.6.
  const Trace trace = trace_of(2, 40, {{5, {1, 0}}, {15, {1, 0}}, {19, {1, 0}}, {35, {1, 0}}});
  const IdealCurve curve = IdealCurve::line(2, {}, {4, 0});
  const Evenness evenness = measure_evenness(trace, curve, 0);
  EXPECT_EQ(evenness.intervals, 3U);
  EXPECT_NEAR(evenness.largest, 0.6, 1e-12);
  EXPECT_NEAR(evenness.rms, std::sqrt((0.36 + 0.36) / 3), 1e-12);
  EXPECT_THAT(interval_deviations(trace, curve, 0), testing::Pointwise(testing::DoubleNear(1e-12), {0.0, -0.6, 0.6}));
  EXPECT_EQ(measure_evenness(trace, curve, 1).intervals, 0U);
}

TEST(Evenness, APerfectCircleHasNone) {
  // Pulses exactly where the running point passes half pulses: this is the most even sequence on both axes.
  constexpr double kRadius = 20;
  constexpr std::uint64_t kTotal = 1'000'000'000;
  std::vector<Pulse> pulses;
  TracePosition at{20, 0};
  for (std::uint64_t t = 1; t <= 100000; ++t) {
    const double angle = kTurn * static_cast<double>(t) / 100000;
    Directions direction{};
    const TracePosition now{std::llround(kRadius * std::cos(angle)), std::llround(kRadius * std::sin(angle))};
    for (std::size_t a = 0; a < 2; ++a) direction[a] = static_cast<std::int8_t>(now[a] - at[a]);
    if (now != at) pulses.push_back({t * (kTotal / 100000), direction});
    at = now;
  }
  const Trace trace = trace_of(2, kTotal, pulses, {20, 0});
  RoundShape shape;
  shape.a = shape.b = kRadius;
  shape.start = shape.end = {kRadius, 0};
  const IdealCurve curve = IdealCurve::round(shape);
  for (std::size_t a = 0; a < 2; ++a) {
    const Evenness evenness = measure_evenness(trace, curve, a);
    // 80 pulses; x reverses once, y twice.
    EXPECT_EQ(evenness.intervals, a == 0 ? 78U : 77U);
    EXPECT_LT(evenness.largest, 3e-3);
  }
  EXPECT_LE(measure_distances(trace, curve).axis[0].largest, 0.5 + 2e-3);
  // Only the chords of half pulses around the turning points remain.
  EXPECT_LT(measure_speed_ripple(trace, curve).rms, 0.1);
}

TEST(Spectrum, FindsThePeriodOfTheUnevenness) {
  std::vector<double> deviations;
  for (int i = 0; i < 120; ++i)
    deviations.push_back(0.25 * std::cos(kTurn * i * 7 / 120) + 0.1 * (i % 2 == 0 ? 1 : -1));
  const std::vector<SpectrumLine> spectrum = interval_spectrum(deviations);
  ASSERT_EQ(spectrum.size(), 60U);
  EXPECT_NEAR(highest_line(spectrum).frequency, 7.0 / 120, 1e-12);
  EXPECT_NEAR(highest_line(spectrum).amplitude, 0.25, 1e-9);
  EXPECT_NEAR(spectrum.back().frequency, 0.5, 1e-12);
  EXPECT_NEAR(spectrum.back().amplitude, 0.1, 1e-9);
  EXPECT_NEAR(spectrum[20].amplitude, 0, 1e-9);
}

TEST(SpeedRipple, OfEvenPulsesIsZeroAndOfAlternatingOnesByHand) {
  const IdealCurve curve = IdealCurve::line(2, {}, {4, 0});
  const Trace even = trace_of(2, 40, {{5, {1, 0}}, {15, {1, 0}}, {25, {1, 0}}, {35, {1, 0}}});
  EXPECT_NEAR(measure_speed_ripple(even, curve).rms, 0, 1e-12);
  // Intervals 10, 4, 16 at mean speed 1/10: speeds 1, 2.5, 0.625 of the mean.
  const Trace uneven = trace_of(2, 40, {{5, {1, 0}}, {15, {1, 0}}, {19, {1, 0}}, {35, {1, 0}}});
  const Ripple ripple = measure_speed_ripple(uneven, curve);
  EXPECT_NEAR(ripple.largest, 1.5, 1e-12);
  EXPECT_NEAR(ripple.rms, std::sqrt((4 * 1.5 * 1.5 + 16 * 0.375 * 0.375) / 30), 1e-12);
}

TEST(SpeedRipple, LinesAgreeWithTheGeneralFormula) {
  // The first pulses of a large circle run almost along y, and so does the line.
  const std::vector<Pulse> pulses = {{5, {0, 1}}, {15, {0, 1}}, {19, {0, 1}}, {35, {0, 1}}};
  RoundShape shape;
  shape.a = shape.b = 1e7;
  shape.start = {1e7, 0};
  shape.end = {1e7 - 8e-7, 4};
  const Ripple line = measure_speed_ripple(trace_of(2, 40, pulses), IdealCurve::line(2, {}, {0, 4}));
  const Ripple arc = measure_speed_ripple(trace_of(2, 40, pulses, {10'000'000, 0}), IdealCurve::round(shape));
  EXPECT_NEAR(line.rms, arc.rms, 1e-6);
  EXPECT_NEAR(line.largest, arc.largest, 1e-6);
}

TEST(SpeedRipple, IsTheComponentAlongThePath) {
  // Both axes are perfectly even but not in phase: the speed along the path is constant.
  const IdealCurve curve = IdealCurve::line(2, {}, {4, -4});
  std::vector<Pulse> pulses;
  for (std::uint64_t i = 0; i < 4; ++i) {
    pulses.push_back({10 * i + 3, {1, 0}});
    pulses.push_back({10 * i + 8, {0, -1}});
  }
  EXPECT_NEAR(measure_speed_ripple(trace_of(2, 40, pulses), curve).rms, 0, 1e-12);
}

TEST(Cost, CountsComputationsAndWrites) {
  const Trace trace = small_line();
  EXPECT_EQ(cost_of_every_step(trace).operations, 3U);
  EXPECT_EQ(cost_of_every_step(trace).register_writes, 3U);
  EXPECT_EQ(cost_of_one_shot(35).operations, 1U);
  EXPECT_EQ(cost_of_one_shot(35).register_writes, 35U);
  const Trace dda = trace_of(2, 8, {{2, {1, 0}}, {5, {1, 1}}});
  EXPECT_EQ(cost_of_every_iteration(dda).operations, 8U);
  EXPECT_EQ(cost_of_every_iteration(dda).register_writes, 2U);
}

}  // namespace
}  // namespace trammel::measure
