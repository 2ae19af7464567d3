// Fits the speeds of trapezoid plans, whose acceleration may jump, to whole ticks: the ticks and rates at which phases
// end are such that no piece has more acceleration than its phase. Internal to the planner.
#pragma once

#include "trammel/planner/speed_plan.hpp"

namespace trammel::planner {

class TickFit {
 public:
  explicit TickFit(double clock_hz) : clock_hz_(clock_hz) {}
  void start(double ticks_per_clock_at_1_mm_s);
  // `ahead`: ticks of the next portion with ticks, in the new density, that pass without a change of speed.
  void change_density(double ticks_per_clock_at_1_mm_s, double ahead);

  // The whole end tick of a phase that ends at `exact` ticks in the plan. Stops and corners have a tick of their own.
  double end_tick(const Phase& phase, double exact) const;
  // Advances by a portion of `ticks`, which ends in the plan at `to` mm in the phase. `late`: ticks by which it ends
  // after that place. `through`: the phase continues after the portion.
  void advance(const Phase& phase, double to, double ticks, double late, bool through);

  // Rates of the last portion, ticks per clock.
  double rate() const { return begin_; }
  double end_rate() const { return end_; }

 private:
  double of_ticks(double acceleration) const { return acceleration * ticks_per_clock_at_1_mm_s_ / clock_hz_; }

  double clock_hz_;
  double ticks_per_clock_at_1_mm_s_ = 0;
  double begin_ = 0;
  double end_ = 0;
  double ahead_ = 0;  // ticks to pass without a change of speed
  double lag_ = 0;    // ticks from the place where the plan has the rate `end_` to the place where the motion has it
};

}  // namespace trammel::planner
