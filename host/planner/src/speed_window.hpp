// The spans that a plan looks at. Positions are lengths from the window's beginning. Internal to the planner.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "s_ramp.hpp"
#include "trammel/planner/speed_plan.hpp"

namespace trammel::planner {

class SpeedWindow {
 public:
  explicit SpeedWindow(std::size_t spans);

  bool empty() const { return spans_.empty(); }
  bool full() const { return spans_.size() == most_; }
  std::size_t size() const { return spans_.size(); }
  const Span& operator[](std::size_t i) const { return spans_[i]; }

  void push(const Span& span) { spans_.push_back(span); }
  // The window begins at `position` from now on; returns how many spans are no longer in it. index() comes before the
  // next question.
  std::size_t drop_before(double position);
  void index();

  // Where span i begins; size(): the end.
  double position(std::size_t i) const { return positions_[i]; }
  double length() const { return positions_.back(); }
  bool uniform() const { return all_.uniform(); }
  // No span has less, or more.
  RampLimits least() const { return all_.least; }
  RampLimits most() const { return all_.most; }
  // The least and the most of both within begin .. end.
  struct Range {
    RampLimits least;
    RampLimits most;
    bool uniform() const { return least.acceleration == most.acceleration && least.jerk == most.jerk; }
  };
  Range range(double begin, double end) const;

  // Spans as one stretch of the way that a ramp takes; their least limits.
  struct Stretch {
    double end = 0;  // from where the walk began
    RampLimits limits;
    const Span* arc = nullptr;  // one span alone, which has more of them below its highest speed
    double top = std::numeric_limits<double>::infinity();  // of an arc's step: up to this speed
    // The least of the neighbouring spans', if they have not much less: none in the stretch has more.
    double jerk_beside = std::numeric_limits<double>::infinity();
  };

  // Away from a place, stretch by stretch, up to the span in which the other one lies.
  class Walk {
   public:
    Walk(const SpeedWindow& window, double from, bool forwards, double to);

    bool ended() const { return at_ == last_; }
    // The next stretch, for a ramp that has `speed` there, `time` after its beginning. Spans make one where their
    // limits differ so little, or for so short a time, that it costs little of what a rise of the acceleration does.
    Stretch next(double speed, double time);

   private:
    double distance(std::size_t border) const {
      return forwards_ ? window_->position(border) - from_ : from_ - window_->position(border);
    }
    std::size_t span_at(std::size_t border) const { return forwards_ ? border : border - 1; }
    bool take_block(Range& range);

    const SpeedWindow* window_;
    double from_;
    bool forwards_;
    std::size_t at_;  // border
    std::size_t last_;
    double end_ = 0;
  };
  Walk from(double begin, double end) const { return {*this, begin, true, end}; }
  Walk back_from(double end, double begin) const { return {*this, end, false, begin}; }

 private:
  static constexpr std::size_t kBlock = 64;

  std::size_t most_;
  std::vector<Span> spans_;
  std::vector<double> positions_;
  std::vector<Range> blocks_;  // of kBlock spans
  Range all_;
};

}  // namespace trammel::planner
