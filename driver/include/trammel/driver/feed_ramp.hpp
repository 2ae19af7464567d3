// A piece of the feed profile from its speeds, for hosts that plan by themselves. The planner of this project makes its
// own pieces. Pure, thread-safe.
#pragma once

#include <chrono>
#include <cstdint>

#include "trammel/driver/commands.hpp"

namespace trammel::driver {

// Constant acceleration from one speed to another. Speeds are feed ticks per second, 0 .. one per enabled clock.
struct FeedRamp {
  std::uint64_t ticks = 0;  // of the piece, 1 .. 2^40 - 1
  double speed = 0;         // at its begin; 0: from rest
  double end_speed = 0;     // at its end; 0: the piece ends at rest
  // For the under-run hold: the highest speed of this piece and of all that follow it up to the next rest. Where it is
  // below both speeds, the higher of them counts.
  double highest_speed = 0;
  // Of the card, as Card::set_slew_time() got it; for the stop distance of pieces that do not end at rest. >= 0.
  std::chrono::nanoseconds slew_time{0};
};

// `clock_hz`: enabled clocks per second at the host's 100 %: the card's clock where that is the full ratio.
//
// Behind a piece that ends at the ramp's first speed, or at rest, ticks come at their times to a few clocks. A ramp to
// rest does not become slower than half a tick before it, r = sqrt(deceleration * 1 tick), since its last tick would
// not come in time: that one comes early by 1 / (2 r). A piece of less than 32 clocks (an update of the card) has one
// rate, its mean. The class is kFeed.
//
// Throws ArgumentError for values out of range, two speeds of 0, and a stop distance beyond 2^32 - 1 ticks.
FeedCommand feed_for_ramp(const FeedRamp& ramp, std::uint32_t clock_hz);

}  // namespace trammel::driver
