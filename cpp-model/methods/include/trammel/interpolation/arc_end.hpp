// The exact-end rule of arcs. Count the quadrant changes; in the last quadrant, as soon as one coordinate reaches or
// passes that of the end, step straight to the end. Without this rule, one arc in eight misses a rounded end point.
// Units: pulses, from the centre. No errors are reported; not thread-safe.
#pragma once

#include <cstdint>

#include "trammel/interpolation/curve.hpp"

namespace trammel::interpolation {

// 0 is right and up; the numbers increase counter-clockwise. Zero counts as positive, as in Table 2 of Goldberg &
// Goldberg.
int quadrant(const Point& p);

// Sign changes of a coordinate on the way from `start` to `end`, both on the curve: 0 .. 4. An end behind the start
// is reached after nearly a full turn, an end equal to the start after a full turn.
unsigned quadrant_changes(const Point& start, const Point& end, bool clockwise);

class ArcEnd {
 public:
  // `extent`: the sum of the curve's half width and half height, pulses, rounded up.
  ArcEnd(const Point& start, const Point& end, bool clockwise, std::int64_t extent)
      : end_(end), quadrants_(quadrant_changes(start, end, clockwise)), budget_(step_bound(extent)) {}

  // An upper bound of the steps. Within a quadrant a walk moves towards one axis, at most the extent in that
  // coordinate, and away from the other, no farther than the first point outside. Five visited quadrants and a
  // straight way to the end (at most twice the extent) make 7 * (extent + 4); the rest is for the spiral of a DDA. If
  // a walk used up the budget, it would go straight to the end; tests show that this never happens.
  static std::int64_t step_bound(std::int64_t extent) { return 8 * (extent + 4); }

  bool at_end(const Point& p) const { return quadrants_ == 0 && p == end_; }

  // To be called before each step, with the directions of the curve here. Once true, the rest of the way is straight.
  bool finishing(const Point& p, std::int64_t direction_x, std::int64_t direction_y) {
    --budget_;
    if (finishing_) return true;
    if (quadrants_ != 0 && budget_ > 0) return false;
    finishing_ = budget_ <= 0 || direction_x * (end_.x - p.x) <= 0 || direction_y * (end_.y - p.y) <= 0;
    if (finishing_) quadrants_ = 0;
    return finishing_;
  }
  // To be called after each step on the curve.
  void moved(const Point& from, const Point& to) {
    const bool changed = ((from.x ^ to.x) | (from.y ^ to.y)) < 0;
    if (changed && quadrants_ != 0) --quadrants_;
  }
  // The straight step from p: first x then y, or both axes at once.
  Step straight(const Point& p, bool diagonal) const {
    const auto sign = [](std::int64_t left) { return static_cast<std::int8_t>((left > 0) - (left < 0)); };
    Step step;
    step.direction[0] = sign(end_.x - p.x);
    if (diagonal || p.x == end_.x) step.direction[1] = sign(end_.y - p.y);
    return step;
  }
  // True if the bound was reached: a defect of the walking rule.
  bool exhausted() const { return budget_ <= 0; }

 private:
  Point end_;
  unsigned quadrants_;
  std::int64_t budget_;
  bool finishing_ = false;
};

}  // namespace trammel::interpolation
