// The ideal curve of a method, and the point that runs along it at constant speed.
//
// A line joins its integer end points. An arc starts and ends at rounded points, which lie at slightly different
// distances from the centre. Its distances are measured from the annulus between both radii, and the radius of the
// running point changes linearly with the angle from one to the other. An ellipse is axis-parallel with semi-axes a
// and b; the size of the running point relative to it changes in the same way from the start's to the end's. Unit:
// pulses. Immutable after construction: thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "trammel/measure/trace.hpp"

namespace trammel::measure {

using Vector = std::array<double, kTraceAxes>;

struct RoundShape {
  std::array<double, 2> centre{};
  double a = 0;  // semi-axes, > 0; equal for a circle
  double b = 0;
  std::array<double, 2> start{};
  std::array<double, 2> end{};  // equal to the start: one full turn
  bool clockwise = false;       // x to the right, y up
};

class IdealCurve {
 public:
  // `axes` is 1 .. kTraceAxes.
  static IdealCurve line(std::size_t axes, const TracePosition& start, const TracePosition& end);
  static IdealCurve round(const RoundShape& shape);

  bool is_line() const { return is_line_; }
  bool is_closed() const { return is_closed_; }
  std::size_t axes() const { return axes_; }
  double length() const { return length_; }

  // Perpendicular distance of a position.
  double distance(const TracePosition& position) const;

  // The running point after a fraction (0 .. 1) of the time, and its direction (unit length).
  Vector at(double fraction) const;
  Vector tangent(double fraction) const;

  // Start and displacement of a line.
  const Vector& start() const { return start_; }
  const Vector& displacement() const { return displacement_; }

 private:
  Vector point_at_angle(double angle) const;
  double angle_at(double fraction) const;
  void tabulate();

  bool is_line_ = true;
  bool is_closed_ = false;
  std::size_t axes_ = 2;
  double length_ = 0;
  Vector start_{};
  Vector displacement_{};
  RoundShape shape_{};
  double start_angle_ = 0;  // eccentric anomaly; of a circle, the angle itself
  double sweep_ = 0;        // signed, counter-clockwise positive
  double start_size_ = 1;   // size of the start: distance from the centre relative to the shape
  double end_size_ = 1;
  std::vector<double> length_at_;  // arc length after each of the equal parts of the sweep
};

// Distance from (x, y) to the ellipse of semi-axes a and b about the origin, both > 0. Accurate to 1e-9 of a + b.
// Source: D. Eberly, "Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid": the parameter of the
// nearest point is the root of a strictly decreasing function, found by bisection.
double distance_to_ellipse(double x, double y, double a, double b);

}  // namespace trammel::measure
