// The spans that a plan considers. Positions are lengths from the window's beginning. Internal to the planner.
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
  // Moves the beginning of the window to `position`; returns how many spans leave it. Call index() before the next
  // query.
  std::size_t drop_before(double position);
  void index();

  // Beginning of span i; size(): the window's end.
  double position(std::size_t i) const { return positions_[i]; }
  double length() const { return positions_.back(); }
  bool uniform() const { return all_.uniform(); }
  // The lowest and the highest limits of all spans.
  RampLimits least() const { return all_.least; }
  RampLimits most() const { return all_.most; }
  // The lowest and the highest limits within begin .. end.
  struct Range {
    RampLimits least;
    RampLimits most;
    bool uniform() const { return least.acceleration == most.acceleration && least.jerk == most.jerk; }
  };
  Range range(double begin, double end) const;

  // Successive spans that a ramp crosses as one, with the lowest of their limits.
  struct Stretch {
    double end = 0;  // from the beginning of the walk
    RampLimits limits;
    const Span* arc = nullptr;  // set if the stretch is one arc, whose limits are higher at lower speeds
    double top = std::numeric_limits<double>::infinity();  // highest speed of a step of an arc
    // No jerk in the stretch is above this: the lowest of the neighbouring spans, unless that is much lower.
    double jerk_beside = std::numeric_limits<double>::infinity();
  };

  // Walks stretch by stretch from one place to the span that contains another place.
  class Walk {
   public:
    Walk(const SpeedWindow& window, double from, bool forwards, double to);

    bool ended() const { return at_ == last_; }
    // The next stretch, for a ramp that reaches it with `speed`, `time` after the ramp's beginning. Spans become one
    // stretch if their limits differ so little, or for so short a time, that the loss is small against the time in
    // which the acceleration rises.
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
    std::size_t at_;  // a border between spans
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
  std::vector<Range> blocks_;  // range of kBlock spans each
  Range all_;
};

}  // namespace trammel::planner
