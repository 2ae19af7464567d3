// The spans that a plan looks at, and the ramps that fit them: a ramp keeps the least acceleration and jerk of the
// spans that it touches. Positions are lengths from the window's beginning. Internal to the planner.
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
  bool uniform() const { return uniform_; }
  // No span has more.
  RampLimits most() const { return highest_; }
  // The least within begin .. end.
  RampLimits limits(double begin, double end) const;

  struct Fit {
    double length = 0;
    RampLimits limits;
  };
  // The ramp from `low` to `high` that begins at `begin`, and the one from `high` to `low` that ends at `end`. It is
  // not longer than the window, or does not fit.
  Fit rising(double begin, double low, double high) const;
  Fit falling(double end, double high, double low) const;
  // No ramp from `low` at `begin`, however high, is above `high` nearer than this; and the mirror image.
  double reach_rising(double begin, double low, double high) const;
  double reach_falling(double end, double high, double low) const;

 private:
  static constexpr std::size_t kBlock = 64;

  // The least length that is the one wanted under the limits of all spans that it touches.
  template <typename Length>
  Fit forwards(double begin, Length wanted) const;
  template <typename Length>
  Fit backwards(double end, Length wanted) const;

  std::size_t most_;
  std::vector<Span> spans_;
  std::vector<double> positions_;
  std::vector<RampLimits> blocks_;  // the least of kBlock spans
  RampLimits lowest_;
  RampLimits highest_;
  bool uniform_ = true;
};

}  // namespace trammel::planner
