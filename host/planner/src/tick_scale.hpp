// The scale of feed ticks. Internal to the planner.
#pragma once

namespace trammel::planner {

// ticks_per_clock_at_1_mm_s converts mm/s to ticks per clock. Divided by clock_hz once, it converts mm/s^2 to ticks per
// clock^2; divided twice, mm/s^3 to ticks per clock^3.
struct TickScale {
  double clock_hz = 0;                   // enabled clocks per second
  double ticks_per_clock_at_1_mm_s = 0;  // changes with the density of ticks
};

}  // namespace trammel::planner
