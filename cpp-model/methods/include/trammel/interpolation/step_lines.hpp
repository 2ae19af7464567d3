// Lines on two axes by unit steps chosen from a deviation F: one class for the three rules with 4 directions. Units:
// pulses. |dx|, |dy| <= 2^30 (kMaxLine). With D = |dx|*y - |dy|*x and positions counted along the line, every rule
// keeps |D| <= |dx| + |dy|, so |F| < 2^32. No errors are reported; not thread-safe.
#pragma once

#include <cstdint>

#include "trammel/interpolation/curve.hpp"

namespace trammel::interpolation {

// Start, lengths and signs of a line on two axes.
class PlaneWalk {
 public:
  explicit PlaneWalk(const Line& line)
      : start_x_(line.start[0]),
        start_y_(line.start[1]),
        sign_x_(line.end[0] < line.start[0] ? std::int8_t{-1} : std::int8_t{1}),
        sign_y_(line.end[1] < line.start[1] ? std::int8_t{-1} : std::int8_t{1}),
        length_x_(sign_x_ * (line.end[0] - line.start[0])),
        length_y_(sign_y_ * (line.end[1] - line.start[1])) {}

  std::int64_t length_x() const { return length_x_; }
  std::int64_t length_y() const { return length_y_; }
  std::int8_t sign_x() const { return sign_x_; }
  std::int8_t sign_y() const { return sign_y_; }
  // Signed position after x and y steps along the line.
  Position at(std::int64_t x, std::int64_t y) const { return {start_x_ + sign_x_ * x, start_y_ + sign_y_ * y, 0, 0}; }

 private:
  std::int64_t start_x_;
  std::int64_t start_y_;
  std::int8_t sign_x_;
  std::int8_t sign_y_;
  std::int64_t length_x_;
  std::int64_t length_y_;
};

// A rule defines F at the start, and the condition for an x step. In every rule an x step subtracts |dy| and a y step
// adds |dx|. No rule leaves the line's bounding box: with x at its end D <= -|dx| unless y is at its end too, and
// with y at its end D >= |dy| unless x is too; the rules below then choose the other axis. Lines along one axis need
// special care.

// Goldberg & Goldberg, listing 1: F = |dx| - |dy| at the start, F > 0 ? x : y.
struct SteerRule {
  static std::int64_t first(std::int64_t dx, std::int64_t dy) { return dx - dy; }
  static bool x_steps(std::int64_t f, std::int64_t, std::int64_t) { return f > 0; }
};

// The textbook rule: F = xe*y - ye*x, F >= 0 ? x : y. On a line along y F stays 0, so y steps there.
struct PointByPointRule {
  static std::int64_t first(std::int64_t, std::int64_t) { return 0; }
  static bool x_steps(std::int64_t f, std::int64_t dx, std::int64_t) { return f >= 0 && dx != 0; }
};

// F as above; chooses the axis whose step leaves the smaller |F|. As F - |dy| <= F + |dx|, x leaves the smaller one
// if their sum is positive. On a tie the longer axis steps (x if both are equal).
struct MinFRule {
  static std::int64_t first(std::int64_t, std::int64_t) { return 0; }
  static bool x_steps(std::int64_t f, std::int64_t dx, std::int64_t dy) {
    const std::int64_t sum = 2 * f + dx - dy;
    return sum != 0 ? sum > 0 : dx >= dy;
  }
};

template <class Rule>
class FourDirectionLine {
 public:
  explicit FourDirectionLine(const Line& line)
      : walk_(line), f_(Rule::first(walk_.length_x(), walk_.length_y())), left_(walk_.length_x() + walk_.length_y()) {}

  bool done() const { return left_ == 0; }
  // Not to be called when done.
  Step next() {
    const bool in_x = Rule::x_steps(f_, walk_.length_x(), walk_.length_y());
    // Masks instead of a branch, which would be mispredicted at every other step.
    const std::int64_t mask = -static_cast<std::int64_t>(in_x);
    f_ += walk_.length_x() - (mask & (walk_.length_x() + walk_.length_y()));
    x_ += in_x;
    --left_;
    const auto step_x = static_cast<std::int8_t>(in_x ? walk_.sign_x() : 0);
    const auto step_y = static_cast<std::int8_t>(in_x ? 0 : walk_.sign_y());
    return {{step_x, step_y, 0, 0}};
  }
  Position position() const { return walk_.at(x_, walk_.length_x() + walk_.length_y() - left_ - x_); }
  Deviation deviation() const { return f_; }
  // Unit: steps.
  std::uint64_t time() const { return total_time() - static_cast<std::uint64_t>(left_); }
  std::uint64_t total_time() const { return static_cast<std::uint64_t>(walk_.length_x() + walk_.length_y()); }

 private:
  PlaneWalk walk_;
  std::int64_t f_;
  std::int64_t left_;
  std::int64_t x_ = 0;
};

using SteerLine = FourDirectionLine<SteerRule>;
using PointByPointLine = FourDirectionLine<PointByPointRule>;
using MinFLine = FourDirectionLine<MinFRule>;

}  // namespace trammel::interpolation
