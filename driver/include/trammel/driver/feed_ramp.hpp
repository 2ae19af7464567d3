// Computes a piece of the feed profile from its speeds, for hosts that plan themselves. This project's planner makes
// its own pieces. Pure, thread-safe.
#pragma once

#include <chrono>
#include <cstdint>

#include "trammel/driver/commands.hpp"

namespace trammel::driver {

// Clocks for which the card continues at a piece's last rate after the piece's last tick. Ticks in this time belong to
// the next piece.
inline constexpr std::uint32_t kFeedSwapDelay = 6;

// Constant acceleration from one speed to another. Speeds are feed ticks per second, 0 .. one per enabled clock.
struct FeedRamp {
  std::uint64_t ticks = 0;  // length of the piece, feed ticks, 1 .. 2^40 - 1
  double speed = 0;         // speed at the start; 0: from rest
  double end_speed = 0;     // speed at the end; 0: the piece ends at rest
  // For the under-run hold: the highest speed of this piece and of all following pieces up to the next rest. If it is
  // below both speeds, the higher of them is used.
  double highest_speed = 0;
  // The slew time of the card, as given to Card::set_slew_time(), >= 0. It determines the stop distance of pieces that
  // do not end at rest.
  std::chrono::nanoseconds slew_time{0};
};

// `clock_hz`: enabled clocks per second at the host's 100 %. If 100 % is the full ratio, this is the card's clock.
//
// If the previous piece ends at this ramp's first speed, or at rest, each tick is at its time to within a few clocks. A
// ramp to rest does not slow down below r = sqrt(deceleration * 1 tick), its speed half a tick before rest; otherwise
// its last tick would be late. That tick comes early by 1 / (2 r). A piece shorter than 32 clocks (one update of the
// card) has a constant rate, its mean. The class is kFeed.
//
// Throws ArgumentError for values out of range, for two speeds of 0, for a stop distance above 2^32 - 1 ticks, and for
// a rate that changes by half a tick per clock or more within 32 clocks, in a piece of 32 clocks or more.
FeedCommand feed_for_ramp(const FeedRamp& ramp, std::uint32_t clock_hz);

}  // namespace trammel::driver
