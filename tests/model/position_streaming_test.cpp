// Position streaming on the golden card, by closed forms. A late line continues as the same line, tick for tick; the
// period is missing after stale_periods times its ticks; the stop is where the formula says.
#include "trammel/model/position_streaming.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core_bench.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr std::uint64_t kHalf = std::uint64_t{1} << 63;  // a tick every other clock
constexpr std::uint64_t kPeriodTicks = 200;              // ticks per period
const std::vector<std::int64_t> kIncrements{kOnePulse / 7, -kOnePulse / 3, 12345678, 0};

// Position after k ticks of a line.
std::int32_t after(std::int64_t increment, std::uint64_t k) {
  const int128 phase = kOnePulse / 2 + int128{increment} * static_cast<std::int64_t>(k);
  return static_cast<std::int32_t>(phase >> 40);
}

// True when all axes are at the same tick of the line, at most `on_the_way` ticks before `ticks`: a cut loses the ticks
// that have not reached the axes.
constexpr std::uint64_t kOnTheWay = 6;
bool on_the_line(const CoreBench& bench, std::uint64_t ticks, std::uint64_t on_the_way) {
  for (std::uint64_t k = ticks - on_the_way; k <= ticks; ++k) {
    bool all = true;
    for (unsigned n = 0; n < 4; ++n)
      all = all && static_cast<std::int32_t>(bench.core.position(n)) == after(kIncrements[n], k);
    if (all) return true;
  }
  return false;
}

class Stream {
 public:
  explicit Stream(std::uint32_t stale_periods) {
    EXPECT_TRUE(
        bench.write(reg::kStreaming, field::kStreamingOn | stale_periods << field::kStreamingStalePeriodsShift));
    EXPECT_TRUE(bench.write(reg::kStopReaction, field::kStopReactionMissingPeriod));
    bench.write(reg::kHold, 1);
  }

  // Runs until the last tick of the current line is taken.
  void to_the_end(std::uint64_t ticks) {
    while (ticks != 0) {
      bench.idle(1);
      ticks -= bench.core.outputs().tick ? 1U : 0U;
    }
  }
  bool stale() const { return (bench.core.outputs().status & field::kStatusStale) != 0; }
  std::uint32_t fault() const { return bench.core.outputs().fault; }

  CoreBench bench;
};

TEST(PositionStreaming, ALateLineGoesOnAlongItself) {
  unsigned stale = 0;
  for (std::uint64_t clocks = 0; clocks < 2 * kPeriodTicks; clocks += 7) {
    Stream s(2);
    ASSERT_TRUE(s.bench.feed(1, kHalf));
    ASSERT_TRUE(s.bench.line(kPeriodTicks, kIncrements));
    s.bench.write(reg::kHold, 0);
    s.to_the_end(kPeriodTicks);
    s.bench.idle(clocks);
    ASSERT_TRUE(s.bench.line(kPeriodTicks, kIncrements));
    ASSERT_TRUE(s.bench.end());
    const std::uint64_t beyond = s.bench.read(reg::kStaleTicks);
    ASSERT_TRUE(s.bench.finish(5 * kPeriodTicks));
    EXPECT_EQ(s.fault(), 0U);
    EXPECT_NE(s.bench.core.outputs().status & field::kStatusEnded, 0U);
    // Sending its words took some clocks too.
    EXPECT_GE(beyond, clocks / 2 + 30);
    EXPECT_LT(beyond, clocks / 2 + 120);
    // The period after it ended in time, so no ticks went beyond its end.
    EXPECT_EQ(s.bench.read(reg::kStaleTicks), 0U);
    for (unsigned n = 0; n < 4; ++n) {
      const auto position = static_cast<std::int32_t>(s.bench.core.position(n));
      EXPECT_EQ(position, after(kIncrements[n], kPeriodTicks + beyond) + after(kIncrements[n], kPeriodTicks)) << clocks;
    }
    ++stale;
  }
  EXPECT_GT(stale, 50U);
}

// FAULT after exactly stale_periods * N ticks, then a ramp along the line.
TEST(PositionStreaming, AMissingPeriodStopsOnTheLine) {
  for (std::uint32_t stale_periods = 0; stale_periods < 4; ++stale_periods) {
    for (const std::uint32_t slew : {0x10'0000U, 0x40'0000U, 0xFFF'FFFFU}) {
      Stream s(stale_periods);
      s.bench.write(reg::kSlew, slew);
      ASSERT_TRUE(s.bench.feed(kPeriodTicks, kHalf));
      ASSERT_TRUE(s.bench.line(kPeriodTicks, kIncrements));
      s.bench.write(reg::kHold, 0);
      s.to_the_end(kPeriodTicks);
      std::uint64_t ticks = 0;
      std::uint64_t at_fault = 0;
      double ratio = 0;  // ratio at the start of the ramp; below 1 while the rise after the hold goes on
      while ((s.bench.core.outputs().status & field::kStatusBusy) != 0) {
        if (s.fault() == 0) at_fault = ticks;
        ratio = std::max(ratio, s.bench.core.outputs().ratio * 0x1p-16);
        s.bench.idle(1);
        ticks += s.bench.core.outputs().tick ? 1U : 0U;
      }
      EXPECT_EQ(s.fault(), field::kFaultMissingPeriod);
      // Ticks and the fault are visible two clocks after their decision, and ticks are two clocks apart: the count may
      // differ by 1.
      EXPECT_LE(stale_periods * kPeriodTicks, at_fault + 1) << stale_periods;
      EXPECT_LE(at_fault, stale_periods * kPeriodTicks + 1) << stale_periods;
      EXPECT_EQ(s.bench.read(reg::kStaleTicks), ticks);
      // From full ratio the ramp takes 2^28 / slew updates of 4 clocks. Full ratio gives half a tick per clock, the
      // ramp on average a quarter.
      const double ramp = ratio * ratio * 0x1p28 / slew * 4 * 0.25;
      EXPECT_NEAR(static_cast<double>(ticks - stale_periods * kPeriodTicks), ramp, 8) << slew;
      // The last ticks of a slow ramp are far apart, so none is on its way at the cut.
      EXPECT_TRUE(on_the_line(s.bench, kPeriodTicks + ticks, slew == 0xFFF'FFFFU ? kOnTheWay : 0)) << slew;
      EXPECT_EQ(s.bench.read(reg::kStopTimeHi), 0U);
      EXPECT_EQ(s.bench.read(reg::kStopFault), field::kFaultMissingPeriod);
    }
  }
}

TEST(PositionStreaming, AnImmediateReactionCutsAtOnce) {
  Stream s(1);
  s.bench.write(reg::kStopReaction, 0);
  s.bench.feed(1, kHalf);
  s.bench.line(kPeriodTicks, kIncrements);
  s.bench.write(reg::kHold, 0);
  ASSERT_TRUE(s.bench.finish(10 * kPeriodTicks));
  EXPECT_EQ(s.fault(), field::kFaultMissingPeriod);
  const std::uint32_t ticks = s.bench.read(reg::kStaleTicks);
  EXPECT_GE(ticks, kPeriodTicks);
  EXPECT_LE(ticks, kPeriodTicks + 2);
  EXPECT_TRUE(on_the_line(s.bench, kPeriodTicks + ticks, kOnTheWay));
  // Clearing the fault opens the stream again and moves nothing.
  EXPECT_FALSE(s.bench.end());
  s.bench.write(reg::kFault, field::kFaultMissingPeriod);
  s.bench.number = 0;
  EXPECT_TRUE(s.bench.end());
}

// Consecutive periods: a tick every other clock, without a gap.
TEST(PositionStreaming, PeriodsInTimeHaveNoSeam) {
  Stream s(1);
  s.bench.feed(1, kHalf);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(s.bench.line(kPeriodTicks + static_cast<std::uint64_t>(i) % 3, kIncrements));
  ASSERT_TRUE(s.bench.end());
  s.bench.write(reg::kHold, 0);
  std::vector<std::uint64_t> ticks;
  while ((s.bench.core.outputs().status & field::kStatusBusy) != 0) {
    s.bench.idle(1);
    if (s.bench.core.outputs().tick) ticks.push_back(s.bench.core.cycles());
    EXPECT_FALSE(s.stale());
  }
  // The first ticks belong to the ramp out of the hold.
  ASSERT_EQ(ticks.size(), 20 * kPeriodTicks + 19);
  for (std::size_t i = 100; i < ticks.size(); ++i) EXPECT_EQ(ticks[i] - ticks[i - 1], 2U) << i;
  EXPECT_EQ(s.fault(), 0U);
}

// An accelerating piece keeps the rate that it has reached when its ticks are used up.
TEST(PositionStreaming, ASpentPieceKeepsItsRate) {
  Stream s(4);
  const auto acceleration = static_cast<std::int64_t>(0x1p64 / 2000);
  s.bench.feed(kPeriodTicks, kHalf / 4, acceleration);
  s.bench.line(kPeriodTicks, kIncrements);
  s.bench.write(reg::kHold, 0);
  s.to_the_end(kPeriodTicks);
  s.bench.idle(50);
  ASSERT_TRUE(s.stale());
  const std::uint32_t rate = s.bench.core.outputs().rate;
  EXPECT_GT(rate, kHalf / 4 >> 32);
  for (int i = 0; i < 500; ++i) {
    s.bench.idle(1);
    EXPECT_EQ(s.bench.core.outputs().rate, rate);
  }
}

TEST(PositionStreaming, TheModeChangesAtRestAlone) {
  CoreBench bench;
  bench.write(reg::kHold, 1);
  bench.feed(2 * kPeriodTicks, kHalf);
  bench.line(kPeriodTicks, kIncrements);
  bench.write(reg::kStreaming, field::kStreamingOn);
  bench.line(kPeriodTicks, kIncrements);
  bench.write(reg::kHold, 0);
  ASSERT_TRUE(bench.finish(10'000));
  EXPECT_EQ(bench.core.outputs().fault, 0U);
  // Streaming is now on: if no other period follows, the next line is the last one.
  bench.feed(kPeriodTicks, kHalf);
  bench.line(kPeriodTicks, kIncrements);
  // The host switches it off, but a line is running.
  bench.write(reg::kStreaming, 0);
  ASSERT_TRUE(bench.finish(10'000));
  EXPECT_EQ(bench.core.outputs().fault, field::kFaultMissingPeriod);
  ASSERT_TRUE(bench.write(reg::kFault, field::kFaultMissingPeriod));
  bench.number = 0;
  bench.feed(kPeriodTicks, kHalf);
  bench.line(kPeriodTicks, kIncrements);
  ASSERT_TRUE(bench.finish(10'000));
  EXPECT_EQ(bench.core.outputs().fault, 0U);
}

// The mode does not change inside a command either: the whole command belongs to the old mode.
TEST(PositionStreaming, TheModeWaitsForTheEndOfACommand) {
  CoreBench bench;
  bench.feed(kPeriodTicks, kHalf);
  const std::vector<std::uint32_t> words =
      command_words(card_map::Opcode::Line, 15, bench.number++, kPeriodTicks, {}, kIncrements);
  bench.send({words.begin(), words.begin() + 3});
  bench.write(reg::kStreaming, field::kStreamingOn);
  bench.idle(100);
  bench.send({words.begin() + 3, words.end()});
  ASSERT_TRUE(bench.finish(10'000));
  EXPECT_EQ(bench.core.outputs().fault, 0U);
}

// A hold and a ratio of 0 stop the ticks, so no period is missing meanwhile.
TEST(PositionStreaming, NothingIsMissingInAHold) {
  for (const std::uint32_t address : {reg::kHold, reg::kRatioFeed}) {
    Stream s(1);
    s.bench.feed(1, kHalf);
    s.bench.line(kPeriodTicks, kIncrements);
    s.bench.write(reg::kHold, 0);
    s.to_the_end(kPeriodTicks);
    s.bench.idle(10);
    s.bench.write(address, address == reg::kHold ? 1 : 0);
    s.bench.idle(50 * kPeriodTicks);
    EXPECT_TRUE(s.stale());
    EXPECT_EQ(s.fault(), 0U);
    const std::uint32_t beyond = s.bench.read(reg::kStaleTicks);
    EXPECT_LT(beyond, kPeriodTicks);
    // The next line begins at once, before any tick.
    const std::uint32_t begun = s.bench.core.outputs().geometry_begun;
    s.bench.line(kPeriodTicks, kIncrements);
    s.bench.idle(40);
    EXPECT_EQ(s.bench.core.outputs().geometry_begun, begun + 1);
    EXPECT_FALSE(s.stale());
    EXPECT_EQ(s.bench.read(reg::kStaleTicks), beyond);
    s.bench.end();
    s.bench.write(address, address == reg::kHold ? 0 : 0x10000);
    ASSERT_TRUE(s.bench.finish(10 * kPeriodTicks));
    EXPECT_EQ(s.fault(), 0U);
  }
}

// The under-run guard is off in position streaming.
TEST(PositionStreaming, TheGuardIsOff) {
  for (const bool streaming : {false, true}) {
    CoreBench bench;
    bench.write(reg::kStreaming, streaming ? field::kStreamingOn : 0);
    bench.send(command_words(card_map::Opcode::Feed, 0, bench.number++, kPeriodTicks,
                             {{"rate", kHalf}, {"floor", 1}, {"stop_distance", 5000}}));
    bench.line(kPeriodTicks, kIncrements);
    bench.idle(200);
    EXPECT_EQ(bench.core.outputs().geometry_begun, 1U);
    EXPECT_EQ((bench.core.outputs().status & field::kStatusUnderrun) != 0, !streaming);
    bench.idle(4 * kPeriodTicks);
    EXPECT_EQ((bench.core.outputs().status & field::kStatusFaulted) != 0, streaming);
  }
}

// A late END ends the line at its present position.
TEST(PositionStreaming, ALateEndIsAnEnd) {
  Stream s(3);
  s.bench.feed(1, kHalf);
  s.bench.line(kPeriodTicks, kIncrements);
  s.bench.write(reg::kHold, 0);
  s.to_the_end(kPeriodTicks);
  s.bench.idle(kPeriodTicks);
  s.bench.end();
  ASSERT_TRUE(s.bench.finish(1000));
  EXPECT_EQ(s.fault(), 0U);
  const std::uint32_t beyond = s.bench.read(reg::kStaleTicks);
  EXPECT_GT(beyond, kPeriodTicks / 2);
  for (unsigned n = 0; n < 4; ++n)
    EXPECT_EQ(static_cast<std::int32_t>(s.bench.core.position(n)), after(kIncrements[n], kPeriodTicks + beyond));
}

}  // namespace
}  // namespace trammel::testing
