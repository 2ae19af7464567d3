// OUTPUT, MARK and the pins on the golden core, against their documentation.
#include "trammel/model/path_commands.hpp"

#include <gtest/gtest.h>

#include "core_bench.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;
using card_map::Area;

constexpr std::uint64_t kFastest = ~std::uint64_t{0};  // a tick nearly every clock
constexpr std::uint64_t kAll = ~std::uint64_t{0};

// Runs until `happened`, at most `limit` clocks; returns the cycle after which it shows.
template <class Happened>
std::uint64_t cycle_of(CoreBench& bench, std::uint64_t limit, Happened happened) {
  for (; limit != 0; --limit) {
    bench.idle(1);
    if (happened(bench.core.outputs())) return bench.core.cycles();
  }
  return kAll;
}

// A line whose only step is in its last tick: half a pulse over n ticks, rounded up.
bool line_with_last_step(CoreBench& bench, std::uint64_t ticks) {
  // 1/2 + n * i reaches 1 only in tick n: i = 1 / 2n, rounded up.
  return bench.line(ticks,
                    {static_cast<std::int64_t>((static_cast<std::uint64_t>(kOnePulse) + 2 * ticks - 1) / (2 * ticks))});
}

TEST(PathCommands, AnOutputChangesWithTheStepOfTheLastTick) {
  for (const std::uint64_t ticks : {1U, 2U, 7U, 40U, 200U}) {
    CoreBench bench;
    bench.write(reg::kHold, 1);
    ASSERT_TRUE(line_with_last_step(bench, ticks));
    ASSERT_TRUE(bench.output(0b0101, 0));
    ASSERT_TRUE(line_with_last_step(bench, 500));
    ASSERT_TRUE(bench.feed(ticks + 500, kFastest / 3));
    bench.write(reg::kHold, 0);
    std::uint64_t step = kAll;
    std::uint64_t change = kAll;
    for (int i = 0; i < 1000 && change == kAll; ++i) {
      bench.idle(1);
      if (step == kAll && bench.core.outputs().path_step != 0) step = bench.core.cycles();
      if (bench.core.outputs().output != 0) change = bench.core.cycles();
    }
    EXPECT_NE(step, kAll) << ticks;
    EXPECT_EQ(change, step) << ticks;
    EXPECT_EQ(bench.core.outputs().output, 0b0101U);
  }
}

TEST(PathCommands, WhereNothingRunsAnOutputComesAtOnce) {
  CoreBench bench;
  bench.idle(300);
  ASSERT_TRUE(bench.output(0b1000, 0));
  EXPECT_LT(cycle_of(bench, 40, [](const auto& o) { return o.output == 0b1000; }), kAll);
  // The output does not wait for the path behind it.
  ASSERT_TRUE(bench.output(0, 0b1000));
  ASSERT_TRUE(bench.line(100, {kOnePulse / 2}));
  EXPECT_LT(cycle_of(bench, 40, [](const auto& o) { return o.output == 0; }), kAll);
}

TEST(PathCommands, SeveralInARowMergeAndTheLaterWins) {
  CoreBench bench;
  bench.write(reg::kHold, 1);
  ASSERT_TRUE(line_with_last_step(bench, 30));
  ASSERT_TRUE(bench.feed(30, kFastest / 3));
  ASSERT_TRUE(bench.output(0b0011, 0));
  ASSERT_TRUE(bench.output(0b0100, 0b0001));
  ASSERT_TRUE(bench.output(0b1000, 0b1100));  // an output that is set and cleared is set
  bench.idle(200);
  bench.write(reg::kHold, 0);
  std::vector<std::uint32_t> seen;
  for (int i = 0; i < 300; ++i) {
    bench.idle(1);
    if (seen.empty() || seen.back() != bench.core.outputs().output) seen.push_back(bench.core.outputs().output);
  }
  EXPECT_EQ(seen, (std::vector<std::uint32_t>{0, 0b1010}));
}

// Longest distance between two ticks, in clocks, of lines of 4 axes with `outputs` OUTPUTs and `marks` MARKs after
// each.
std::uint64_t largest_gap(std::uint64_t ticks, unsigned outputs, unsigned marks) {
  CoreBench bench;
  bench.write(reg::kHold, 1);
  constexpr unsigned kLines = 12;
  for (unsigned i = 0; i < kLines; ++i) {
    const std::int64_t increment = kOnePulse / 64;
    EXPECT_TRUE(bench.line(ticks, {increment, increment, increment, increment}));
    for (unsigned k = 0; k < outputs; ++k) EXPECT_TRUE(bench.output(1, 2));
    for (unsigned k = 0; k < marks; ++k) EXPECT_TRUE(bench.mark());
  }
  EXPECT_TRUE(bench.feed(kLines * ticks, kFastest));
  bench.write(reg::kHold, 0);
  std::uint64_t last = 0;
  std::uint64_t largest = 0;
  for (unsigned i = 0; i < 3000; ++i) {
    bench.idle(1);
    if (!bench.core.outputs().tick) continue;
    if (last != 0) largest = std::max(largest, bench.core.cycles() - last);
    last = bench.core.cycles();
  }
  return largest;
}

TEST(PathCommands, DecodeLengthensTheGapFreeLine) {
  for (unsigned outputs = 0; outputs < 3; ++outputs) {
    for (unsigned marks = 0; marks < 3; ++marks) {
      const std::uint64_t ticks = 20 + 10 * outputs + 8 * marks;
      // About one clock in 2^48 has no tick.
      EXPECT_LE(largest_gap(ticks, outputs, marks), 2U) << outputs << " " << marks;
      EXPECT_GT(largest_gap(ticks - 2, outputs, marks), 2U) << outputs << " " << marks;
    }
  }
}

TEST(PathCommands, ResetHasTheStrapsLevelsAndACutTheSafeOnes) {
  model::CardConfig config;
  config.outputs = 5;
  config.output_idle = 0b10011;
  CoreBench bench(config);
  EXPECT_EQ(bench.core.outputs().output, 0b10011U);
  bench.idle(300);
  EXPECT_EQ(bench.read(reg::kOutputs), 0b10011U);
  EXPECT_EQ(bench.read(reg::kPorts), 1U | 4U << 8 | 5U << 16);
  ASSERT_TRUE(bench.write(reg::kOutputSafe, 0b00110 << 16 | 0b01010));
  bench.write(reg::kControl, field::kControlAbort);
  bench.idle(3);
  EXPECT_EQ(bench.core.outputs().output, (0b10011U & ~0b00110U) | 0b00010U);
}

TEST(PathCommands, WhatACutFindsWaitingIsDropped) {
  CoreBench bench;
  ASSERT_TRUE(bench.line(1000, {kOnePulse / 8}));
  ASSERT_TRUE(bench.output(0b1111, 0));
  ASSERT_TRUE(bench.mark());
  ASSERT_TRUE(bench.feed(1000, kFastest / 2));
  bench.idle(100);
  bench.write(reg::kControl, field::kControlAbort);
  bench.idle(3000);
  EXPECT_EQ(bench.core.outputs().output, 0U);
  EXPECT_EQ(bench.read(reg::kMarks), 0U);
  bench.number = 0;
  ASSERT_TRUE(bench.mark());
  bench.idle(30);
  EXPECT_EQ(bench.read(reg::kMarks), 1U);
}

TEST(PathCommands, AMarkCountsAndLatchesTimeAndPosition) {
  CoreBench bench;
  bench.write(reg::kHold, 1);
  ASSERT_TRUE(line_with_last_step(bench, 50));
  ASSERT_TRUE(bench.mark());
  ASSERT_TRUE(bench.mark());
  ASSERT_TRUE(bench.line(400, {kOnePulse / 4}));
  ASSERT_TRUE(bench.feed(450, kFastest / 8));
  bench.write(reg::kHold, 0);
  const std::uint64_t step = cycle_of(bench, 2000, [](const auto& o) { return o.path_step != 0; });
  bench.idle(200);
  EXPECT_EQ(bench.read(reg::kMarks), 2U);
  // TIME is 0 in the first clock after the reset; the strobe comes one clock after the mark.
  EXPECT_EQ(bench.read(reg::time_lo(Area::Mark)), step + 1);
  EXPECT_EQ(bench.read(reg::geometry_begun(Area::Mark)), 2U);
  const auto at = static_cast<std::int32_t>(bench.read(reg::position(Area::Mark, 0)));
  EXPECT_GE(at, 0);
  EXPECT_LE(at, 1);
}

// An access is answered in time, however many marks come.
TEST(PathCommands, ARowOfMarksKeepsNoAccessWaiting) {
  CoreBench bench;
  bench.write(reg::kHold, 1);
  std::uint64_t sent = 0;
  for (unsigned i = 0; i < 60; ++i) {
    ASSERT_TRUE(bench.line(30, {kOnePulse / 64, kOnePulse / 64, kOnePulse / 64, kOnePulse / 64}));
    ASSERT_TRUE(bench.mark());
    sent += 30;
  }
  ASSERT_TRUE(bench.feed(sent, kFastest));
  bench.write(reg::kHold, 0);
  std::uint64_t longest = 0;
  for (unsigned i = 0; i < 60; ++i) {
    const std::uint64_t before = bench.core.cycles();
    bench.write(reg::kControl, field::kControlSnapshot);
    bench.read(reg::kSnapTimeLo);
    longest = std::max(longest, bench.core.cycles() - before);
  }
  bench.idle(3000);
  EXPECT_EQ(bench.read(reg::kMarks), 60U);
  EXPECT_LE(longest, 100U);
}

TEST(PathCommands, InputsAreSeenTwoClocksLateAfterTheirPolarity) {
  model::CardConfig config;
  config.inputs = 6;
  CoreBench bench(config);
  bench.idle(300);
  ASSERT_TRUE(bench.write(reg::kInputPolarity, 0xFF03));
  EXPECT_EQ(bench.read(reg::kInputs), 0b000011U);
  bench.pins = 0xFFF6;
  bench.idle(2);
  EXPECT_EQ(bench.read(reg::kInputs), 0b110101U);
  model::InputPins pins(6);
  pins.clock({0b100000, {}});
  EXPECT_EQ(pins.level(), 0U);
  pins.clock({0, {}});
  EXPECT_EQ(pins.level(), 0b100000U);
  pins.clock({0, {}});
  EXPECT_EQ(pins.level(), 0U);
}

}  // namespace
}  // namespace trammel::testing
