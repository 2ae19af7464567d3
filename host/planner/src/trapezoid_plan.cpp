#include "trapezoid_plan.hpp"

#include <algorithm>
#include <cmath>

namespace trammel::planner {
namespace {

constexpr std::size_t kChunks = 16;   // of a window
constexpr double kNoLength = 1e-9;    // share of a span that rounding may leave over
constexpr double kSameMotion = 1e-6;  // relative: accelerations, or constant speeds, that make one phase

bool same(double a, double b) { return std::abs(a - b) <= kSameMotion * std::abs(b); }

}  // namespace

TrapezoidPlan::TrapezoidPlan(std::size_t window) : nodes_(window), chunk_(std::max<std::size_t>(1, window / kChunks)) {}

void TrapezoidPlan::push(const Span& span) {
  const double top = span.speed * span.speed;
  Node& added = nodes_[(first_ + count_++) % nodes_.size()];
  added = {span.length, span.acceleration, top, std::min(top, span.exit_speed * span.exit_speed), -1, false};
}

void TrapezoidPlan::finish() {
  if (count_ == 0) return;
  finished_ = true;
  look_back();
  due_ = count_;
}

// From the last span to the first one whose entry stays what it was.
void TrapezoidPlan::look_back() {
  double after = 0;
  bool in_sight = finished_;
  for (std::size_t i = count_; i-- != 0;) {
    Node& at = node(i);
    const bool corner = at.exit <= after;
    const double slowing = (corner ? at.exit : after) + 2 * at.acceleration * at.length;
    const double entry = std::min(at.top, slowing);
    in_sight = in_sight || corner || at.top <= slowing;
    if (at.entry == entry && at.in_sight == in_sight) return;
    at.entry = entry;
    at.in_sight = in_sight;
    after = entry;
  }
}

bool TrapezoidPlan::next(Phase& phase) {
  while (given_ == made_) {
    given_ = made_ = 0;
    if (due_ == 0) {
      if (count_ != nodes_.size()) return false;
      look_back();
      due_ = chunk_;
    }
    plan_first();
  }
  phase = phases_[given_++];
  return true;
}

void TrapezoidPlan::plan_first() {
  const Node at = node(0);
  const bool last = count_ == 1;
  const double after = last ? 0 : node(1).entry;
  const bool in_sight = at.exit <= after || (last ? finished_ : node(1).in_sight);
  const double gain = 2 * at.acceleration * at.length;
  const double end = std::max(0.0, std::min({at.exit, after, speed_ + gain}));
  const double top = std::max({speed_, end, std::min(at.top, (speed_ + end + gain) / 2)});
  double rising = (top - speed_) / (2 * at.acceleration);
  double falling = (top - end) / (2 * at.acceleration);
  if (rising < kNoLength * at.length) rising = 0;
  if (falling < kNoLength * at.length) falling = 0;
  double even = at.length - rising - falling;
  if (even < kNoLength * at.length) {
    even = 0;
    (falling > rising ? falling : rising) = at.length - std::min(rising, falling);
  }
  if (rising > 0) add(rising, speed_, top, at.acceleration, in_sight);
  if (even > 0) add(even, top, top, 0, in_sight);
  if (falling > 0) add(falling, top, end, -at.acceleration, in_sight);
  speed_ = end;
  first_ = (first_ + 1) % nodes_.size();
  --count_;
  if (--due_ != 0) return;
  pending_.stop = finished_;
  // What follows is not known yet: the same, more often than not.
  const double next = finished_ ? 0 : pending_.acceleration;
  if (finished_) speed_ = 0;
  finished_ = false;
  give_pending(next);
}

// A phase from one speed to the other, both squared; one with the phase before it where it goes on.
void TrapezoidPlan::add(double length, double speed, double end_speed, double acceleration, bool in_sight) {
  const double from = std::sqrt(speed);
  const double duration = 2 * length / (from + std::sqrt(end_speed));
  const bool goes_on = pending_.length > 0 && same(pending_.acceleration, acceleration) &&
                       (acceleration != 0 || same(pending_.speed, from)) && pending_.short_sight == !in_sight;
  if (!goes_on) {
    give_pending(acceleration);
    pending_ = Phase{0, 0, from, acceleration, 0, 0, false, !in_sight};
  }
  pending_.length += length;
  pending_.duration += duration;
}

void TrapezoidPlan::give_pending(double next_acceleration) {
  pending_.next = next_acceleration;
  if (pending_.length > 0) phases_[made_++] = pending_;
  pending_ = Phase{};
}

}  // namespace trammel::planner
