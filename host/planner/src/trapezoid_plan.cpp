#include "trapezoid_plan.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trammel::planner {
namespace {

constexpr std::size_t kChunks = 16;  // per window
constexpr double kNoLength = 1e-9;   // share of a span; less is a remainder of rounding
// Accelerations, or constant speeds, up to this relative difference make one phase.
constexpr double kSameMotion = 1e-6;

bool same_motion(double a, double b) { return std::abs(a - b) <= kSameMotion * std::abs(b); }

}  // namespace

TrapezoidPlan::TrapezoidPlan(std::size_t window) : nodes_(window), chunk_(std::max<std::size_t>(1, window / kChunks)) {}

void TrapezoidPlan::push(const Span& span) {
  const double top = span.speed * span.speed;
  Node& added = nodes_[(first_ + count_++) % nodes_.size()];
  added = {span.length, SpanAcceleration(span), top, std::min(top, span.exit_speed * span.exit_speed), -1, false};
  ++work_.spans;
}

void TrapezoidPlan::finish() {
  ++work_.runs;
  if (count_ == 0) return;
  finished_ = true;
  look_back();
  due_ = count_;
}

// From the last span back to the first one whose entry does not change.
void TrapezoidPlan::look_back() {
  ++work_.windows;
  work_.window_spans += count_;
  double after = 0;
  bool in_sight = finished_;
  for (std::size_t i = count_; i-- != 0;) {
    ++work_.ramps;
    Node& at = node(i);
    const bool corner = at.exit <= after;
    const double slowing = at.acceleration.reached(corner ? at.exit : after, at.length);
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
  ++work_.ramps;
  const Node at = node(0);
  const bool last = count_ == 1;
  const double after = last ? 0 : node(1).entry;
  const bool in_sight = at.exit <= after || (last ? finished_ : node(1).in_sight);
  const double end = std::max(0.0, std::min({at.exit, after, at.acceleration.reached(speed_, at.length)}));
  add_span(at, end, in_sight);
  speed_ = end;
  first_ = (first_ + 1) % nodes_.size();
  --count_;
  if (--due_ != 0) return;
  pending_.stop = finished_;
  // The next phase is not known yet. Most often its acceleration is the same.
  const double next = finished_ ? 0 : pending_.acceleration;
  if (finished_) speed_ = 0;
  finished_ = false;
  give_pending(next);
}

// A span: up from the present speed, constant speed, and down to `end`.
void TrapezoidPlan::add_span(const Node& at, double end, bool in_sight) {
  const double most = std::max(speed_, end);
  const double least = std::min(speed_, end);
  const double more = std::max(0.0, at.length - at.acceleration.length(least, most));
  const double top = std::max(most, std::min(at.top, at.acceleration.reached(most, more, 2)));
  count_parts_ = 0;
  double even = at.length;
  const auto part = [&](double from, double to, double acceleration, double length) {
    if (length < kNoLength * at.length) return;
    even -= length;
    parts_[count_parts_++] = {length, from, to, acceleration};
  };
  at.acceleration.each(speed_, top, part);
  const std::size_t rising = count_parts_;
  at.acceleration.each(end, top, [&](double from, double to, double a, double length) { part(to, from, -a, length); });
  // A remainder of rounding is not a phase; it goes to the longest part.
  if (even < kNoLength * at.length && count_parts_ != 0) {
    const auto longest = std::max_element(parts_.begin(), parts_.begin() + static_cast<std::ptrdiff_t>(count_parts_),
                                          [](const Part& a, const Part& b) { return a.length < b.length; });
    longest->length += std::exchange(even, 0);
  }
  for (std::size_t i = 0; i < rising; ++i) add(parts_[i], in_sight);
  if (even > 0) add({even, top, top, 0}, in_sight);
  for (std::size_t i = count_parts_; i-- > rising;) add(parts_[i], in_sight);
}

// Adds a part between two squares of speeds as a phase, or extends the phase before if that continues in the part.
void TrapezoidPlan::add(const Part& part, bool in_sight) {
  const double from = std::sqrt(part.from);
  const double duration = 2 * part.length / (from + std::sqrt(part.to));
  const double acceleration = part.acceleration;
  const bool goes_on = pending_.length > 0 && same_motion(pending_.acceleration, acceleration) &&
                       (acceleration != 0 || same_motion(pending_.speed, from)) && pending_.short_sight == !in_sight;
  if (!goes_on) {
    give_pending(acceleration);
    pending_ = Phase{0, 0, from, acceleration, 0, 0, false, !in_sight};
  }
  pending_.length += part.length;
  pending_.duration += duration;
}

void TrapezoidPlan::give_pending(double next_acceleration) {
  pending_.next = next_acceleration;
  if (pending_.length > 0) phases_[made_++] = pending_;
  pending_ = Phase{};
}

}  // namespace trammel::planner
