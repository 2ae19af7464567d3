#include "trammel/measure/ideal_curve.hpp"

#include <algorithm>
#include <cmath>

#include "numbers.hpp"

namespace trammel::measure {
namespace {

// Parts of the table of arc length: a chord of 1/4,096 turn is shorter than its arc by 1e-7.
constexpr std::size_t kParts = 4096;

double square(double x) { return x * x; }

}  // namespace

double distance_to_ellipse(double x, double y, double a, double b) {
  if (a < b) return distance_to_ellipse(y, x, b, a);
  x = std::abs(x);
  y = std::abs(y);
  if (y == 0) {
    // On the major axis: beyond the evolute's cusp the vertex is nearest, inside it a point above.
    if (a == b || x >= (a * a - b * b) / a) return std::abs(x - a);
    const double cosine = a * x / (a * a - b * b);
    return std::hypot(x - a * cosine, b * std::sqrt(1 - cosine * cosine));
  }
  // The nearest point is (a^2 x / (t + a^2), b^2 y / (t + b^2)), where t is the root of g, which decreases for t >
  // -b^2.
  const auto g = [&](double t) { return square(a * x / (t + a * a)) + square(b * y / (t + b * b)) - 1; };
  double low = -b * b + b * y;
  double high = -b * b + std::hypot(a * x, b * y);
  for (int i = 0; i < 128; ++i) {
    const double middle = (low + high) / 2;
    if (middle <= low || middle >= high) break;
    (g(middle) > 0 ? low : high) = middle;
  }
  const double t = (low + high) / 2;
  return std::hypot(x - a * a * x / (t + a * a), y - b * b * y / (t + b * b));
}

IdealCurve IdealCurve::line(std::size_t axes, const TracePosition& start, const TracePosition& end) {
  IdealCurve curve;
  curve.axes_ = axes;
  double sum = 0;
  for (std::size_t i = 0; i < axes; ++i) {
    curve.start_[i] = static_cast<double>(start[i]);
    curve.displacement_[i] = static_cast<double>(end[i] - start[i]);
    sum += square(curve.displacement_[i]);
  }
  curve.length_ = std::sqrt(sum);
  return curve;
}

IdealCurve IdealCurve::round(const RoundShape& shape) {
  IdealCurve curve;
  curve.is_line_ = false;
  curve.is_closed_ = shape.start == shape.end;
  curve.shape_ = shape;
  const double start_x = (shape.start[0] - shape.centre[0]) / shape.a;
  const double start_y = (shape.start[1] - shape.centre[1]) / shape.b;
  const double end_x = (shape.end[0] - shape.centre[0]) / shape.a;
  const double end_y = (shape.end[1] - shape.centre[1]) / shape.b;
  curve.start_angle_ = std::atan2(start_y, start_x);
  curve.start_size_ = std::hypot(start_x, start_y);
  curve.end_size_ = std::hypot(end_x, end_y);
  double sweep = std::atan2(end_y, end_x) - curve.start_angle_;
  if (shape.clockwise) sweep = -sweep;
  if (sweep < 0) sweep += kTurn;
  if (curve.is_closed_) sweep = kTurn;
  curve.sweep_ = shape.clockwise ? -sweep : sweep;
  curve.tabulate();
  return curve;
}

Vector IdealCurve::point_at_angle(double angle) const {
  const double part = (angle - start_angle_) / sweep_;
  const double size = start_size_ + (end_size_ - start_size_) * part;
  return {shape_.centre[0] + size * shape_.a * std::cos(angle), shape_.centre[1] + size * shape_.b * std::sin(angle), 0,
          0};
}

void IdealCurve::tabulate() {
  length_at_.resize(kParts + 1);
  length_at_[0] = 0;
  if (sweep_ == 0) return;
  Vector last = point_at_angle(start_angle_);
  for (std::size_t i = 1; i <= kParts; ++i) {
    const Vector next = point_at_angle(start_angle_ + sweep_ * static_cast<double>(i) / kParts);
    length_at_[i] = length_at_[i - 1] + std::hypot(next[0] - last[0], next[1] - last[1]);
    last = next;
  }
  length_ = length_at_[kParts];
}

double IdealCurve::angle_at(double fraction) const {
  const double wanted = std::clamp(fraction, 0.0, 1.0) * length_;
  const auto above = std::upper_bound(length_at_.begin() + 1, length_at_.end() - 1, wanted);
  const auto part = static_cast<double>(above - length_at_.begin() - 1);
  const double within = (wanted - *(above - 1)) / (*above - *(above - 1));
  return start_angle_ + sweep_ * (part + within) / kParts;
}

double IdealCurve::distance(const TracePosition& position) const {
  if (!is_line_) {
    const double x = static_cast<double>(position[0]) - shape_.centre[0];
    const double y = static_cast<double>(position[1]) - shape_.centre[1];
    if (shape_.a != shape_.b) return distance_to_ellipse(x, y, shape_.a, shape_.b);
    const double radius = std::hypot(x, y);
    const double inner = std::min(start_size_, end_size_) * shape_.a;
    const double outer = std::max(start_size_, end_size_) * shape_.a;
    return std::max({0.0, inner - radius, radius - outer});
  }
  // |d|^2 - (d.u)^2 loses digits on long lines; the rejection d - (d.u) u does not.
  double along = 0;
  for (std::size_t i = 0; i < axes_; ++i) {
    along += (static_cast<double>(position[i]) - start_[i]) * displacement_[i];
  }
  if (length_ > 0) along /= square(length_);
  double sum = 0;
  for (std::size_t i = 0; i < axes_; ++i) {
    sum += square(static_cast<double>(position[i]) - start_[i] - along * displacement_[i]);
  }
  return std::sqrt(sum);
}

Vector IdealCurve::at(double fraction) const {
  if (!is_line_) return point_at_angle(angle_at(fraction));
  Vector point = start_;
  for (std::size_t i = 0; i < axes_; ++i) point[i] += fraction * displacement_[i];
  return point;
}

Vector IdealCurve::tangent(double fraction) const {
  Vector direction = displacement_;
  double size = length_;
  if (!is_line_) {
    const double angle = angle_at(fraction);
    const double sense = sweep_ < 0 ? -1 : 1;
    direction = {-sense * shape_.a * std::sin(angle), sense * shape_.b * std::cos(angle), 0, 0};
    size = std::hypot(direction[0], direction[1]);
  }
  if (size > 0) {
    for (double& component : direction) component /= size;
  }
  return direction;
}

}  // namespace trammel::measure
