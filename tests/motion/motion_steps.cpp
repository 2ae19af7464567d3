#include <cmath>
#include <deque>
#include <optional>
#include <stdexcept>

#include "course.hpp"
#include "motion_judge.hpp"
#include "motion_walk.hpp"

namespace trammel::test {
namespace {

// Follows the steps along the motion. The intervals before the first step after a start are kept until the reading
// contains that step; this relates the two clocks to each other.
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
    // The search for the first step has moved path_begin_; return to the start.
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
  static constexpr double kSettle = 1000;  // clocks until the shapers have made their waiting steps

  static double ticks(const Interval& now, double clocks) {
    return static_cast<double>(now.ticks) + static_cast<double>(now.phase) * 0x1p-48 +
           static_cast<double>(now.rate) * 0x1p-48 * clocks;
  }

  void enter(const Interval& now) {
    if (path_ == now.path) return;
    if (path_ != nullptr) {
      const Place end = place(static_cast<double>(path_->ticks));
      for (std::size_t a = 0; a < end.size(); ++a) path_begin_[a] = std::llround(end[a]);
    }
    path_ = now.path;
    arc_.reset();
    if (path_->arc != nullptr) arc_.emplace(*path_->arc);
  }

  Place place(double feed_ticks) {
    Place places;
    const bool arc = path_->arc != nullptr;
    const double ticks = arc ? feed_ticks * static_cast<double>(path_->arc->prescale) * 0x1p-40 : feed_ticks;
    const auto& increment = arc ? path_->arc->increment : path_->line->increment;
    for (std::size_t a = 0; a < places.size(); ++a) {
      places[a] = static_cast<double>(path_begin_[a]) + static_cast<double>(increment[a]) * 0x1p-40 * ticks;
    }
    if (arc) {
      const std::array<double, 2> plane = arc_->at(ticks);
      places[path_->arc->axis_x] += plane[0];
      places[path_->arc->axis_y] += plane[1];
    }
    return places;
  }

  // The clock of the first step of any axis if it is in this interval: at a whole tick, after half a pulse.
  std::optional<double> first_step(const Interval& now) {
    enter(now);
    const double gone = ticks(now, 0);
    for (double tick = std::floor(gone) + 1; tick <= ticks(now, static_cast<double>(now.clocks)); ++tick) {
      const Place places = place(tick);
      for (std::size_t a = 0; a < places.size(); ++a) {
        if (std::abs(places[a] - static_cast<double>(counts_[a])) < 0.5) continue;
        return static_cast<double>(now.clock) + (tick - gone) / (static_cast<double>(now.rate) * 0x1p-48);
      }
    }
    return std::nullopt;
  }

  bool is_before(const TimedStep& step, double clock) const {
    return static_cast<double>(step.cycle) - offset_ < clock;
  }

  void follow(const Interval& now) {
    enter(now);
    const auto begin = static_cast<double>(now.clock);
    const double end = begin + static_cast<double>(now.clocks);
    while (next_ < steps_.size() && is_before(steps_[next_], end)) {
      const double at = ticks(now, std::max(0.0, static_cast<double>(steps_[next_].cycle) - offset_ - begin));
      take(place(at));
    }
    end_ = place(ticks(now, static_cast<double>(now.clocks)));
    for (std::size_t a = 0; a < end_.size(); ++a) look(end_[a], a);
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
  const Path* path_ = nullptr;
  std::optional<ArcReading> arc_;
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
