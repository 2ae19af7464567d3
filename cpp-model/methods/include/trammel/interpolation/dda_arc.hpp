// Circles and their arcs by a digital differential analyser: x' = -y, y' = x (counter-clockwise). At each iteration
// two accumulators each add the magnitude of the other coordinate; an overflow is a step. The end follows the rule of
// arc_end.hpp. Units: pulses. No errors are reported; not thread-safe.
#pragma once

#include <cstdint>

#include "trammel/interpolation/arc_end.hpp"
#include "trammel/interpolation/curve.hpp"

namespace trammel::interpolation {

class DdaArc {
 public:
  // `half`: the accumulators start at one half, otherwise at 0.
  DdaArc(const Arc& circle, bool half);

  bool done() const { return end_.at_end(at_); }
  // Not to be called when done.
  Step next();
  Position position() const { return {centre_.x + at_.x, centre_.y + at_.y, 0, 0}; }
  // Unit: iterations; a straight step to the end counts as one.
  std::uint64_t time() const { return time_; }
  bool exhausted() const { return end_.exhausted(); }

 private:
  std::int8_t direction_x() const { return (at_.y < 0) == clockwise_ ? std::int8_t{-1} : std::int8_t{1}; }
  std::int8_t direction_y() const { return (at_.x < 0) == clockwise_ ? std::int8_t{1} : std::int8_t{-1}; }

  Point centre_;
  Point at_;
  bool clockwise_;
  // 2^n, the smallest power of 2 above the radius plus the growth of the spiral. An iteration multiplies the radius
  // by at most sqrt(1 + 4^-n), a turn of 2 pi 2^n iterations by exp(pi / 2^n), which adds less than pi pulses. The
  // rounding of the position and the accumulators adds less than 3.
  std::int64_t modulus_ = 1;
  std::int64_t sum_x_ = 0;
  std::int64_t sum_y_ = 0;
  std::uint64_t time_ = 0;
  ArcEnd end_;
};

}  // namespace trammel::interpolation
