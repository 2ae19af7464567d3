// The course of a piece of the feed profile: its duration, and whether it reaches its end. For time-outs, forecasts and
// checks. The results are floating point and must not become part of a command. Pure, thread-safe.
#pragma once

#include <optional>

#include "trammel/driver/commands.hpp"

namespace trammel::driver {

// Enabled clocks from the piece's first tick to its last, accurate to a few clocks and 0.1 %. Computed from rate,
// acceleration and jerk in continuous time, never slower than the floor. The largest possible result is that of 2^40
// ticks at a rate of 2^-32.
double feed_clocks(const FeedCommand& piece);

// Detects a piece whose feed would reverse before its end: the number of ticks after which acceleration and jerk have
// brought the rate, without its floor, to 0. Returns nullopt if the piece reaches its end, or nearly does: the
// tolerance is a thousandth of its ticks, plus two ticks, plus four updates at its floor, plus the change of one
// update. Stops are rounded, and floors compensate for that.
std::optional<double> ticks_to_reversal(const FeedCommand& piece);

}  // namespace trammel::driver
