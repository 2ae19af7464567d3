// Speed profile of a path from standstill to standstill, as at most three pieces of the card's feed generator:
// accelerate, cruise, decelerate. Everything in feed ticks and clocks; integer ticks, so that the pieces together have
// exactly the path's ticks. Pure functions, thread-safe.
//
// The feed generator holds a rate for 32 clocks and then adds the acceleration. A ramp is therefore K whole updates,
// with the rates v0 + (i + 1/2) D, D = (v - v0) / K, i = 0 .. K-1: its mean is that of the ideal ramp, no rate in it
// exceeds v, and the acceleration D / 32 is at most the one wanted. From and to rest v0 = sqrt(a * 1 tick): slower, the
// last tick of a stop would hang (and the first one come late); v0 is also the floor.
#pragma once

#include <cstdint>
#include <vector>

#include "trammel/driver/commands.hpp"

namespace trammel::planner {

inline constexpr std::uint64_t kClocksPerUpdate = 32;

// Rates above this leave the time base no room to slow down evenly and the shapers no jitter.
inline constexpr double kMaxTickRate = 0.9;  // ticks a clock

struct ProfileLimits {
  long double rate = 0;          // ticks a clock, > 0; values above kMaxTickRate count as that
  long double acceleration = 0;  // ticks a clock^2, > 0
};

// Throws std::invalid_argument when ticks is 0 or over 2^40 - 1 or a limit is not above 0.
std::vector<driver::FeedCommand> trapezoid(std::uint64_t ticks, const ProfileLimits& limits);

// Clocks that the pieces take, within a few: for estimates.
long double duration(const std::vector<driver::FeedCommand>& pieces);

}  // namespace trammel::planner
