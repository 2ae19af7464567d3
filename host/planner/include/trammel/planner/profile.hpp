// Speed profile of a path from standstill to standstill, as at most three pieces of the card's feed generator:
// accelerate, cruise, decelerate. Everything in feed ticks and clocks; integer ticks, so that the pieces together have
// exactly the path's ticks. Pure functions, thread-safe.
//
// The feed generator holds a rate for 32 clocks and then adds the acceleration. A ramp is therefore K whole updates,
// with the rates v0 + (i + 1/2) D, D = (v - v0) / K, i = 0 .. K-1: its mean is that of the ideal ramp, no rate in it
// exceeds v, and the acceleration D / 32 is at most the one wanted. From and to rest v0 = sqrt(a * 1 tick): slower, the
// last tick of a stop would hang (and the first one come late); v0 is also the floor.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"

namespace trammel::planner {

inline constexpr std::uint64_t kClocksPerUpdate = card_map::constant::kUpdateClocks;

// Rates above this leave the time base no room to slow down evenly and the shapers no jitter.
inline constexpr double kMaxTickRate = 0.9;  // ticks a clock

// What holds along a path, in a unit of length of the caller's.
struct PathLimits {
  double length = 0;        // > 0
  double velocity = 0;      // a second, > 0; what would be above kMaxTickRate counts as that
  double acceleration = 0;  // a second^2, > 0
};

// Pieces in the order to send.
class Profile {
 public:
  void add(const driver::FeedCommand& piece) { pieces_[size_++] = piece; }
  void clear() { size_ = 0; }
  std::size_t size() const { return size_; }
  const driver::FeedCommand& operator[](std::size_t i) const { return pieces_[i]; }
  const driver::FeedCommand* begin() const { return pieces_.data(); }
  const driver::FeedCommand* end() const { return pieces_.data() + size_; }

  double top_rate = 0;         // ticks a clock, the highest of all pieces
  bool reaches_limit = false;  // it is the limits' velocity

 private:
  std::array<driver::FeedCommand, 3> pieces_;
  std::size_t size_ = 0;
};

// The path's length in `ticks` feed ticks. Throws std::invalid_argument when ticks is 0 or over 2^40 - 1 or a limit is
// not above 0.
Profile trapezoid(std::uint64_t ticks, const PathLimits& limits, std::uint32_t clock_hz);

// Clocks that the pieces take, within a few: for estimates.
double duration(const Profile& profile);

}  // namespace trammel::planner
