// Pieces for the model of the feed generator, their closed form, and functions that clock them.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "trammel/model/feed_generator.hpp"
#include "trammel/skip/feed_generator.hpp"

namespace trammel::model {

__extension__ typedef __int128 int128;
__extension__ typedef unsigned __int128 uint128;
using Real = long double;

inline constexpr Real kOne64 = 18446744073709551616.0L;  // 2^64
inline constexpr Real kUpdate = FeedGenerator::kUpdateClocks;

struct Piece {
  std::uint64_t rate;
  std::int64_t acceleration = 0;
  std::int64_t jerk = 0;
  std::uint32_t floor = 1;
};

inline void shift(FeedGenerator& feed, unsigned target, std::uint64_t value, int halfwords) {
  for (int i = 0; i < halfwords; ++i) {
    FeedGenerator::Inputs in;
    in.load = {true, static_cast<std::uint16_t>(target), static_cast<std::uint16_t>(value >> (16 * i))};
    feed.clock(in);
  }
}

inline void swap(FeedGenerator& feed, const Piece& p) {
  shift(feed, feed_target::kRate, p.rate, 4);
  shift(feed, feed_target::kFloor, p.floor, 2);
  FeedGenerator::Inputs in;
  in.swap = true;
  feed.clock(in);
}

// Acceleration and jerk are loaded after the swap.
inline void load_and_swap(FeedGenerator& feed, const Piece& p) {
  swap(feed, p);
  feed.clock({});
  feed.clock({});
  shift(feed, feed_target::kAcceleration, static_cast<std::uint64_t>(p.acceleration), 4);
  shift(feed, feed_target::kJerk, static_cast<std::uint64_t>(p.jerk), 4);
}

inline bool enabled_clock(FeedGenerator& feed) {
  FeedGenerator::Inputs in;
  in.enable = true;
  feed.clock(in);
  return feed.outputs().tick;
}

// Clocks until no tick is in flight; returns the ticks that came out.
inline std::uint64_t drain(FeedGenerator& feed) {
  std::uint64_t ticks = 0;
  for (std::uint32_t i = 1; i < FeedGenerator::kLatency; ++i) {
    feed.clock({});
    ticks += feed.outputs().tick;
  }
  feed.clock({});
  return ticks;
}

// Number of ticks in `clocks` enabled clocks; no tick is in flight before and after.
inline std::uint64_t ticks_in(FeedGenerator& feed, std::uint64_t clocks) {
  std::uint64_t ticks = 0;
  for (std::uint64_t i = 0; i < clocks; ++i) ticks += enabled_clock(feed);
  return ticks + drain(feed);
}

// Runs to the n-th tick. Returns the enabled clocks that this took, or 0 if the tick does not come within `limit`.
inline std::uint64_t clocks_to_tick(FeedGenerator& feed, std::uint64_t n, std::uint64_t limit) {
  const skip::FeedAhead::Advanced gone = skip::FeedAhead(feed).advance(limit, n);
  drain(feed);
  return gone.carries == n ? gone.enables : 0;
}

// The slope of update k in closed form: r + k a + k (k - 1) / 2 j, clamped.
inline std::uint64_t ideal_slope(const Piece& p, std::int64_t k) {
  if (k == 0) return p.rate >> 16;
  const int128 r = static_cast<int128>(p.rate) + static_cast<int128>(k) * p.acceleration +
                   static_cast<int128>(k) * (k - 1) / 2 * p.jerk;
  const int128 floor_rate = static_cast<int128>(p.floor) << 32;
  if (r < floor_rate) return std::uint64_t{p.floor} << 16;
  if (r >= static_cast<int128>(1) << 64) return (std::uint64_t{1} << 48) - 1;
  return static_cast<std::uint64_t>(r >> 16);
}

inline std::uint64_t rounded(Real per_clock) { return static_cast<std::uint64_t>(std::round(per_clock * kOne64)); }
inline std::int64_t rounded_signed(Real per_clock) { return static_cast<std::int64_t>(std::round(per_clock * kOne64)); }
inline Real slope_of(const FeedGenerator& feed) { return static_cast<Real>(feed.state().slope) / 281474976710656.0L; }

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t word() { return engine_(); }
  Real log_uniform(Real low, Real high) {
    const Real u = static_cast<Real>(engine_() >> 11) / 9007199254740992.0L;
    return low * std::exp(std::log(high / low) * u);
  }
  // Magnitudes of every order, small enough that R stays within +-2 for 2,000 updates.
  Piece piece() {
    Piece p{engine_() >> (engine_() % 64)};
    p.acceleration = static_cast<std::int64_t>(engine_() >> (12 + engine_() % 50));
    p.jerk = static_cast<std::int64_t>(engine_() >> (24 + engine_() % 40));
    if (engine_() % 2 == 0) p.acceleration = -p.acceleration;
    if (engine_() % 2 == 0) p.jerk = -p.jerk;
    if (engine_() % 4 == 0) p.acceleration = p.jerk = 0;
    p.floor = static_cast<std::uint32_t>(1 + (engine_() >> (33 + engine_() % 31)));
    return p;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace trammel::model
