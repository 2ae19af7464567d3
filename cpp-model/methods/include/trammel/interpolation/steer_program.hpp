// STEER's circle routine as printed: from (x, y) it steps by Table 2 about the origin until it is back at its start;
// it has no other end. From a start off the circle it hardly ever comes back. Source: Goldberg & Goldberg, "XY
// Interpolation Algorithms", listing 1, docircle(). SteerCircle (conic_arc.hpp) is the same method with an end. |x|,
// |y|, radius < 2^30. Not thread-safe.
#pragma once

#include <cstdint>
#include <optional>

#include "trammel/interpolation/conic_arc.hpp"
#include "trammel/interpolation/curve.hpp"

namespace trammel::interpolation {

class SteerProgram {
 public:
  // `clockwise` is the paper's D = 1.
  SteerProgram(Point start, std::int64_t radius, bool clockwise)
      : start_(start), at_(start), radius_(radius), clockwise_(clockwise) {}

  Point position() const { return at_; }
  std::int64_t deviation() const { return at_.x * at_.x + at_.y * at_.y - radius_ * radius_; }
  // True at the start, also before the first step, when the program does not check it yet.
  bool back() const { return at_ == start_; }

  Step next() {
    const ConicState<std::int64_t> state{deviation(), 2 * at_.x, 2 * at_.y, 1, 1, clockwise_};
    const Step step = SteerTable::choose(state);
    at_.x += step.direction[0];
    at_.y += step.direction[1];
    return step;
  }

  // Steps until the walk is back at its start, or nothing if it never is. The next step depends only on the position,
  // so a walk that meets itself elsewhere stays in that loop; a second walk at double speed overtakes it there.
  std::optional<std::uint64_t> steps_to_return() const {
    SteerProgram slow = *this;
    SteerProgram fast = *this;
    for (std::uint64_t steps = 1;; ++steps) {
      fast.next();
      if (fast.back()) return steps;
      if (steps % 2 != 0) continue;
      slow.next();
      if (slow.at_ == fast.at_) return std::nullopt;
    }
  }

 private:
  Point start_;
  Point at_;
  std::int64_t radius_;
  bool clockwise_;
};

}  // namespace trammel::interpolation
