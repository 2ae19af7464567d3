// How long a tick is. Internal to the planner.
#pragma once

namespace trammel::planner {

// Times 1 mm/s, mm/s^2 or mm/s^3 are ticks per clock, per clock^2 (divided by clock_hz) or per clock^3 (twice).
struct TickScale {
  double clock_hz = 0;                   // enabled clocks per second
  double ticks_per_clock_at_1_mm_s = 0;  // changes with the density of ticks
};

}  // namespace trammel::planner
