#include "trammel/planner/s_curve_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "s_ramp.hpp"
#include "speed_caps.hpp"
#include "speed_window.hpp"

namespace trammel::planner {
namespace {

constexpr int kNoCap = -1;

// A stretch between two places without acceleration. Ramps that start there and the caps of the tree below `cap` are
// all that limits the speed between, and `most`. None of the caps is below `to`.
struct Gap {
  double begin = 0;
  double end = 0;
  double from = 0;
  double to = 0;
  double most = kInfinite;
  int cap = kNoCap;
};

}  // namespace

// The lowest cap first: where ramps from the gap's ends reach it, it splits the gap in two; where they do not, the gap
// is a ramp up and one down. So a ramp never meets a cap that is still to come, and what has been planned stays.
class SCurvePlan::Impl {
 public:
  explicit Impl(std::size_t window) : window_(window), caps_(window) {
    gaps_.reserve(4 * window + 4);
    ramps_.reserve(2 * window + 2);
    for (std::vector<Ramp>* ramps : {&planned_, &tail_, &given_}) ramps->reserve(8 * window + 8);
  }

  bool full() const { return finishing_ || window_.full(); }
  void push(const Span& span) {
    window_.push(span);
    caps_.push(span);
  }
  void finish() { finishing_ = true; }
  bool next(Phase& phase);

 private:
  bool plan();
  bool passes(double begin, double end, double low, double high) const;
  bool divide(Gap gap);
  bool divide_below(Gap gap);
  bool hop(const Gap& gap);
  double peak(const Gap& gap, const SpeedWindow::Walk& forwards, const SpeedWindow::Walk& backwards) const;
  void put(const Ramp& ramp);
  void open_phases();
  void give();
  std::size_t ramps_until(double position) const;
  double give_until(double position);
  double rounding() const { return window_.length() * 0x1p-40; }

  SpeedWindow window_;
  SpeedCaps caps_;
  std::vector<Ramp> ramps_;    // of one way down
  std::vector<Gap> gaps_;      // still to plan, the next one last
  std::vector<Ramp> planned_;  // what plan() makes
  std::vector<Ramp> tail_;     // the last plan from the window's beginning on, from tail_begin_
  std::size_t tail_begin_ = 0;
  std::vector<Ramp> given_;  // what no later span changes, from given_begin_
  std::size_t given_begin_ = 0;
  std::array<Phase, 3> phases_;  // of the last one taken from given_
  unsigned phase_ = 0;
  unsigned phase_count_ = 0;
  double speed_ = 0;  // at the window's beginning
  bool finishing_ = false;
  bool short_sight_ = false;  // of the ramps that are put
};

bool SCurvePlan::Impl::next(Phase& phase) {
  while (phase_ == phase_count_) {
    if (given_begin_ < given_.size()) {
      open_phases();
      continue;
    }
    if (window_.empty()) finishing_ = false;
    if (!full() || window_.empty()) return false;
    give();
  }
  phase = phases_[phase_++];
  return true;
}

void SCurvePlan::Impl::open_phases() {
  const Ramp& ramp = given_[given_begin_++];
  phase_ = 0;
  phase_count_ = phases_of(ramp, phases_);
  if (!finishing_ || !window_.empty() || given_begin_ != given_.size() || phase_count_ == 0) return;
  phases_[phase_count_ - 1].stop = true;
}

// When the speed at the window's beginning is too high for the new plan, what was planned before still holds.
void SCurvePlan::Impl::give() {
  given_.clear();
  given_begin_ = 0;
  window_.index();
  double position = 0;
  if (plan()) {
    tail_.swap(planned_);
    tail_begin_ = 0;
    position = give_until(finishing_ ? kInfinite : window_.position(window_.size() / 2));
  } else {
    given_.push_back(tail_[tail_begin_++]);
    position = given_.back().length;
  }
  speed_ = given_.back().to;
  caps_.drop(window_.drop_before(position));
}

// How many ramps of the tail end up to `position`, better where the speed rises next: a later plan may want to fall
// earlier. Not less than a quarter for that.
std::size_t SCurvePlan::Impl::ramps_until(double position) const {
  std::size_t last = 0;
  std::size_t rises = 0;
  double at = 0;
  for (std::size_t i = tail_begin_; i < tail_.size() && at <= position; ++i) {
    last = i - tail_begin_;
    if (tail_[i].to > tail_[i].from && at >= position / 4) rises = last;
    at += tail_[i].length;
  }
  if (at <= position) return tail_.size() - tail_begin_;
  return rises != 0 && tail_[tail_begin_ + last].to < tail_[tail_begin_ + last].from ? rises : last;
}

// At least one ramp. Ends where there is no acceleration.
double SCurvePlan::Impl::give_until(double position) {
  double at = 0;
  for (std::size_t count = std::max<std::size_t>(ramps_until(position), 1); count > 0; --count) {
    at += tail_[tail_begin_].length;
    given_.push_back(tail_[tail_begin_++]);
  }
  if (tail_begin_ == tail_.size()) return window_.length();
  Ramp& next = tail_[tail_begin_];
  if (next.from != next.to || at + next.length <= position || at >= position) return at;
  given_.push_back(next);
  given_.back().length = position - at;
  next.length -= position - at;
  return position;
}

bool SCurvePlan::Impl::plan() {
  planned_.clear();
  gaps_.clear();
  Gap all;
  all.end = window_.length();
  all.from = speed_;
  all.cap = caps_.build(window_, speed_);
  gaps_.push_back(all);
  while (!gaps_.empty()) {
    const Gap gap = gaps_.back();
    gaps_.pop_back();
    if (!divide(gap)) return false;
  }
  return true;
}

// Whether no motion gets from `low` at one end to `high` within begin .. end. The highest limits of all decide most.
bool SCurvePlan::Impl::passes(double begin, double end, double low, double high) const {
  const double length = end - begin;
  return reach_length(low, high, window_.most()) >= length ||
         (!window_.uniform() && reach_length(low, high, window_.range(begin, end).most) >= length);
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
  const double risen = gap.begin + window_.rising(gap.begin, gap.from, cap.speed);
  const double falls = gap.end - window_.falling(gap.end, cap.speed, gap.to);
  if (risen > falls) {
    gap.most = cap.speed;
    gap.cap = kNoCap;
    return hop(gap);
  }
  // At the cap from `first` to `last`; what comes before and after may be above it where the cap is reached in time.
  const bool early = risen < cap.begin;
  const bool late = falls > cap.end;
  const double first = early ? std::min(cap.begin, falls) : risen;
  const double last = late ? std::max(cap.end, risen) : falls;
  gaps_.push_back({last, gap.end, cap.speed, gap.to, late ? gap.most : cap.speed, late ? cap.after : kNoCap});
  gaps_.push_back({first, last, cap.speed, cap.speed, cap.speed, kNoCap});
  gaps_.push_back({gap.begin, first, gap.from, cap.speed, early ? gap.most : cap.speed, early ? cap.before : kNoCap});
  return true;
}

// The window begins above the cap.
bool SCurvePlan::Impl::divide_below(Gap gap) {
  const Cap& cap = caps_[gap.cap];
  const double falls = gap.end - window_.falling(gap.end, cap.speed, gap.to);
  const bool late = falls > cap.end;
  const double first = std::min(cap.begin, falls);
  const double last = late ? cap.end : falls;
  if (first - window_.falling(first, gap.from, cap.speed) < gap.begin - rounding()) return false;
  gaps_.push_back({last, gap.end, cap.speed, gap.to, late ? gap.most : cap.speed, late ? cap.after : kNoCap});
  gaps_.push_back({first, last, cap.speed, cap.speed, cap.speed, kNoCap});
  gaps_.push_back({gap.begin, first, gap.from, cap.speed, gap.most, cap.before});
  return true;
}

bool SCurvePlan::Impl::hop(const Gap& gap) {
  if (!(gap.end > gap.begin)) return true;
  const SpeedWindow::Walk forwards = window_.from(gap.begin);
  const SpeedWindow::Walk backwards = window_.back_from(gap.end);
  const double speed = peak(gap, forwards, backwards);
  short_sight_ = !finishing_ && gap.end == window_.length() && speed < gap.most;
  ramps_.clear();
  const double down = window_.ramps(backwards, gap.to, speed, &ramps_);
  const std::size_t falling = ramps_.size();
  const double up = window_.ramps(forwards, gap.from, speed, &ramps_);
  const double steady = gap.end - gap.begin - up - down;
  if (steady < -rounding()) return false;
  // What rounding leaves goes to a ramp.
  const bool none = steady < rounding() && up + down > 0;
  if (none) (up > 0 ? ramps_.back() : ramps_[falling - 1]).length += steady;
  for (std::size_t i = falling; i < ramps_.size(); ++i) put(ramps_[i]);
  if (!none) put({steady, speed, speed, {}});
  for (std::size_t i = falling; i > 0; --i) {
    Ramp ramp = ramps_[i - 1];
    std::swap(ramp.from, ramp.to);
    put(ramp);
  }
  return true;
}

// The highest speed in the gap: that of one of its ends where going up and down again is not worth it.
double SCurvePlan::Impl::peak(const Gap& gap, const SpeedWindow::Walk& forwards,
                              const SpeedWindow::Walk& backwards) const {
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
  // Limits that are the same all along give a peak that is simple; others one between those of the least and the most.
  const SpeedWindow::Range range = window_.range(gap.begin, gap.end);
  const auto simple = [&](RampLimits limits) {
    const auto excess = excess_of(limits);
    const double square = (gap.from * gap.from + gap.to * gap.to) / 2;
    const double top = std::min(gap.most, std::sqrt(square + length * limits.acceleration));
    return top > least && excess(least) < 0 ? highest_speed(least, top, excess) : least;
  };
  const auto excess = [&](double speed) {
    return window_.ramps(forwards, gap.from, speed) + window_.ramps(backwards, gap.to, speed) - length;
  };
  const double speed = simple(range.least);
  if (range.uniform()) return speed >= worth && excess(speed) <= rounding() ? speed : least;
  if (!(excess(worth) < 0)) return least;
  const double high = std::max(worth, simple(range.most));
  return speed > worth && excess(speed) < 0 ? highest_speed(speed, high, excess) : highest_speed(worth, high, excess);
}

void SCurvePlan::Impl::put(const Ramp& ramp) {
  if (!(ramp.length > 0)) return;
  if (ramp.from == ramp.to && !planned_.empty() && planned_.back().to == ramp.from &&
      planned_.back().from == ramp.from) {
    planned_.back().length += ramp.length;
    planned_.back().short_sight |= short_sight_;
    return;
  }
  planned_.push_back(ramp);
  planned_.back().short_sight = short_sight_;
}

SCurvePlan::SCurvePlan(std::size_t window) : impl_(std::make_unique<Impl>(std::max<std::size_t>(window, 1))) {}
SCurvePlan::~SCurvePlan() = default;
bool SCurvePlan::full() const { return impl_->full(); }
void SCurvePlan::push(const Span& span) { impl_->push(span); }
void SCurvePlan::finish() { impl_->finish(); }
bool SCurvePlan::next(Phase& phase) { return impl_->next(phase); }

}  // namespace trammel::planner
