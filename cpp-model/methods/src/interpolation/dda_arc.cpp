#include "trammel/interpolation/dda_arc.hpp"

#include <cmath>

namespace trammel::interpolation {
namespace {

std::int64_t magnitude(std::int64_t value) { return value < 0 ? -value : value; }

// The radius of the circle through `p` about the origin, rounded up. Radii below 2^31 are exact enough in long
// double.
std::int64_t radius_rounded_up(const Point& p) {
  return static_cast<std::int64_t>(std::ceil(std::hypot(static_cast<long double>(p.x), static_cast<long double>(p.y))));
}

}  // namespace

DdaArc::DdaArc(const Arc& circle, bool half)
    : centre_(circle.centre),
      at_{circle.start.x - circle.centre.x, circle.start.y - circle.centre.y},
      clockwise_(circle.clockwise),
      end_(at_, {circle.end.x - circle.centre.x, circle.end.y - circle.centre.y}, circle.clockwise,
           2 * radius_rounded_up(at_)) {
  constexpr std::int64_t kOutgrown = 6;
  while (modulus_ <= radius_rounded_up(at_) + kOutgrown) modulus_ *= 2;
  if (half) {
    sum_x_ = modulus_ / 2;
    sum_y_ = modulus_ / 2;
  }
}

Step DdaArc::next() {
  const std::int8_t towards_x = direction_x();
  const std::int8_t towards_y = direction_y();
  Step step;
  if (end_.finishing(at_, towards_x, towards_y)) {
    step = end_.straight(at_, true);
    at_.x += step.direction[0];
    at_.y += step.direction[1];
    ++time_;
    return step;
  }
  // For radii from 6 on the larger coordinate is at least modulus / 4, so a step is a few iterations away; for
  // smaller radii the modulus is at most 16. Only at the centre itself there would be no step, and the walk of a
  // circle does not pass there.
  while (step == Step{}) {
    ++time_;
    sum_x_ += magnitude(at_.y);
    sum_y_ += magnitude(at_.x);
    if (sum_x_ >= modulus_) {
      sum_x_ -= modulus_;
      step.direction[0] = towards_x;
    }
    if (sum_y_ >= modulus_) {
      sum_y_ -= modulus_;
      step.direction[1] = towards_y;
    }
  }
  const Point from = at_;
  at_.x += step.direction[0];
  at_.y += step.direction[1];
  end_.moved(from, at_);
  return step;
}

}  // namespace trammel::interpolation
