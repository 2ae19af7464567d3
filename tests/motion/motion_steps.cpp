#include <cmath>
#include <deque>

#include "motion_judge.hpp"
#include "motion_walk.hpp"

namespace trammel::test {
namespace {

// Follows the steps along the motion. What comes before a start's first step is kept until that step is found in the
// reading: then the two clocks are known to belong together.
class StepJudge {
 public:
  explicit StepJudge(const std::vector<TimedStep>& steps) : steps_(steps) {}

  void start() {
    found_ = false;
    waiting_.clear();
    path_begin_ = counts_;  // every path ends on whole pulses
  }

  void interval(const Interval& now) {
    if (found_) return follow(now);
    waiting_.push_back(now);
    const auto first = first_step(now);
    if (!first) return;
    if (next_ == steps_.size()) throw std::runtime_error("a step is missing");
    offset_ = static_cast<double>(steps_[next_].cycle) - *first;
    found_ = true;
    // The look for the first step has moved the path's beginning along: back to the start.
    path_begin_ = counts_;
    path_ = nullptr;
    for (const Interval& one : waiting_) follow(one);
  }

  void stop() {
    while (next_ < steps_.size() && is_before(steps_[next_], stop_clock_ + kSettle)) take(end_);
    for (std::size_t a = 0; a < end_.size(); ++a) look(end_[a], a);
    path_ = nullptr;
  }

  double farthest = 0;
  std::size_t left() const { return steps_.size() - next_; }

 private:
  using Place = std::array<double, card_map::kMaxAxes>;
  using Counts = std::array<std::int64_t, card_map::kMaxAxes>;
  static constexpr double kSettle = 1000;  // clocks in which shapers give what they hold

  static double ticks(const Interval& now, double clocks) {
    return static_cast<double>(now.ticks) + static_cast<double>(now.phase) * 0x1p-48 +
           static_cast<double>(now.rate) * 0x1p-48 * clocks;
  }

  void enter(const Interval& now) {
    if (path_ == now.path && !now.begins_path) return;
    if (path_ != nullptr) {
      for (std::size_t a = 0; a < path_begin_.size(); ++a) {
        path_begin_[a] += std::llround(static_cast<double>(path_->increment[a]) * 0x1p-40 * static_cast<double>(path_->ticks));
      }
    }
    path_ = now.path;
  }

  double place(std::size_t axis, double ticks_gone) const {
    return static_cast<double>(path_begin_[axis]) + static_cast<double>(path_->increment[axis]) * 0x1p-40 * ticks_gone;
  }

  // The clock of the first step of any axis in this interval: half a pulse gone, at the next whole tick.
  std::optional<double> first_step(const Interval& now) {
    enter(now);
    double earliest = INFINITY;
    for (std::size_t a = 0; a < counts_.size(); ++a) {
      if (path_->increment[a] == 0) continue;
      const double offset = static_cast<double>(path_begin_[a] - counts_[a]);
      const double per_tick = static_cast<double>(path_->increment[a]) * 0x1p-40;
      const double half = per_tick > 0 ? 0.5 : -0.5;
      earliest = std::min(earliest, std::max(std::ceil((half - offset) / per_tick), 1.0));
    }
    if (earliest > ticks(now, static_cast<double>(now.clocks))) return std::nullopt;
    const double gone = static_cast<double>(now.ticks) + static_cast<double>(now.phase) * 0x1p-48;
    return static_cast<double>(now.clock) + (earliest - gone) / (static_cast<double>(now.rate) * 0x1p-48);
  }

  bool is_before(const TimedStep& step, double clock) const { return static_cast<double>(step.cycle) - offset_ < clock; }

  void follow(const Interval& now) {
    enter(now);
    const auto begin = static_cast<double>(now.clock);
    const double end = begin + static_cast<double>(now.clocks);
    while (next_ < steps_.size() && is_before(steps_[next_], end)) {
      const double at = ticks(now, std::max(0.0, static_cast<double>(steps_[next_].cycle) - offset_ - begin));
      Place place_now;
      for (std::size_t a = 0; a < place_now.size(); ++a) place_now[a] = place(a, at);
      take(place_now);
    }
    for (std::size_t a = 0; a < end_.size(); ++a) {
      end_[a] = place(a, ticks(now, static_cast<double>(now.clocks)));
      look(end_[a], a);
    }
    stop_clock_ = end;
  }

  void take(const Place& motion) {
    const TimedStep& step = steps_[next_++];
    look(motion[step.axis], step.axis);
    counts_[step.axis] += step.direction;
    look(motion[step.axis], step.axis);
  }

  void look(double motion, std::size_t axis) {
    farthest = std::max(farthest, std::abs(motion - static_cast<double>(counts_[axis])));
  }

  const std::vector<TimedStep>& steps_;
  std::size_t next_ = 0;
  double offset_ = 0;
  bool found_ = false;
  std::deque<Interval> waiting_;
  const driver::LineCommand* path_ = nullptr;
  Counts path_begin_{};
  Counts counts_{};
  Place end_{};
  double stop_clock_ = 0;
};

}  // namespace

double farthest_from_motion(const std::vector<driver::Command>& commands, const std::vector<TimedStep>& steps) {
  MotionWalk walk(commands);
  StepJudge judge(steps);
  walk.visit(judge);
  return judge.left() == 0 ? judge.farthest : INFINITY;
}

}  // namespace trammel::test
