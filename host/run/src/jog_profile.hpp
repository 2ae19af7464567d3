// The feed of a jog: from rest to a rate and to rest again. Internal to the jog; pure.
#pragma once

#include <cstdint>
#include <vector>

#include "trammel/driver/commands.hpp"

namespace trammel::run {

inline constexpr double kMaxTickRate = 0.9;  // ticks a clock: above it the time base could not slow down evenly

// Three pieces, two where the rate is not reached, one where there is no room for ramps. `rate`: ticks a clock, above
// 0, at most kMaxTickRate; `acceleration`: ticks a clock^2, above 0. The same on every host: four operations and a
// root.
std::vector<driver::FeedCommand> jog_profile(std::uint64_t ticks, double rate, double acceleration);

}  // namespace trammel::run
