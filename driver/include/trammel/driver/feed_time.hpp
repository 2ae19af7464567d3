// How long a piece of the feed profile takes. For time-outs and forecasts: floating point, so nothing of it may reach a
// command. Pure, thread-safe.
#pragma once

#include "trammel/driver/commands.hpp"

namespace trammel::driver {

// Enabled clocks from the piece's first tick to its last, to a few clocks and 0.1 %, as its rate, acceleration and jerk
// make it in continuous time, never slower than its floor. The longest that a piece can say: 2^40 ticks at 2^-32.
double feed_clocks(const FeedCommand& piece);

}  // namespace trammel::driver
