#include "speed_window.hpp"

#include <algorithm>
#include <cmath>

namespace trammel::planner {
namespace {

using Range = SpeedWindow::Range;

bool has_more_below(const Span& span) {
  const Curve& curve = span.curve;
  return curve.whole > 0 && (curve.at_rest > span.acceleration || curve.jerk_at_rest > span.jerk);
}

Range range_of(const Span& span) {
  const RampLimits limits = {span.acceleration, span.jerk};
  if (!has_more_below(span)) return {limits, limits};
  return {limits, {std::max(limits.acceleration, span.curve.at_rest), std::max(limits.jerk, span.curve.jerk_at_rest)}};
}

RampLimits lower(RampLimits a, RampLimits b) {
  return {std::min(a.acceleration, b.acceleration), std::min(a.jerk, b.jerk)};
}

Range joined(const Range& a, const Range& b) {
  const RampLimits most = {std::max(a.most.acceleration, b.most.acceleration), std::max(a.most.jerk, b.most.jerk)};
  return {lower(a.least, b.least), most};
}

// Whether a ramp over the range as one stretch loses little, against the time in which its acceleration rises.
bool alike(const Range& range, double tolerance) {
  constexpr double kMax = 1.05;
  return range.most.acceleration <= (1 + tolerance) * range.least.acceleration &&
         range.most.jerk <= kMax * range.least.jerk;
}

bool same(const Range& a, const Range& b) {
  return a.least.acceleration == b.least.acceleration && a.least.jerk == b.least.jerk &&
         a.most.acceleration == b.most.acceleration && a.most.jerk == b.most.jerk;
}

}  // namespace

SpeedWindow::SpeedWindow(std::size_t spans) : most_(spans) {
  spans_.reserve(spans);
  positions_.reserve(spans + 1);
  blocks_.reserve(spans / kBlock + 1);
}

std::size_t SpeedWindow::drop_before(double position) {
  // A remainder of rounding is not a span.
  const double nearly = position + length() * 0x1p-40;
  const auto border = std::upper_bound(positions_.begin() + 1, positions_.end(), nearly);
  const auto passed = border - positions_.begin() - 1;
  spans_.erase(spans_.begin(), spans_.begin() + passed);
  if (!spans_.empty()) spans_.front().length = std::min(spans_.front().length, *border - position);
  return static_cast<std::size_t>(passed);
}

void SpeedWindow::index() {
  positions_.assign(1, 0);
  blocks_.clear();
  all_ = range_of(spans_.front());
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    positions_.push_back(positions_.back() + spans_[i].length);
    const Range range = range_of(spans_[i]);
    if (i % kBlock == 0) blocks_.push_back(range);
    blocks_.back() = joined(blocks_.back(), range);
    all_ = joined(all_, range);
  }
}

SpeedWindow::Walk::Walk(const SpeedWindow& window, double from, bool forwards, double to)
    : window_(&window), from_(from), forwards_(forwards) {
  if (window.uniform()) {  // all spans are one stretch
    last_ = forwards ? window.size() : 0;
    at_ = window.size() - last_;
    return;
  }
  const auto begin = window.positions_.begin();
  const auto last = window.positions_.end() - 1;
  const auto up = [&](double place) {
    return static_cast<std::size_t>(std::lower_bound(begin + 1, last, place) - begin);
  };
  const auto down = [&](double place) {
    return static_cast<std::size_t>(std::upper_bound(begin + 1, last, place) - begin - 1);
  };
  at_ = forwards ? down(from) : up(from);
  last_ = forwards ? std::max(up(to), at_ + 1) : std::min(down(to), at_ - 1);
}

bool SpeedWindow::Walk::take_block(Range& range) {
  const std::size_t end = forwards_ ? at_ + kBlock : at_ - std::min(at_, kBlock);
  if (at_ % kBlock != 0 || (forwards_ ? end > last_ : at_ < last_ + kBlock)) return false;
  const Range& block = window_->blocks_[std::min(at_, end) / kBlock];
  if (!same(block, range)) return false;
  at_ = end;
  return true;
}

SpeedWindow::Stretch SpeedWindow::Walk::next(double speed, double time) {
  constexpr double kBrief = 1.0 / 8;   // of the time in which the acceleration rises
  constexpr double kShare = 1.0 / 8;   // of that time, the loss over a whole ramp
  constexpr double kTolerance = 0.05;  // largest tolerance
  constexpr double kMin = 0x1p-12;     // smallest tolerance
  if (window_->uniform()) {
    at_ = last_;
    Stretch all;
    all.end = distance(at_);
    all.limits = window_->least();
    return all;
  }
  const double begin = end_;
  const std::size_t first = at_;
  const Span& span = (*window_)[span_at(at_)];
  Range range = range_of(span);
  at_ = forwards_ ? at_ + 1 : at_ - 1;
  while (!ended()) {
    if (take_block(range)) continue;
    const Range next = range_of((*window_)[span_at(at_)]);
    const std::size_t behind = forwards_ ? at_ + 1 : at_ - 1;
    if (!same(next, range)) {
      const Range both = joined(range, next);
      const double rise = both.least.acceleration / both.least.jerk;
      if (distance(behind) - begin > speed * rise * kBrief) {
        const double length = distance(at_) - begin;
        const double now = std::sqrt(speed * speed + 2 * both.least.acceleration * length);
        const double passed = time + 2 * length / (speed + now);
        if (!alike(both, std::clamp(kShare * rise / passed, kMin, kTolerance))) break;
      }
      range = both;
    }
    at_ = behind;
  }
  end_ = distance(at_);
  Stretch stretch;
  stretch.end = end_;
  stretch.limits = range.least;
  // A stretch too short for a piece of its own becomes part of a neighbour's piece, so the neighbour's jerk limits it
  // too.
  const auto beside = [&stretch](double jerk) {
    if (2.5 * jerk < stretch.limits.jerk) return;
    stretch.limits.jerk = std::min(stretch.limits.jerk, jerk);
    stretch.jerk_beside = std::min(stretch.jerk_beside, jerk);
  };
  if (begin > 0) beside((*window_)[forwards_ ? first - 1 : first].jerk);
  if (!ended()) beside((*window_)[span_at(at_)].jerk);
  const bool alone = at_ == (forwards_ ? first + 1 : first - 1);
  if (alone && has_more_below(span)) stretch.arc = &span;
  return stretch;
}

Range SpeedWindow::range(double begin, double end) const {
  if (uniform()) return all_;
  const auto first = positions_.begin();
  const auto last = positions_.end() - 1;
  auto i = static_cast<std::size_t>(std::upper_bound(first + 1, last, begin) - first - 1);
  const auto end_border = static_cast<std::size_t>(std::lower_bound(first + 1, last, end) - first);
  Range range = range_of(spans_[i]);
  while (i < end_border) {
    const bool block = i % kBlock == 0 && i + kBlock <= end_border;
    range = joined(range, block ? blocks_[i / kBlock] : range_of(spans_[i]));
    i += block ? kBlock : 1;
  }
  return range;
}

}  // namespace trammel::planner
