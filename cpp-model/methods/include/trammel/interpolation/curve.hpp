// Curves and steps: the input and output of every interpolator of this folder. Units: pulses; x to the right, y up.
// Plain values: no errors; safe to share between threads when complete. make_interpolator (any_interpolator.hpp)
// checks curves, not this file.
#pragma once

#include <array>
#include <cstdint>
#include <variant>

namespace trammel::interpolation {

inline constexpr unsigned kMaxAxes = 4;

// Unused axes stay 0.
using Position = std::array<std::int64_t, kMaxAxes>;

// -1, 0 or +1 per axis. One Step holds all steps of one clock or iteration.
struct Step {
  std::array<std::int8_t, kMaxAxes> direction{};
  friend bool operator==(const Step& a, const Step& b) { return a.direction == b.direction; }
};

// The type of F: an ellipse needs up to 93 bits (conic_arc.hpp).
__extension__ typedef __int128 Deviation;

struct Point {
  std::int64_t x = 0;
  std::int64_t y = 0;
  friend bool operator==(const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; }
};

// A straight line on 2 to 4 axes. Largest displacement of an axis: kMaxLine.
struct Line {
  unsigned axes = 2;
  Position start{};
  Position end{};
};
// Keeps the doubled product of two displacements within 64 bits.
inline constexpr std::int64_t kMaxLine = std::int64_t{1} << 30;
// Keeps coordinates and their differences far within 64 bits.
inline constexpr std::int64_t kMaxCoordinate = std::int64_t{1} << 40;

// A circle about `centre`, or an ellipse with axes along x and y. start == end is one full turn; other arcs turn by
// less than one turn from start to end. Points are in the coordinates in which the curve was given.
struct Arc {
  Point centre;
  Point start;
  Point end;
  bool clockwise = false;
  // Semi-axes of an ellipse. Both 0: a circle through `start`.
  std::int64_t semi_x = 0;
  std::int64_t semi_y = 0;

  bool is_circle() const { return semi_x == 0 && semi_y == 0; }
  bool is_full() const { return start == end; }
};
// Keeps x^2 + y^2 of any point of the walk within 63 bits. Semi-axes: see conic_arc.hpp.
inline constexpr std::int64_t kMaxRadius = std::int64_t{1} << 30;
inline constexpr std::int64_t kMaxSemiAxis = std::int64_t{1} << 30;

using Curve = std::variant<Line, Arc>;

inline Line make_line(Point start, Point end) { return {2, {start.x, start.y, 0, 0}, {end.x, end.y, 0, 0}}; }

// A full circle about the origin, from (radius, 0).
inline Arc make_circle(std::int64_t radius, bool clockwise = false) {
  return {{0, 0}, {radius, 0}, {radius, 0}, clockwise, 0, 0};
}

// A full ellipse about the origin, from (semi_x, 0).
inline Arc make_ellipse(std::int64_t semi_x, std::int64_t semi_y, bool clockwise = false) {
  return {{0, 0}, {semi_x, 0}, {semi_x, 0}, clockwise, semi_x, semi_y};
}

// Additional input of the methods that use time. The velocity v of the second paper is velocity / velocity_divisor
// lines per second: a line lasts clock_hz * velocity_divisor / velocity clocks, which need not be a whole number.
struct Options {
  std::uint64_t clock_hz = 10'000'000;
  std::uint64_t velocity = 5000;
  std::uint64_t velocity_divisor = 1;
};

}  // namespace trammel::interpolation
