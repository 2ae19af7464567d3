// The acceleration along a span as a function of speed. On an arc, Curve::along() gives the acceleration that each
// speed leaves. It is divided into steps of constant acceleration and jerk, each with the values at its highest speed.
// Speeds are given as squares. Internal to the planner.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "trammel/planner/speed_plan.hpp"

namespace trammel::planner {

class SpanAcceleration {
 public:
  static constexpr int kMaxSteps = 16;

  SpanAcceleration() = default;
  explicit SpanAcceleration(const Span& span)
      : at_rest_(span.acceleration), at_top_(span.acceleration), top_(span.speed * span.speed), jerk_(span.jerk) {
    if (span.curve.whole <= 0) return;
    curve_ = span.curve;
    at_rest_ = std::max(at_top_, span.curve.at_rest);
    // So many that each step has some 4 % less than the one before, if the speed is the most that the curve allows.
    constexpr double kSteps = 28;
    const double lost = 1 - at_top_ / at_rest_;
    steps_ = std::clamp(static_cast<int>(std::ceil(kSteps * lost)), 1, kMaxSteps);
  }

  int steps() const { return steps_; }
  // Highest square of the step. Steps are narrower where the acceleration falls faster.
  double top(int step) const {
    if (step + 1 >= steps_) return curve_.whole > 0 ? top_ : std::numeric_limits<double>::infinity();
    const double below = 1 - static_cast<double>(step + 1) / steps_;
    return top_ * (1 - below * below);
  }
  double acceleration(int step) const {
    if (step + 1 >= steps_) return at_top_;
    return std::clamp(curve_.along(std::sqrt(top(step))), at_top_, at_rest_);
  }

  // The jerk of the step, with that acceleration.
  double jerk(int step) const {
    if (curve_.whole <= 0) return jerk_;
    return std::max(jerk_, curve_.jerk_along(std::sqrt(step + 1 < steps_ ? top(step) : top_), acceleration(step)));
  }

  // Squares between which the acceleration is constant, from `low` up to `high`, with the length that each takes.
  template <typename Visit>
  void each(double low, double high, Visit visit) const {
    for (int i = first(low); i < steps_ && low < high; ++i) {
      const double end = std::min(high, i + 1 == steps_ ? high : top(i));
      const double part = acceleration(i);
      visit(low, end, part, (end - low) / (2 * part));
      low = end;
    }
  }
  double length(double low, double high) const {
    double sum = 0;
    each(low, high, [&](double, double, double, double part) { sum += part; });
    return sum;
  }
  // The square reached from `low` in `length`, if `ramps` ramps share the length (2: up, and down again).
  double reached(double low, double length, int ramps = 1) const {
    for (int i = first(low); i < steps_; ++i) {
      const double end = top(i);
      if (end <= low) continue;  // above the span's highest speed
      const double gain = 2 * acceleration(i) / ramps;
      if (length * gain < end - low) return low + length * gain;
      length -= (end - low) / gain;
      low = end;
    }
    return low;
  }

 private:
  // The step for a ramp that begins at `low`. In less than a quarter of a step there are too few ticks for the step's
  // acceleration. The ramp then begins with the next step, whose acceleration is less.
  int first(double low) const {
    if (steps_ == 1) return 0;
    int step = 0;
    double begin = 0;
    for (double end = top(0); step + 1 < steps_ && low > end - (end - begin) / 4; end = top(step)) {
      begin = end;
      ++step;
    }
    return step;
  }

  double at_rest_ = 0;
  double at_top_ = 0;
  double top_ = 0;
  double jerk_ = 0;  // the lowest at any speed
  Curve curve_;
  int steps_ = 1;
};

}  // namespace trammel::planner
