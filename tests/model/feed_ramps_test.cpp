// Ramps, stops and extremes of the model of the feed generator: the time and the speed at which they end.
#include <gtest/gtest.h>

#include <algorithm>

#include "feed_pieces.hpp"

namespace trammel::model {
namespace {

// Ramps from 0: rate v = a t, with a per update. The mean of the first update is a / 2; n ticks end at v = sqrt(2 n a).
TEST(FeedGenerator, ARampEndsAtItsSpeed) {
  Random random(5);
  int ramps = 0;
  while (ramps < 150) {
    const Real clocks = kUpdate * random.log_uniform(1000, 100'000);
    const Real speed = random.log_uniform(1e-7L, 0.95L);
    const Real ticks = std::round(speed * clocks / 2);
    if (ticks < 300 || ticks > 50'000) continue;
    ++ramps;
    const Real acceleration = speed * speed / (2 * ticks) * kUpdate;
    const Piece p{rounded(acceleration / 2), rounded_signed(acceleration), 0, 1};
    FeedGenerator feed;
    load_and_swap(feed, p);
    const auto limit = static_cast<std::uint64_t>(2 * clocks);
    const std::uint64_t taken = clocks_to_tick(feed, static_cast<std::uint64_t>(ticks), limit);
    ASSERT_NE(taken, 0U);
    EXPECT_NEAR(static_cast<double>(slope_of(feed) / speed), 1, 5e-4) << "speed " << speed << " ticks " << ticks;
    EXPECT_NEAR(static_cast<double>(static_cast<Real>(taken) / (2 * ticks / speed)), 1, 1e-3);
  }
}

// Jerk from rest: v = j t^2 / 2, n = j t^3 / 6, so j = 2 v^3 / (9 n^2). In updates: the mean of update i is
// j (i^2 + i + 1/3) / 2; it starts at j / 6 with a first difference of j. After k updates, half an update changes the
// speed by 1/k of the end speed, twice as much as on a trapezoid: 0.05 % from 2,000 updates on.
TEST(FeedGenerator, AJerkPieceEndsAtItsSpeed) {
  Random random(6);
  int pieces = 0;
  while (pieces < 150) {
    const Real clocks = kUpdate * random.log_uniform(2000, 100'000);
    const Real speed = random.log_uniform(1e-7L, 0.95L);
    const Real ticks = std::round(speed * clocks / 3);
    if (ticks < 300 || ticks > 50'000) continue;
    ++pieces;
    const Real jerk = 2 * speed * speed * speed / (9 * ticks * ticks) * kUpdate * kUpdate;
    const Piece p{rounded(jerk / 6), rounded_signed(jerk), rounded_signed(jerk), 1};
    FeedGenerator feed;
    load_and_swap(feed, p);
    const auto limit = static_cast<std::uint64_t>(2 * clocks);
    ASSERT_NE(clocks_to_tick(feed, static_cast<std::uint64_t>(ticks), limit), 0U);
    EXPECT_NEAR(static_cast<double>(slope_of(feed) / speed), 1, 5e-4) << "speed " << speed << " ticks " << ticks;
  }
}

// A stop planned to end at sqrt(a * 1 tick), which is also its floor, does end. A tick at the end speed takes
// sqrt(1 tick / a), which is the unit of the permitted lateness.
TEST(FeedGenerator, AStopAlwaysEnds) {
  Random random(7);
  int stops = 0;
  while (stops < 150) {
    const Real clocks = kUpdate * random.log_uniform(1000, 30'000);
    const Real speed = random.log_uniform(1e-6L, 0.95L);
    const Real ticks = std::round(speed * clocks / 2);
    if (ticks < 300 || ticks > 50'000) continue;
    ++stops;
    const Real end = std::sqrt(speed * speed / (2 * ticks));
    const Real per_clock = (speed * speed - end * end) / (2 * ticks);
    const Real acceleration = per_clock * kUpdate;
    Piece p{rounded(speed - acceleration / 2), -rounded_signed(acceleration), 0, 1};
    p.floor = static_cast<std::uint32_t>(std::max(1.0L, std::round(end * 4294967296.0L)));
    FeedGenerator feed;
    load_and_swap(feed, p);
    const Real ideal = (speed - end) / per_clock;
    const std::uint64_t taken =
        clocks_to_tick(feed, static_cast<std::uint64_t>(ticks), static_cast<std::uint64_t>(4 * ideal));
    ASSERT_NE(taken, 0U) << "hangs: speed " << speed << " ticks " << ticks;
    const Real late = static_cast<Real>(taken) - ideal;
    EXPECT_LT(std::fabs(late), 1 / end + kUpdate) << "speed " << speed << " ticks " << ticks;
  }
}

// With a floor of almost 0 the same stop does not end: the rule of the floor is necessary.
TEST(FeedGenerator, AStopToZeroWithoutItsFloorIsLate) {
  const Real speed = 0.01L;
  const Real ticks = 1000;
  const Real acceleration = speed * speed / (2 * ticks) * kUpdate;
  FeedGenerator feed;
  load_and_swap(feed, {rounded(speed - acceleration / 2), -rounded_signed(acceleration * 1.001L), 0, 1});
  EXPECT_EQ(clocks_to_tick(feed, 1000, 4 * 200'000), 0U);
}

// Clocks to the n-th tick, computed from the definition alone: sums of exact slopes, one update at a time.
std::uint64_t ideal_clocks(const Piece& p, std::uint64_t n) {
  constexpr int128 kTwo = static_cast<int128>(2) << 64;
  const int128 target = static_cast<int128>(n) << 48;
  int128 sum = 0;
  int128 rate = p.rate;
  int128 acceleration = p.acceleration;
  std::int64_t slope = static_cast<std::int64_t>(p.rate >> 16);
  for (std::uint64_t clocks = 0;; clocks += FeedGenerator::kUpdateClocks) {
    const int128 after = sum + static_cast<int128>(slope) * FeedGenerator::kUpdateClocks;
    if (after >= target) return clocks + static_cast<std::uint64_t>((target - sum + slope - 1) / slope);
    sum = after;
    if (rate >= -kTwo && rate < kTwo) {
      rate += acceleration;
      acceleration += p.jerk;
    }
    const int128 least = static_cast<int128>(p.floor) << 32;
    const int128 most = (static_cast<int128>(1) << 64) - (1 << 16);
    slope = static_cast<std::int64_t>(std::min(std::max(rate, least), most) >> 16);
  }
}

// With any acceleration and jerk, a piece of n ticks ends at the latest after n ticks at its floor plus one update, and
// exactly in the clock of its definition.
TEST(FeedGenerator, AFloorEndsEveryPiece) {
  Random random(10);
  int reversing = 0;
  int beyond = 0;
  for (int i = 0; i < 20'000; ++i) {
    Piece p{random.word() >> (random.word() % 64)};
    p.acceleration = static_cast<std::int64_t>(random.word()) >> (random.word() % 64);
    p.jerk = static_cast<std::int64_t>(random.word()) >> (random.word() % 64);
    p.floor = static_cast<std::uint32_t>((random.word() >> 32 | 0x4'0000) >> (random.word() % 14));
    const std::uint64_t ticks = 1 + (random.word() >> (54 + random.word() % 10));
    const std::uint64_t most = (ticks << 32) / p.floor + 1 + FeedGenerator::kUpdateClocks;
    FeedGenerator feed;
    load_and_swap(feed, p);
    const std::uint64_t taken = clocks_to_tick(feed, ticks, most);
    ASSERT_NE(taken, 0U) << i;
    if (p.rate >> 32 >= p.floor || taken > FeedGenerator::kUpdateClocks) {
      ASSERT_EQ(taken, ideal_clocks(p, ticks)) << i;
    }
    reversing += p.acceleration > 0 && p.jerk < 0 && feed.state().slope == std::uint64_t{p.floor} << 16 ? 1 : 0;
    beyond += feed.state().slope == (std::uint64_t{1} << 48) - 1 ? 1 : 0;
  }
  EXPECT_GT(reversing, 200) << "jerk turned the feed round, and the floor held it";
  EXPECT_GT(beyond, 200);
}

// The largest sums that the fields allow never wrap: a clamped rate stays clamped.
TEST(FeedGenerator, NoAccumulatorOverflows) {
  constexpr std::int64_t kMax = (std::int64_t{1} << 62) - 1 + (std::int64_t{1} << 62);
  for (const std::int64_t acceleration : {kMax, -kMax - 1, std::int64_t{0}}) {
    for (const std::int64_t jerk : {kMax, -kMax - 1}) {
      FeedGenerator feed;
      load_and_swap(feed, {~std::uint64_t{0} >> 1, acceleration, jerk, 0x100});
      ticks_in(feed, 8 * FeedGenerator::kUpdateClocks);  // the rate changes by 0.5 more in each update
      const std::uint64_t expected = jerk > 0 ? (std::uint64_t{1} << 48) - 1 : std::uint64_t{0x100} << 16;
      for (int update = 0; update < 200; ++update) {
        ASSERT_EQ(feed.state().slope, expected) << acceleration << " " << jerk << " update " << update;
        ticks_in(feed, FeedGenerator::kUpdateClocks);
      }
    }
  }
}

// Ramps of k updates, k >= 50. The rate is the mean of its update, so the ramp ends within half an update's change of
// the speed: relative to the speed, 1/(2k) for a trapezoid and 1/k for jerk from rest. The ticks of whole updates are
// exact, so the n-th tick comes within one clock plus the curvature of half an update, 8/k clocks.
TEST(FeedGenerator, ErrorsOfShortRamps) {
  Random random(11);
  int ramps = 0;
  while (ramps < 600) {
    const Real updates = random.log_uniform(50, 3000);
    const Real clocks = kUpdate * updates;
    const Real speed = random.log_uniform(1e-3L, 0.95L);
    const int kind = ramps % 3;
    // A trapezoid's ramp; rising jerk from rest; falling jerk from half the speed to the full speed.
    const Real ticks = std::round(speed * clocks * (kind == 0 ? 1 / 2.0L : kind == 1 ? 1 / 3.0L : 5 / 6.0L));
    if (ticks < 20 || ticks > 50'000) continue;
    ++ramps;
    const Real time = ticks / speed * (kind == 0 ? 2 : kind == 1 ? 3 : 6 / 5.0L);  // fitted to whole ticks
    const Real t = time / kUpdate;                                                 // updates
    Piece p{};
    Real bend = 0;  // change of the rate in the last update, relative to the speed
    if (kind == 0) {
      p = {rounded(speed / t / 2), rounded_signed(speed / t), 0, 1};
      bend = 1 / t;
    } else if (kind == 1) {
      const Real jerk = 2 * speed / (t * t);
      p = {rounded(jerk / 6), rounded_signed(jerk), rounded_signed(jerk), 1};
      bend = 2 / t;
    } else {
      const Real jerk = speed / (t * t);  // v = s/2 + j t T - j t^2 / 2, whose mean in update i is as below
      p = {rounded(speed / 2 + jerk * t / 2 - jerk / 6), rounded_signed(jerk * t - jerk), rounded_signed(-jerk), 1};
      bend = 1 / t;  // in the first update
    }
    FeedGenerator feed;
    load_and_swap(feed, p);
    const std::uint64_t taken =
        clocks_to_tick(feed, static_cast<std::uint64_t>(ticks), static_cast<std::uint64_t>(2 * time));
    ASSERT_NE(taken, 0U);
    const Real reached = slope_of(feed) / speed;
    EXPECT_LE(std::fabs(reached - 1), bend * (0.5L + (1 + 8 / t) / kUpdate + 2 / t))
        << "kind " << kind << " updates " << t;
    EXPECT_LE(std::fabs(static_cast<Real>(taken) - time), 1 + 8 / t) << "kind " << kind << " updates " << t;
  }
}

// Each piece reloads its rate, so the error at its end does not accumulate along the chain.
TEST(FeedGenerator, AChainOfRampsKeepsItsRate) {
  Random random(8);
  FeedGenerator feed;
  Real from = 0.032L;
  for (int i = 0; i < 1500; ++i) {
    const Real to = random.log_uniform(0.0128L, 0.0512L);
    const Real ticks = 20 + std::round(random.log_uniform(1, 3000));
    const Real acceleration = (to * to - from * from) / (2 * ticks) * kUpdate;
    const Piece p{rounded(from + acceleration / 2), rounded_signed(acceleration), 0, 0x10'0000};
    load_and_swap(feed, p);
    ASSERT_NE(clocks_to_tick(feed, static_cast<std::uint64_t>(ticks), 10'000'000), 0U);
    // Up to one update's change, plus one tick more or less at this acceleration because of the initial phase.
    const Real tolerance = std::fabs(acceleration) * 1.5L + std::fabs(acceleration) / kUpdate / std::min(from, to);
    ASSERT_NEAR(static_cast<double>(slope_of(feed)), static_cast<double>(to), static_cast<double>(tolerance)) << i;
    from = to;
  }
}

}  // namespace
}  // namespace trammel::model
