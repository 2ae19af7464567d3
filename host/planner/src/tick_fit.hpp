// Speeds whose acceleration may jump, fitted to whole ticks: where phases end, and at which rates, so that no piece has
// more acceleration than its phase. Internal to the planner.
#pragma once

#include "trammel/planner/speed_plan.hpp"

namespace trammel::planner {

class TickFit {
 public:
  explicit TickFit(double clock_hz) : clock_hz_(clock_hz) {}
  void start(double ticks_per_clock_at_1_mm_s);
  // `ahead`: ticks of the new density, in the next portion with any, that pass without a change of speed.
  void change_density(double ticks_per_clock_at_1_mm_s, double ahead);

  // The whole tick for the end of a phase that ends at `exact` ticks, where neither a stop nor a corner has one.
  double end_tick(const Phase& phase, double exact) const;
  // From the last portion's end `ticks` on, to `to` mm in the phase; `late`: how much later than there. `through`: the
  // phase goes on behind.
  void advance(const Phase& phase, double to, double ticks, double late, bool through);

  // Of the last portion, ticks a clock.
  double rate() const { return begin_; }
  double end_rate() const { return end_; }

 private:
  double of_ticks(double acceleration) const { return acceleration * ticks_per_clock_at_1_mm_s_ / clock_hz_; }

  double clock_hz_;
  double ticks_per_clock_at_1_mm_s_ = 0;
  double begin_ = 0;
  double end_ = 0;
  double ahead_ = 0;  // ticks
  double lag_ = 0;    // ticks from where the plan has the rate `end_` to where the motion has it
};

}  // namespace trammel::planner
