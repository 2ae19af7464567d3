#include "trammel/planner/s_curve_plan.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "rise.hpp"
#include "speed_caps.hpp"
#include "speed_window.hpp"

namespace trammel::planner {
namespace {

constexpr int kNoCap = -1;
static_assert(SCurvePlan::kMaxRamps == 10 + 3 * (2 + 2 * (kMaxTries + 4)));

// A stretch between two places without acceleration. In it, the speed is limited only by the ramps from its ends, by
// the caps of the tree below `cap`, and by `most`. None of these caps is below `to`.
struct Gap {
  double begin = 0;
  double end = 0;
  double from = 0;
  double to = 0;
  double most = kInfinite;
  int cap = kNoCap;
};

// How much rounding may change the length of a ramp. Speeds have a relative error of some 2^-48. The length of a short
// ramp is proportional to the square root of the difference dv of its speeds, so it changes by up to 1 / (2 dv) of
// itself per mm/s. From Rise::kSameSpeed on that is at most 2^-19 of the length.
double uncertainty(double length, double low, double high) {
  return length > 0 ? length * (high / (high - low)) * 0x1p-49 : 0;
}

bool is_level(const Phase& phase) { return phase.acceleration == 0 && phase.jerk == 0; }

}  // namespace

// Plans the lowest cap first. If ramps from both ends of a gap reach the cap, it splits the gap in two; else the gap is
// one ramp up and one ramp down. So a ramp never meets a cap that is not planned yet, and planned parts never change.
class SCurvePlan::Impl {
 public:
  Impl(std::size_t window, std::function<void()> meanwhile, PlanWork& work)
      : meanwhile_(std::move(meanwhile)), work_(work), window_(window), caps_(window), rise_(window) {
    gaps_.reserve(4 * window + 4);
    fall_.reserve(4 * window + 4);
    for (std::vector<Phase>* phases : {&planned_, &tail_, &given_}) phases->reserve(8 * window + 8);
  }

  bool full() const { return finishing_ || window_.full(); }
  void push(const Span& span) {
    window_.push(span);
    caps_.push(span);
    ++work_.spans;
  }
  void finish() {
    finishing_ = true;
    ++work_.runs;
  }
  bool next(Phase& phase);

 private:
  bool plan();
  bool lead(Gap& gap);
  bool passes(double begin, double end, double low, double high) const;
  bool divide(Gap gap);
  bool divide_below(Gap gap);
  bool hop(const Gap& gap);
  void take_up(double length, std::size_t first);
  double peak(const Gap& gap);
  void begin_ramp();
  double rising(const Gap& gap, double to);
  double falling(const Gap& gap, double from);
  void put(const Phase& phase);
  void give();
  std::size_t phases_until(double position) const;
  double give_until(double position, double least);
  double give_phases(std::size_t count);
  double split(double length);
  double rounding() const { return window_.length() * 0x1p-40; }

  std::function<void()> meanwhile_;
  PlanWork& work_;
  SpeedWindow window_;
  SpeedCaps caps_;
  Rise rise_;
  std::vector<Phase> fall_;     // falling phases of one gap
  std::vector<Gap> gaps_;       // still to plan, the next one last
  std::vector<Phase> planned_;  // the result of plan()
  std::vector<Phase> tail_;     // rest of the last plan, from the window's beginning on; begins at tail_begin_
  std::size_t tail_begin_ = 0;
  double tail_length_ = 0;
  std::vector<Phase> given_;  // phases that no later span changes; not yet taken from given_begin_ on
  std::size_t given_begin_ = 0;
  double speed_ = 0;         // at the window's beginning
  double acceleration_ = 0;  // the same place; not above 0
  bool finishing_ = false;
  bool lead_short_sight_ = false;  // of the last phase given
  bool short_sight_ = false;       // for the phases that put() adds
};

bool SCurvePlan::Impl::next(Phase& phase) {
  if (given_begin_ == given_.size()) {
    if (window_.empty()) finishing_ = false;
    if (!full() || window_.empty()) return false;
    give();
  }
  phase = given_[given_begin_++];
  phase.stop = finishing_ && window_.empty() && given_begin_ == given_.size();
  return true;
}

// If the motion at the window's beginning does not fit the new plan, the plan before still holds. Only the least is
// given of it, because the next plan may fit. At rest every plan fits.
void SCurvePlan::Impl::give() {
  given_.clear();
  given_begin_ = 0;
  window_.index();
  ++work_.windows;
  work_.window_spans += window_.size();
  const double share = std::min(window_.position(window_.size() / 16), window_.length() / 16);
  const double least = std::max({share, window_.position(1), 2 * rounding()});
  double position = least;
  if (plan()) {
    tail_.swap(planned_);
    tail_begin_ = 0;
    tail_length_ = window_.length();
    position = finishing_ ? kInfinite : std::max(least, window_.position(window_.size() / 2));
  }
  position = give_until(position, least);
  if (given_.empty()) throw std::logic_error("the speed plan does not go on: no motion fits where it begins at rest");
  if (tail_begin_ == tail_.size()) position = tail_length_;
  tail_length_ -= position;
  const bool more = tail_begin_ != tail_.size();
  speed_ = more ? tail_[tail_begin_].speed : 0;
  acceleration_ = more ? std::min(0.0, tail_[tail_begin_].acceleration) : 0;
  lead_short_sight_ = given_.back().short_sight;
  caps_.drop(window_.drop_before(position));
}

// Number of phases of the tail to give: up to `position`, so that the last one ends without acceleration. An end before
// a rise of the speed is better, because a later plan may need to fall earlier, but it must not be before a quarter of
// `position`.
std::size_t SCurvePlan::Impl::phases_until(double position) const {
  std::size_t last = 0;
  std::size_t rises = 0;
  double at = 0;
  for (std::size_t i = tail_begin_; i < tail_.size() && at <= position; ++i) {
    const Phase& phase = tail_[i];
    if (phase.acceleration == 0) last = i - tail_begin_;
    if (phase.acceleration == 0 && phase.jerk > 0 && at >= position / 4) rises = last;
    at += phase.length;
  }
  if (at <= position) return tail_.size() - tail_begin_;
  return rises != 0 && tail_[tail_begin_ + last].jerk < 0 ? rises : last;
}

// Gives phases up to about `position`, to a place without acceleration. If the speed is falling there, gives `least`
// only, because the next plan may not need the fall.
double SCurvePlan::Impl::give_until(double position, double least) {
  double at = give_phases(phases_until(position));
  if (tail_begin_ == tail_.size()) return at;
  const Phase& next = tail_[tail_begin_];
  if (is_level(next)) return at + split(position - at);
  if (at >= least) return at;
  if (next.acceleration > 0 || (next.acceleration == 0 && next.jerk > 0)) {
    do {
      at += give_phases(1);
    } while (tail_begin_ < tail_.size() && tail_[tail_begin_].acceleration > 0);
    return at;
  }
  while (tail_begin_ < tail_.size() && at + tail_[tail_begin_].length <= least) at += give_phases(1);
  return at + split(least - at);
}

double SCurvePlan::Impl::give_phases(std::size_t count) {
  double length = 0;
  for (; count > 0; --count) {
    length += tail_[tail_begin_].length;
    given_.push_back(tail_[tail_begin_++]);
  }
  return length;
}

// Gives the first `length` of the next phase, whose speed must not rise, if the phase is longer. Returns the length
// given.
double SCurvePlan::Impl::split(double length) {
  if (tail_begin_ == tail_.size() || !(length > rounding())) return 0;
  Phase& next = tail_[tail_begin_];
  if (!(length < next.length)) return 0;
  const double end = end_speed(next);
  const double behind = next.acceleration + next.duration * next.jerk;
  const double left = rising_time(next.length - length, end, -behind, next.jerk, next.duration);
  given_.push_back(next);
  given_.back().length = length;
  given_.back().duration = next.duration - left;
  next.length -= length;
  next.duration = left;
  next.speed = end - (behind - next.jerk / 2 * left) * left;
  next.acceleration = next.acceleration == 0 && next.jerk == 0 ? 0 : behind - next.jerk * left;
  return length;
}

bool SCurvePlan::Impl::plan() {
  planned_.clear();
  gaps_.clear();
  Gap all;
  all.end = window_.length();
  all.from = speed_;
  all.cap = caps_.build(window_, speed_);
  if (!lead(all)) return false;
  gaps_.push_back(all);
  while (!gaps_.empty()) {
    const Gap gap = gaps_.back();
    gaps_.pop_back();
    if (!divide(gap)) return false;
  }
  return true;
}

// Continues from a falling speed to acceleration 0, with the jerk of each span.
bool SCurvePlan::Impl::lead(Gap& gap) {
  double fall = -acceleration_;
  short_sight_ = lead_short_sight_;
  for (std::size_t i = 0; fall > 0; ++i) {
    if (i == window_.size()) return false;
    const Span& span = window_[i];
    const Span& behind = window_[std::min(i + 1, window_.size() - 1)];
    const double jerk = std::min(span.jerk, behind.jerk);
    const double duration = fall / jerk;
    const double speed = gap.from - fall / 2 * duration;
    if (!(speed > 0)) return false;
    const double length = (speed + fall / 6 * duration) * duration;
    const double room = window_.position(i + 1) - gap.begin;
    if (length <= room) {
      put({length, duration, gap.from, -fall, jerk});
      gap.begin += length;
      gap.from = speed;
      return true;
    }
    const double time = duration - rising_time(length - room, speed, 0, jerk, duration);
    put({room, time, gap.from, -fall, jerk});
    gap.from -= (fall - jerk / 2 * time) * time;
    gap.begin = window_.position(i + 1);
    fall -= jerk * time;
    if (gap.from > std::min(span.exit_speed, behind.speed) || fall > behind.acceleration) return false;
  }
  return true;
}

// Whether begin .. end is too short to get from `low` at one end to `high`. The highest limits of the whole window
// decide most cases.
bool SCurvePlan::Impl::passes(double begin, double end, double low, double high) const {
  const double length = end - begin;
  return reach_length(low, high, window_.most()) >= length ||
         (!window_.uniform() && reach_length(low, high, window_.range(begin, end).most) >= length);
}

void SCurvePlan::Impl::begin_ramp() {
  if (meanwhile_) meanwhile_();
  ++work_.ramps;
}

// Length of a ramp from the gap's beginning to the speed `to`; the ramp is in rise_.
double SCurvePlan::Impl::rising(const Gap& gap, double to) {
  begin_ramp();
  return rise_.plan(window_.from(gap.begin, gap.end), gap.from, to);
}

// The same for a ramp from the speed `from` to the gap's end.
double SCurvePlan::Impl::falling(const Gap& gap, double from) {
  begin_ramp();
  return rise_.plan(window_.back_from(gap.end, gap.begin), gap.to, from);
}

bool SCurvePlan::Impl::divide(Gap gap) {
  while (gap.cap != kNoCap) {
    const Cap& cap = caps_[gap.cap];
    if (passes(gap.begin, cap.end, gap.from, cap.speed)) {
      gap.cap = cap.after;
    } else if (passes(cap.begin, gap.end, gap.to, cap.speed)) {
      gap.cap = cap.before;
    } else {
      break;
    }
  }
  if (gap.cap == kNoCap) return hop(gap);
  const Cap& cap = caps_[gap.cap];
  if (gap.from > cap.speed) return divide_below(gap);
  const double risen = gap.begin + rising(gap, cap.speed);
  const double falls = gap.end - falling(gap, cap.speed);
  if (risen > falls) {
    gap.most = cap.speed;
    gap.cap = kNoCap;
    return hop(gap);
  }
  // The speed is at the cap from `first` to `last`. On either side, it may be above the cap if the cap is reached in
  // time.
  const bool early = risen < cap.begin;
  const bool late = falls > cap.end;
  const double first = early ? std::min(cap.begin, falls) : risen;
  const double last = late ? std::max(cap.end, risen) : falls;
  gaps_.push_back({last, gap.end, cap.speed, gap.to, late ? gap.most : cap.speed, late ? cap.after : kNoCap});
  gaps_.push_back({first, last, cap.speed, cap.speed, cap.speed, kNoCap});
  gaps_.push_back({gap.begin, first, gap.from, cap.speed, early ? gap.most : cap.speed, early ? cap.before : kNoCap});
  return true;
}

// The gap begins above the cap.
bool SCurvePlan::Impl::divide_below(Gap gap) {
  const Cap& cap = caps_[gap.cap];
  const double falls = gap.end - falling(gap, cap.speed);
  const bool late = falls > cap.end;
  const double first = std::min(cap.begin, falls);
  const double last = late ? cap.end : falls;
  if (first < gap.begin) return false;
  const Gap above{gap.begin, first, gap.from, cap.speed, gap.most, cap.before};
  if (first - falling(above, gap.from) < gap.begin - rounding()) return false;
  gaps_.push_back({last, gap.end, cap.speed, gap.to, late ? gap.most : cap.speed, late ? cap.after : kNoCap});
  gaps_.push_back({first, last, cap.speed, cap.speed, cap.speed, kNoCap});
  gaps_.push_back(above);
  return true;
}

bool SCurvePlan::Impl::hop(const Gap& gap) {
  if (!(gap.end > gap.begin)) return true;
  const double speed = peak(gap);
  short_sight_ = !finishing_ && gap.end == window_.length() && speed < gap.most;
  fall_.clear();
  const double down = falling(gap, speed);
  rise_.falling(fall_);
  const double up = rising(gap, speed);
  const double steady = gap.end - gap.begin - up - down;
  // The same ramps found the ends of this gap, over a longer way, and fitted there. A shortage is due to rounding.
  const double slack = rounding() + uncertainty(up, gap.from, speed) + uncertainty(down, gap.to, speed);
  if (steady < -slack) return false;
  const std::size_t before = planned_.size();
  rise_.rising(planned_);
  for (std::size_t i = before; i < planned_.size(); ++i) planned_[i].short_sight = short_sight_;
  if (steady >= rounding() || planned_.size() + fall_.size() == before) put({steady, steady / speed, speed, 0, 0});
  for (const Phase& phase : fall_) put(phase);
  if (steady < rounding() && planned_.size() > before) take_up(steady, before);
  return true;
}

// The length that rounding leaves goes to the longest phase from `first` on.
void SCurvePlan::Impl::take_up(double length, std::size_t first) {
  const auto longest = std::max_element(planned_.begin() + static_cast<std::ptrdiff_t>(first), planned_.end(),
                                        [](const Phase& a, const Phase& b) { return a.length < b.length; });
  longest->length += length;
}

// The highest speed in the gap. It is that of the faster end if going up and down again is not worth it.
double SCurvePlan::Impl::peak(const Gap& gap) {
  constexpr double kWorth = 1 + 0x1p-8;
  const double least = std::max(gap.from, gap.to);
  const double worth = std::min(gap.most, least * kWorth);
  const double length = gap.end - gap.begin;
  if (!(gap.most > least)) return least;
  const auto excess_of = [&](RampLimits limits) {
    return [&gap, limits, length](double speed) {
      return ramp_length(gap.from, speed, limits) + ramp_length(gap.to, speed, limits) - length;
    };
  };
  if (excess_of(window_.most())(worth) > 0) return least;
  // Limits that are the same all along give the peak directly. Others give a peak between those of the lowest and the
  // highest limits.
  const SpeedWindow::Range range = window_.range(gap.begin, gap.end);
  const auto simple = [&](RampLimits limits) {
    const auto excess = excess_of(limits);
    const double square = (gap.from * gap.from + gap.to * gap.to) / 2;
    const double top = std::min(gap.most, std::sqrt(square + length * limits.acceleration));
    return top > least && excess(least) < 0 ? highest(least, top, excess) : least;
  };
  const auto excess = [&](double speed) { return rising(gap, speed) + falling(gap, speed) - length; };
  const double speed = simple(range.least);
  if (range.uniform()) return speed >= worth && excess(speed) <= rounding() ? speed : least;
  if (!(excess(worth) < 0)) return least;
  const double high = std::max(worth, simple(range.most));
  constexpr double kShare = 0x1p-20;  // the rest of the length passes at the peak
  return highest(speed > worth && excess(speed) < 0 ? speed : worth, high, excess, kShare);
}

void SCurvePlan::Impl::put(const Phase& phase) {
  if (!(phase.length > 0) || !(phase.duration > 0)) return;
  if (is_level(phase) && !planned_.empty() && is_level(planned_.back()) && planned_.back().speed == phase.speed) {
    planned_.back().length += phase.length;
    planned_.back().duration += phase.duration;
    planned_.back().short_sight |= short_sight_;
    return;
  }
  planned_.push_back(phase);
  planned_.back().short_sight = short_sight_;
}

SCurvePlan::SCurvePlan(std::size_t window, std::function<void()> meanwhile)
    : impl_(std::make_unique<Impl>(std::max<std::size_t>(window, 1), std::move(meanwhile), work_)) {}
SCurvePlan::~SCurvePlan() = default;
bool SCurvePlan::full() const { return impl_->full(); }
void SCurvePlan::push(const Span& span) { impl_->push(span); }
void SCurvePlan::finish() { impl_->finish(); }
bool SCurvePlan::next(Phase& phase) { return impl_->next(phase); }

}  // namespace trammel::planner
