#include "splines.hpp"

#include <algorithm>
#include <cmath>

namespace trammel::gcode {
namespace {

// Length of the second difference of three control points.
double bend(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  const double x = a.x - 2 * b.x + c.x;
  const double y = a.y - 2 * b.y + c.y;
  return std::sqrt(x * x + y * y);
}

}  // namespace

Cubic cubic_of(const PlanePoint& start, const PlanePoint& control, const PlanePoint& end) {
  const auto between = [&](const PlanePoint& point) {
    return PlanePoint{point.x + (control.x - point.x) * 2 / 3, point.y + (control.y - point.y) * 2 / 3};
  };
  return {start, between(start), between(end), end};
}

// The deviation of a chord over a step h of the parameter is at most h^2/8 of the second derivative. This is 6 times
// the second differences of the control points, and largest at an end.
std::uint32_t lines_of(const Cubic& curve) {
  const double second = 6 * std::max(bend(curve[0], curve[1], curve[2]), bend(curve[1], curve[2], curve[3]));
  const double lines = std::ceil(std::sqrt(second / (8 * kSplineTolerance)));
  return static_cast<std::uint32_t>(std::clamp(lines, 1.0, kMaxSplineLines + 1.0));
}

PlanePoint point_of(const Cubic& curve, std::uint32_t i, std::uint32_t count) {
  if (i == count) return curve[3];
  const double t = static_cast<double>(i) / count;
  const double s = 1 - t;
  const std::array<double, 4> share{s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
  PlanePoint point{0, 0};
  for (std::size_t k = 0; k < curve.size(); ++k) {
    point.x += share[k] * curve[k].x;
    point.y += share[k] * curve[k].y;
  }
  return point;
}

}  // namespace trammel::gcode
