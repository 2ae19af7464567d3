// The spans that a plan looks at, and the ramps that fit them: a ramp keeps the least acceleration and jerk of the
// spans that it touches; where they differ much, a row of ramps may be better than one. Positions are lengths from the
// window's beginning. Internal to the planner.
#pragma once

#include <cstddef>
#include <vector>

#include "s_ramp.hpp"

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
  // No span has more.
  RampLimits most() const { return all_.most; }
  // The least and the most of both within begin .. end.
  struct Range {
    RampLimits least;
    RampLimits most;
    bool uniform() const { return least.acceleration == most.acceleration && least.jerk == most.jerk; }
  };
  Range range(double begin, double end) const;

  // Away from a place, span by span or block by block; begins with a span.
  class Walk {
   public:
    Walk(const SpeedWindow& window, double from, bool forwards);

    // The next span, or a block of them that ends nearer than `need`; false at the window's end.
    bool next(double need);
    const Range& range() const { return range_; }
    double end() const { return end_; }  // its far end, from where the walk began

   private:
    double distance(std::size_t border) const {
      return forwards_ ? window_->position(border) - from_ : from_ - window_->position(border);
    }

    const SpeedWindow* window_;
    double from_;
    bool forwards_;
    std::size_t at_ = 0;  // border
    Range range_;
    double end_ = 0;
  };
  Walk from(double begin) const { return {*this, begin, true}; }
  Walk back_from(double end) const { return {*this, end, false}; }

  // Length of the ramps from `low` to `high` on the way, seen from its beginning. If it is longer than the window, they
  // do not fit. `ramps`, if any: they are put there, from `low` on.
  double ramps(Walk walk, double low, double high, std::vector<Ramp>* ramps = nullptr) const;
  double rising(double begin, double low, double high) const { return ramps(from(begin), low, high); }
  double falling(double end, double high, double low) const { return ramps(back_from(end), low, high); }

 private:
  static constexpr std::size_t kBlock = 64;

  // Where the present ramp begins, seen from the first one.
  struct Stretch {
    double begin;
    double low;
    RampLimits limits;
  };

  std::size_t most_;
  std::vector<Span> spans_;
  std::vector<double> positions_;
  std::vector<Range> blocks_;  // of kBlock spans
  Range all_;
};

}  // namespace trammel::planner
