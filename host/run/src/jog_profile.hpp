// The feed profile of a jog: from rest to a rate and back to rest. Internal to the jog; pure.
#pragma once

#include <cstdint>
#include <vector>

#include "trammel/driver/commands.hpp"

namespace trammel::run {

inline constexpr double kMaxTickRate = 0.9;  // ticks per clock: above it the time base could not slow down evenly

// Three pieces, two if the rate is not reached, one if there is no room for ramps. `rate`: ticks per clock, above 0, at
// most kMaxTickRate; `acceleration`: ticks per clock^2, above 0. The result is the same on every host, because it uses
// only the four arithmetic operations and the square root.
std::vector<driver::FeedCommand> jog_profile(std::uint64_t ticks, double rate, double acceleration);

}  // namespace trammel::run
