// How a piece of the feed profile goes: its duration, and whether it gets to its end. For time-outs, forecasts and
// checks: floating point, so nothing of it may reach a command. Pure, thread-safe.
#pragma once

#include <optional>

#include "trammel/driver/commands.hpp"

namespace trammel::driver {

// Enabled clocks from the piece's first tick to its last, to a few clocks and 0.1 %, as its rate, acceleration and jerk
// make it in continuous time, never slower than its floor. The longest that a piece can say: 2^40 ticks at 2^-32.
double feed_clocks(const FeedCommand& piece);

// Ticks that the piece has given when acceleration and jerk have brought its rate down to 0, without its floor, where
// that is before its end: from there on it would go backwards. None where it gets there but for a thousandth, two
// ticks, four updates at its floor and the change of an update: stops are rounded, and floors make up for that.
std::optional<double> ticks_to_reversal(const FeedCommand& piece);

}  // namespace trammel::driver
