// Pieces that double SLEW a number of times, on the golden card: holds, overrides, under-runs, and changes between
// pieces.
#include <gtest/gtest.h>

#include "core_bench.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;

constexpr std::uint64_t kTickIn16 = std::uint64_t{1} << 60;  // a tick in 16 clocks
constexpr std::uint32_t kLowSlew = 1U << 14;                 // 65,536 clocks from 1 to 0
constexpr std::uint64_t kFullRamp = std::uint64_t{1} << 30;  // divided by SLEW: clocks from 1 to 0

constexpr std::uint8_t piece_flags(unsigned shift, std::uint8_t piece_class = card_map::constant::kClassFeed) {
  return static_cast<std::uint8_t>(piece_class + shift * card_map::constant::kPieceDoubling);
}

struct ShiftBench : CoreBench {
  ShiftBench() {
    write(reg::step_length(0), 1);
    write(reg::kSlew, kLowSlew);
  }
  bool piece(std::uint64_t ticks, unsigned shift, std::uint32_t stop_distance = 0) {
    return send(command_words(card_map::Opcode::Feed, piece_flags(shift), number++, ticks,
                              {{"rate", kTickIn16}, {"floor", 1}, {"stop_distance", stop_distance}}));
  }
  std::uint32_t ratio() const { return core.outputs().ratio; }
  // Clocks until the ratio is `wanted`.
  std::uint64_t until(std::uint32_t wanted) {
    std::uint64_t clocks = 0;
    for (; ratio() != wanted && clocks < 1'000'000; ++clocks) idle(1);
    return clocks;
  }
  // Checks the ramps of a hold and of its end.
  void expect_ramps(unsigned shift) {
    const auto ramp = static_cast<double>(kFullRamp / kLowSlew >> shift);
    ASSERT_TRUE(write(reg::kHold, 1));
    EXPECT_NEAR(static_cast<double>(until(0)), ramp, 16) << shift;
    ASSERT_TRUE(write(reg::kHold, 0));
    EXPECT_NEAR(static_cast<double>(until(0x10000)), ramp, 16) << shift;
  }
};

TEST(SlewShift, HoldsAndTheirEndsAreTheSooner) {
  for (unsigned shift = 0; shift <= card_map::constant::kMaxSlewShift; ++shift) {
    ShiftBench bench;
    ASSERT_TRUE(bench.piece(100'000, shift));
    ASSERT_TRUE(bench.line(100'000, {kOnePulse / 2}));
    bench.idle(100);
    ASSERT_NO_FATAL_FAILURE(bench.expect_ramps(shift));
    ASSERT_TRUE(bench.write(reg::kRatioFeed, 0x8000));
    EXPECT_NEAR(static_cast<double>(bench.until(0x8000)), static_cast<double>(kFullRamp / kLowSlew >> shift) / 2, 16);
  }
}

// The shift changes with the piece, in the middle of a ramp.
TEST(SlewShift, ChangesWithThePiece) {
  ShiftBench bench;
  constexpr std::uint64_t kTicks = 400;
  ASSERT_TRUE(bench.write(reg::kHold, 1));
  EXPECT_NE(bench.until(0), 1'000'000U);
  for (const unsigned shift : {1U, 0U, 3U}) ASSERT_TRUE(bench.piece(kTicks, shift));
  ASSERT_TRUE(bench.line(3 * kTicks, {kOnePulse / 2}));
  ASSERT_TRUE(bench.end());
  bench.idle(100);
  ASSERT_TRUE(bench.write(reg::kHold, 0));
  for (const unsigned shift : {1U, 0U, 3U}) {
    const std::uint32_t begun = bench.core.outputs().feed_begun;
    bench.idle(100);
    while (bench.ratio() < 0x10000 && bench.core.outputs().feed_begun == begun) {
      const std::uint32_t before = bench.ratio();
      bench.idle(64);
      if (bench.core.outputs().feed_begun != begun || bench.ratio() == 0x10000) break;
      EXPECT_EQ(bench.ratio() - before, 16 * (kLowSlew << shift >> 12)) << shift;
    }
    while (bench.core.outputs().feed_begun == begun && (bench.core.outputs().status & 1) != 0) bench.idle(1);
  }
  EXPECT_EQ(bench.ratio(), 0x10000U) << "the last one has brought it there";
}

TEST(SlewShift, StaysAtABarrierAndAfterTheEndAndEndsWithACut) {
  ShiftBench bench;
  ASSERT_TRUE(bench.piece(10, 3));
  ASSERT_TRUE(bench.line(10, {kOnePulse / 2}));
  ASSERT_TRUE(bench.dwell(100'000));
  ASSERT_TRUE(bench.end());
  bench.idle(1000);
  ASSERT_NO_FATAL_FAILURE(bench.expect_ramps(3));
  ASSERT_TRUE(bench.finish(200'000));
  ASSERT_NO_FATAL_FAILURE(bench.expect_ramps(3));
  ASSERT_TRUE(bench.write(reg::kControl, card_map::field::kControlAbort));
  ASSERT_NO_FATAL_FAILURE(bench.expect_ramps(0));
}

TEST(SlewShift, IsNoneInADirectMove) {
  ShiftBench bench;
  ASSERT_TRUE(bench.piece(10, 2));
  ASSERT_TRUE(bench.line(10, {kOnePulse / 2}));
  ASSERT_TRUE(bench.end());
  ASSERT_TRUE(bench.finish(10'000));
  ASSERT_TRUE(bench.write(reg::frequency_lo(0), 1U << 30));
  ASSERT_TRUE(bench.write(reg::frequency_hi(0), 0));
  ASSERT_TRUE(bench.write(reg::count(0), 1000));
  ASSERT_TRUE(bench.write(reg::kLengthLo, 1'000'000));
  ASSERT_TRUE(bench.write(reg::kLengthHi, 0));
  ASSERT_TRUE(bench.write(reg::kStart, 1));
  bench.idle(100);
  ASSERT_NO_FATAL_FAILURE(bench.expect_ramps(0));
}

// A starved card comes to rest before its queues are empty if the stop distance fits its slew; this distance is not
// much more than necessary.
TEST(SlewShift, StopDistanceIsThatOfTheDoubledSlew) {
  for (unsigned shift = 0; shift <= card_map::constant::kMaxSlewShift; ++shift) {
    ShiftBench bench;
    const std::uint64_t stop = kFullRamp / kLowSlew / 2 / 16 >> shift;
    constexpr std::uint64_t kTicks = 10'000;
    ASSERT_TRUE(bench.piece(kTicks, shift, static_cast<std::uint32_t>(stop)));
    ASSERT_TRUE(bench.line(kTicks, {kOnePulse / 2}));
    bench.idle(kTicks * 16 - stop * 16 - 10'000);
    EXPECT_EQ(bench.ratio(), 0x10000U) << shift;
    bench.until(0);
    const std::uint64_t left = kTicks - bench.taken;
    EXPECT_GT(left, 0U) << shift;
    EXPECT_LT(left, card_map::constant::kUnderrunReserveTicks + stop / 64 + 10) << shift;
    EXPECT_EQ(bench.read(reg::kUnderruns), 1U);
  }
}

}  // namespace
}  // namespace trammel::testing
