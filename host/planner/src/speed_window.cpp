#include "speed_window.hpp"

#include <algorithm>

namespace trammel::planner {
namespace {

using Range = SpeedWindow::Range;

Range range_of(const Span& span) {
  const RampLimits limits = {span.acceleration, span.jerk};
  return {limits, limits};
}

RampLimits lower(RampLimits a, RampLimits b) {
  return {std::min(a.acceleration, b.acceleration), std::min(a.jerk, b.jerk)};
}

Range joined(const Range& a, const Range& b) {
  const RampLimits most = {std::max(a.most.acceleration, b.most.acceleration), std::max(a.most.jerk, b.most.jerk)};
  return {lower(a.least, b.least), most};
}

// Not worth ramps of their own.
bool alike(const Range& range) {
  constexpr double kAlike = 1.05;
  return range.most.acceleration <= kAlike * range.least.acceleration && range.most.jerk <= kAlike * range.least.jerk;
}

}  // namespace

SpeedWindow::SpeedWindow(std::size_t spans) : most_(spans) {
  spans_.reserve(spans);
  positions_.reserve(spans + 1);
  blocks_.reserve(spans / kBlock + 1);
}

std::size_t SpeedWindow::drop_before(double position) {
  // What rounding leaves of a span is not a span.
  const double nearly = position + length() * 0x1p-44;
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

SpeedWindow::Walk::Walk(const SpeedWindow& window, double from, bool forwards)
    : window_(&window), from_(from), forwards_(forwards) {
  if (window.uniform()) {  // nothing to look for
    at_ = forwards ? window.size() : 0;
    range_ = window.all_;
    end_ = window.length();
    return;
  }
  const auto begin = window.positions_.begin();
  const auto last = window.positions_.end() - 1;
  const auto border = forwards ? std::upper_bound(begin + 1, last, from) - 1 : std::lower_bound(begin + 1, last, from);
  at_ = static_cast<std::size_t>(border - begin);
  next(0);
}

bool SpeedWindow::Walk::next(double need) {
  if (at_ == (forwards_ ? window_->size() : 0)) return false;
  const std::size_t blocks_end = forwards_ ? at_ + kBlock : at_ - std::min(at_, kBlock);
  const bool block = at_ % kBlock == 0 && blocks_end <= window_->size() && distance(blocks_end) < need;
  const std::size_t before = at_;
  at_ = block ? blocks_end : forwards_ ? at_ + 1 : at_ - 1;
  const std::size_t first = std::min(before, at_);
  range_ = block ? window_->blocks_[first / kBlock] : range_of((*window_)[first]);
  end_ = distance(at_);
  return true;
}

// At a border where the limits change much, either the ramp ends there, or it goes on with the lower ones: whichever is
// over sooner should nothing change behind. One ramp all along, where that is better after all.
double SpeedWindow::ramps(Walk walk, double low, double high, std::vector<Ramp>* ramps) const {
  const std::size_t before = ramps == nullptr ? 0 : ramps->size();
  Stretch now{0, low, walk.range().least};
  Range like = walk.range();
  RampLimits least = now.limits;
  double end = walk.end();
  double length = ramp_length(low, high, now.limits);
  while (length > end && walk.next(length)) {
    const Range next = walk.range();
    const RampLimits both = lower(now.limits, next.least);
    const Range wider = joined(like, next);
    like = alike(wider) ? wider : next;
    length = now.begin + ramp_length(now.low, high, both);
    const double middle = alike(wider) ? now.low : ramp_end(now.low, end - now.begin, now.limits);
    const double split = end + ramp_length(middle, high, next.least);
    if (!alike(wider) && split < length) {
      if (ramps != nullptr) ramps->push_back({end - now.begin, now.low, middle, now.limits});
      now = {end, middle, next.least};
      length = split;
    } else {
      now.limits = both;
    }
    least = lower(least, next.least);
    end = walk.end();
  }
  const double one = now.begin == 0 ? length : ramp_length(low, high, least);
  if (one <= length) now = {0, low, least};
  if (ramps != nullptr && now.begin == 0) ramps->resize(before);
  length = std::min(length, one);
  if (ramps != nullptr) ramps->push_back({length - now.begin, now.low, high, now.limits});
  return length;
}

Range SpeedWindow::range(double begin, double end) const {
  if (uniform()) return all_;
  Walk walk(*this, begin, true);
  Range range = walk.range();
  while (walk.end() < end - begin && walk.next(end - begin)) range = joined(range, walk.range());
  return range;
}

}  // namespace trammel::planner
