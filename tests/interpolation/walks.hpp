// Shared by the tests of the interpolators: whole walks, and distances (exact or double).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "trammel/interpolation/any_interpolator.hpp"

namespace trammel::interpolation {

struct Walked {
  Position end{};
  std::uint64_t steps = 0;
  double largest = 0;  // largest distance after any step
};

// Walks to the end or for `limit` steps; distance(position) is in pulses.
template <class Walk, class Distance>
Walked walk_all(Walk walk, std::uint64_t limit, Distance distance) {
  Walked result;
  while (!walk.done() && result.steps < limit) {
    walk.next();
    ++result.steps;
    result.largest = std::max(result.largest, static_cast<double>(distance(walk.position())));
  }
  result.end = walk.position();
  return result;
}

inline double from_line(const Line& line, const Position& p) {
  const auto dx = static_cast<double>(line.end[0] - line.start[0]);
  const auto dy = static_cast<double>(line.end[1] - line.start[1]);
  const auto x = static_cast<double>(p[0] - line.start[0]);
  const auto y = static_cast<double>(p[1] - line.start[1]);
  const double length = std::hypot(dx, dy);
  return length == 0 ? std::hypot(x, y) : std::fabs(dx * y - dy * x) / length;
}

inline double from_circle(double radius, const Position& p) {
  return std::fabs(std::hypot(static_cast<double>(p[0]), static_cast<double>(p[1])) - radius);
}

// Distance from the axis-aligned ellipse around the origin, by bisection of the equation of the foot of the
// perpendicular.
double from_ellipse(double semi_x, double semi_y, const Position& p);

// Axes of the steps, such as "yyx", for a line or an arc in 4 directions.
template <class Walk>
std::string axes_of(Walk walk) {
  std::string result;
  while (!walk.done()) result += walk.next().direction[0] != 0 ? 'x' : 'y';
  return result;
}

}  // namespace trammel::interpolation
