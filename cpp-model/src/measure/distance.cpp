#include "trammel/model/measure/distance.hpp"

#include <algorithm>
#include <cmath>

namespace trammel::model::measure {
namespace {

void take(Spread& spread, double distance) {
  spread.largest = std::max(spread.largest, distance);
  spread.mean += distance;
}

// The line's distances relative to its start, for two axes without a square root an event: what a million random
// lines are measured with. `scale` is 1 / total time.
Distances plane_line(const Trace& trace, const IdealCurve& curve, double scale) {
  const double px = curve.displacement()[0];
  const double py = curve.displacement()[1];
  const double rate_x = px * scale;
  const double rate_y = py * scale;
  Distances result;
  Spread cross;
  double x = 0;
  double y = 0;
  for (const Event& event : trace.events()) {
    const auto time = static_cast<double>(event.time);
    // Just before the event, at the whole time unit before it, the axes still stand where they stood.
    const double before_x = std::abs(x - rate_x * (time - 1));
    const double before_y = std::abs(y - rate_y * (time - 1));
    x += event.direction[0];
    y += event.direction[1];
    const double after_x = std::abs(x - rate_x * time);
    const double after_y = std::abs(y - rate_y * time);
    result.axis[0].largest = std::max({result.axis[0].largest, before_x, after_x});
    result.axis[1].largest = std::max({result.axis[1].largest, before_y, after_y});
    result.axis[0].mean += after_x;
    result.axis[1].mean += after_y;
    take(cross, std::abs(x * py - y * px));
  }
  const double length = curve.length();
  result.perpendicular = {cross.largest / length, cross.mean / length};
  if (py != 0) result.horizontal = Spread{cross.largest / std::abs(py), cross.mean / std::abs(py)};
  return result;
}

Distances any_curve(const Trace& trace, const IdealCurve& curve, double scale) {
  Distances result;
  TracePosition position = trace.start();
  for (const Event& event : trace.events()) {
    const auto time = static_cast<double>(event.time);
    const Vector before = curve.at((time - 1) * scale);
    const Vector now = curve.at(time * scale);
    for (std::size_t a = 0; a < trace.axes(); ++a) {
      const double held = std::abs(static_cast<double>(position[a]) - before[a]);
      position[a] += event.direction[a];
      take(result.axis[a], std::abs(static_cast<double>(position[a]) - now[a]));
      result.axis[a].largest = std::max(result.axis[a].largest, held);
    }
    take(result.perpendicular, curve.distance(position));
  }
  return result;
}

}  // namespace

Distances measure_distances(const Trace& trace, const IdealCurve& curve) {
  if (trace.events().empty()) return {};
  const double scale = 1 / static_cast<double>(trace.total_time());
  const bool plane = curve.is_line() && trace.axes() == 2;
  Distances result = plane ? plane_line(trace, curve, scale) : any_curve(trace, curve, scale);
  const auto events = static_cast<double>(trace.events().size());
  result.perpendicular.mean /= events;
  if (result.horizontal) result.horizontal->mean /= events;
  for (Spread& spread : result.axis) spread.mean /= events;
  return result;
}

}  // namespace trammel::model::measure
