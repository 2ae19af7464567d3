#include "trammel/measure/distance.hpp"

#include <algorithm>
#include <cmath>

#include "numbers.hpp"

namespace trammel::measure {
namespace {

double larger(double a, double b) { return a < b ? b : a; }

void take(Spread& spread, double distance) {
  spread.largest = larger(spread.largest, distance);
  spread.mean += distance;
}

// The distance of one axis of a line from the running point: at each event, and at the whole time unit before it,
// when the axis is still at its old position.
class AxisError {
 public:
  explicit AxisError(double rate) : rate_(rate) {}
  void event(double time, int direction) {
    const double expected = rate_ * time;
    const double before = std::abs(at_ - expected + rate_);
    at_ += direction;
    const double after = std::abs(at_ - expected);
    largest_ = larger(largest_, larger(before, after));
    sum_ += after;
  }
  double at() const { return at_; }
  Spread spread() const { return {largest_, sum_}; }

 private:
  double rate_;  // pulses per time unit
  double at_ = 0;
  double largest_ = 0;
  double sum_ = 0;
};

// Two axes, without a square root per event: the fast path for a million random lines. `scale` is 1 / total time.
Distances plane_line(const Trace& trace, const IdealCurve& curve, double scale) {
  const double px = curve.displacement()[0];
  const double py = curve.displacement()[1];
  AxisError x(px * scale);
  AxisError y(py * scale);
  Spread cross;
  for (const Event& event : trace.events()) {
    const double time = as_double(event.time);
    x.event(time, event.direction[0]);
    y.event(time, event.direction[1]);
    take(cross, std::abs(x.at() * py - y.at() * px));
  }
  Distances result;
  const double length = curve.length();
  result.perpendicular = {cross.largest / length, cross.mean / length};
  if (py != 0) result.horizontal = Spread{cross.largest / std::abs(py), cross.mean / std::abs(py)};
  result.axis[0] = x.spread();
  result.axis[1] = y.spread();
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

}  // namespace trammel::measure
