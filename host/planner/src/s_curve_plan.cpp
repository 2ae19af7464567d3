#include "trammel/planner/s_curve_plan.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "s_ramp.hpp"
#include "speed_caps.hpp"
#include "speed_window.hpp"

namespace trammel::planner {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
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
  bool divide(Gap gap);
  bool divide_below(Gap gap);
  bool hop(const Gap& gap);
  bool peak(const Gap& gap, Hop& hop, double& speed) const;
  void put(double length, double from, double to, RampLimits limits);
  void open_phases();
  void give();
  std::size_t ramps_until(double position) const;
  double give_until(double position);
  double rounding() const { return window_.length() * 0x1p-40; }

  SpeedWindow window_;
  SpeedCaps caps_;
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

bool SCurvePlan::Impl::divide(Gap gap) {
  while (gap.cap != kNoCap) {
    const Cap& cap = caps_[gap.cap];
    // The quick look with the highest limits decides most of them.
    const auto far = [&](double low, double room, auto reach) {
      return reach_length(low, cap.speed, window_.most()) >= room || (!window_.uniform() && reach() >= room);
    };
    if (far(gap.from, cap.end - gap.begin, [&] { return window_.reach_rising(gap.begin, gap.from, cap.speed); })) {
      gap.cap = cap.after;
    } else if (far(gap.to, gap.end - cap.begin, [&] { return window_.reach_falling(gap.end, cap.speed, gap.to); })) {
      gap.cap = cap.before;
    } else {
      break;
    }
  }
  if (gap.cap == kNoCap) return hop(gap);
  const Cap& cap = caps_[gap.cap];
  if (gap.from > cap.speed) return divide_below(gap);
  const double risen = gap.begin + window_.rising(gap.begin, gap.from, cap.speed).length;
  const double falls = gap.end - window_.falling(gap.end, cap.speed, gap.to).length;
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
  const double falls = gap.end - window_.falling(gap.end, cap.speed, gap.to).length;
  const bool late = falls > cap.end;
  const double first = std::min(cap.begin, falls);
  const double last = late ? cap.end : falls;
  if (first - window_.falling(first, gap.from, cap.speed).length < gap.begin - rounding()) return false;
  gaps_.push_back({last, gap.end, cap.speed, gap.to, late ? gap.most : cap.speed, late ? cap.after : kNoCap});
  gaps_.push_back({first, last, cap.speed, cap.speed, cap.speed, kNoCap});
  gaps_.push_back({gap.begin, first, gap.from, cap.speed, gap.most, cap.before});
  return true;
}

bool SCurvePlan::Impl::hop(const Gap& gap) {
  const double length = gap.end - gap.begin;
  if (!(length > 0)) return true;
  Hop limits;
  double top = 0;
  const bool goes_up = peak(gap, limits, top);
  short_sight_ = !finishing_ && gap.end == window_.length() && top < gap.most;
  if (goes_up) {
    const double up = ramp_length(gap.from, top, limits.up);
    const double down = ramp_length(gap.to, top, limits.down);
    const double steady = length - up - down;
    const bool none = steady < rounding();
    put(none ? up + steady : up, gap.from, top, limits.up);
    if (!none) put(steady, top, top, limits.up);
    put(down, top, gap.to, limits.down);
    return true;
  }
  const bool rises = gap.from < gap.to;
  const SpeedWindow::Fit ramp =
      rises ? window_.rising(gap.begin, gap.from, gap.to) : window_.falling(gap.end, gap.from, gap.to);
  const double rest = length - ramp.length;
  if (rest < -rounding()) return false;
  const bool whole = rest < rounding() && gap.from != gap.to;
  if (!rises && !whole) put(rest, gap.from, gap.from, ramp.limits);
  put(whole ? length : ramp.length, gap.from, gap.to, ramp.limits);
  if (rises && !whole) put(rest, gap.to, gap.to, ramp.limits);
  return true;
}

// Whether going up and down again is worth it, with which limits, and up to which speed.
bool SCurvePlan::Impl::peak(const Gap& gap, Hop& hop, double& speed) const {
  constexpr double kWorth = 1 + 0x1p-8;
  const double least = std::max(gap.from, gap.to);
  if (!(gap.most > least)) return false;
  // Most are not, which the highest limits show.
  const double worth = std::min(gap.most, least * kWorth);
  const RampLimits highest = window_.most();
  if (ramp_length(gap.from, worth, highest) + ramp_length(gap.to, worth, highest) > gap.end - gap.begin) return false;
  hop = {gap.end - gap.begin, gap.from, gap.to, window_.limits(gap.begin, gap.end), {}};
  hop.down = hop.up;
  speed = peak_speed(hop, gap.most);
  // What the ramps do not touch does not limit them.
  double higher = speed;
  for (int i = 0; i < 4 && !window_.uniform(); ++i) {
    const SpeedWindow::Fit up = window_.rising(gap.begin, gap.from, higher);
    const SpeedWindow::Fit down = window_.falling(gap.end, higher, gap.to);
    if (up.length + down.length > hop.length) break;
    speed = higher;
    hop.up = up.limits;
    hop.down = down.limits;
    higher = peak_speed(hop, gap.most);
    if (!(higher > speed)) break;
  }
  return speed >= worth;
}

void SCurvePlan::Impl::put(double length, double from, double to, RampLimits limits) {
  if (!(length > 0)) return;
  if (from == to && !planned_.empty() && planned_.back().to == from && planned_.back().from == from) {
    planned_.back().length += length;
    planned_.back().short_sight |= short_sight_;
    return;
  }
  planned_.push_back({length, from, to, limits, short_sight_});
}

SCurvePlan::SCurvePlan(std::size_t window) : impl_(std::make_unique<Impl>(std::max<std::size_t>(window, 1))) {}
SCurvePlan::~SCurvePlan() = default;
bool SCurvePlan::full() const { return impl_->full(); }
void SCurvePlan::push(const Span& span) { impl_->push(span); }
void SCurvePlan::finish() { impl_->finish(); }
bool SCurvePlan::next(Phase& phase) { return impl_->next(phase); }

}  // namespace trammel::planner
