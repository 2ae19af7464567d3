#include "trammel/measure/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <variant>

#include "trammel/card_map.hpp"

namespace trammel::measure {
namespace {

using interpolation::Arc;
using interpolation::Curve;
using interpolation::Line;
using interpolation::Method;

std::uint64_t magnitude(std::int64_t value) { return static_cast<std::uint64_t>(value < 0 ? -value : value); }

// The direct-mode registers of a line on a card of 4 axes, one block: FREQUENCY_LO[3] .. START.
constexpr std::uint64_t kLineBlock = (card_map::reg::kStart - card_map::reg::frequency_lo(3)) / 4 + 1;

// The length of a command of two axes, in words.
constexpr std::uint64_t words_of(card_map::Opcode opcode) {
  return card_map::words(*card_map::find_command(static_cast<std::uint8_t>(opcode)), 0x3);
}

bool computes_once(Method method) {
  switch (method) {
    case Method::kOneShot:
    case Method::kOneShotZero:
    case Method::kDivider:
    case Method::kRotation:
      return true;
    default:
      return false;
  }
}

}  // namespace

std::uint64_t pulses_along(const Curve& curve) {
  if (const auto* line = std::get_if<Line>(&curve)) {
    std::uint64_t pulses = 0;
    for (unsigned a = 0; a < line->axes; ++a) pulses += magnitude(line->end[a] - line->start[a]);
    return pulses;
  }
  const auto& arc = std::get<Arc>(curve);
  if (!arc.is_circle()) return 4 * (magnitude(arc.semi_x) + magnitude(arc.semi_y));
  // The radius is between the larger of |x|, |y| and 1.42 times it.
  const std::uint64_t x = magnitude(arc.start.x - arc.centre.x);
  const std::uint64_t y = magnitude(arc.start.y - arc.centre.y);
  return 8 * std::max(x, y);
}

IdealCurve ideal_of(const Curve& curve) {
  if (const auto* line = std::get_if<Line>(&curve)) return IdealCurve::line(line->axes, line->start, line->end);
  const auto& arc = std::get<Arc>(curve);
  RoundShape shape;
  shape.centre = {static_cast<double>(arc.centre.x), static_cast<double>(arc.centre.y)};
  shape.start = {static_cast<double>(arc.start.x), static_cast<double>(arc.start.y)};
  shape.end = {static_cast<double>(arc.end.x), static_cast<double>(arc.end.y)};
  shape.clockwise = arc.clockwise;
  shape.a = static_cast<double>(arc.semi_x);
  shape.b = static_cast<double>(arc.semi_y);
  if (arc.is_circle()) {
    shape.a = std::hypot(shape.start[0] - shape.centre[0], shape.start[1] - shape.centre[1]);
    shape.b = shape.a;
  }
  return IdealCurve::round(shape);
}

void record(Method method, const Curve& curve, const interpolation::Options& options, Trace& trace) {
  interpolation::AnyInterpolator interpolator = interpolation::make_interpolator(method, curve, options);
  const auto* line = std::get_if<Line>(&curve);
  const std::size_t axes = line != nullptr ? line->axes : 2;
  trace.clear(axes, interpolator.position());
  if (line != nullptr && axes == 2) {
    Event* at = trace.room(pulses_along(curve));
    interpolator.run([&at](const interpolation::Step& step, const auto& walk) {
      at->time = walk.time();
      at->direction[0] = step.direction[0];
      at->direction[1] = step.direction[1];
      ++at;
    });
    trace.take(at);
  } else {
    interpolator.run(
        [&trace](const interpolation::Step& step, const auto& walk) { trace.add(walk.time(), step.direction); });
  }
  trace.finish(interpolator.total_time());
}

HostCost cost_of(Method method, const Trace& trace, bool line) {
  if (!line && method == Method::kRotation) return cost_of_one_shot(words_of(card_map::Opcode::ArcChord));
  if (!line && (method == Method::kSteer || method == Method::kMinDeviation8)) {
    return cost_of_one_shot(words_of(card_map::Opcode::Arc));
  }
  if (computes_once(method)) return cost_of_one_shot(kLineBlock);
  if (method == Method::kDda || method == Method::kDdaHalf) return cost_of_every_iteration(trace);
  return cost_of_every_step(trace);
}

MethodMeasures measure_method(Method method, const Trace& trace, const IdealCurve& curve) {
  MethodMeasures result;
  result.method = method;
  result.steps = trace.events().size();
  result.pulses = pulses_of(trace);
  result.total_time = trace.total_time();
  result.cost = cost_of(method, trace, curve.is_line());
  result.distances = measure_distances(trace, curve);
  for (std::size_t a = 0; a < trace.axes(); ++a) {
    result.evenness[a] = measure_evenness(trace, curve, a);
    result.spectrum[a] = interval_spectrum(interval_deviations(trace, curve, a));
  }
  result.ripple = measure_speed_ripple(trace, curve);
  return result;
}

std::vector<Method> methods_for(const Curve& curve) {
  std::vector<Method> result;
  for (const interpolation::MethodInfo& info : interpolation::methods()) {
    if (const auto* line = std::get_if<Line>(&curve)) {
      if (info.line_axes >= line->axes) result.push_back(info.method);
    } else {
      const bool circle = std::get<Arc>(curve).is_circle();
      if (circle ? info.circles : info.ellipses) result.push_back(info.method);
    }
  }
  return result;
}

}  // namespace trammel::measure
