// The golden core as a whole, by what the page says of it.
#include "trammel/model/core_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core_bench.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;

constexpr std::uint64_t kWhole = ~std::uint64_t{0};  // a tick nearly every clock

TEST(CoreModel, AccessesAnswerAfterFourAndFiveClocks) {
  CoreBench bench;
  bench.idle(300);
  std::uint64_t before = bench.core.cycles();
  ASSERT_TRUE(bench.write(reg::kHoldLimit, 1234));
  EXPECT_EQ(bench.core.cycles() - before, 4U);
  before = bench.core.cycles();
  EXPECT_EQ(bench.read(reg::kHoldLimit), 1234U);
  EXPECT_EQ(bench.core.cycles() - before, 5U);
}

TEST(CoreModel, ALineMovesItsAxes) {
  CoreBench bench;
  ASSERT_TRUE(bench.line(1000, {100 * kOnePulse / 1000, -(50 * kOnePulse / 1000)}));
  ASSERT_TRUE(bench.feed(1000, kWhole / 4));
  ASSERT_TRUE(bench.end());
  ASSERT_TRUE(bench.finish(10000));
  EXPECT_EQ(bench.core.position(0), 100U);
  EXPECT_EQ(bench.core.position(1), 0U - 50U);
  EXPECT_EQ(bench.core.outputs().fault, 0U);
  EXPECT_EQ(bench.core.outputs().status & 0x3F, 0x20U) << "ended";
  EXPECT_EQ(bench.core.outputs().geometry_begun, 2U);
  EXPECT_EQ(bench.core.outputs().feed_begun, 2U);
}

TEST(CoreModel, ACircleComesBack) {
  CoreBench bench;
  for (const std::int64_t r : {1, 10, 100}) {
    ASSERT_TRUE(bench.circle(static_cast<std::uint64_t>(r) * 8 * 20, r));
    ASSERT_TRUE(bench.feed(static_cast<std::uint64_t>(r) * 8 * 20, kWhole / 2));
  }
  ASSERT_TRUE(bench.line(10, {kOnePulse / 2}));
  ASSERT_TRUE(bench.feed(10, kWhole / 20));
  ASSERT_TRUE(bench.end());
  ASSERT_TRUE(bench.finish(100000));
  EXPECT_EQ(bench.core.outputs().fault, 0U);
  EXPECT_EQ(bench.core.position(0), 5U);
  EXPECT_EQ(bench.core.position(1), 0U);
  EXPECT_EQ(bench.steps.path.size(), 888U + 5U);
}

// A circle at a tick a clock with a path tick in `each` ticks, and a path after it: the clocks of the circle's last
// path tick and last feed tick, and of the next path's first tick.
struct HandOver {
  std::uint64_t path_tick = 0;
  std::uint64_t tick = 0;
  std::uint64_t first = 0;
};

HandOver hand_over(std::int64_t radius, std::uint64_t each, bool to_arc) {
  CoreBench bench;
  const std::uint64_t ticks = 8 * static_cast<std::uint64_t>(radius) * each;
  bench.logs = true;
  EXPECT_TRUE(bench.write(reg::kHold, 1));
  EXPECT_TRUE(bench.circle(ticks, radius));
  EXPECT_TRUE(to_arc ? bench.circle(400, radius) : bench.line(400, {kOnePulse / 3, kOnePulse / 5}));
  EXPECT_TRUE(bench.feed(ticks + 400, ~std::uint64_t{0}));
  EXPECT_TRUE(bench.write(reg::kHold, 0));
  bench.idle(16 * ticks + 2000);
  HandOver result;
  unsigned swaps = 0;
  for (std::size_t i = 0; i < bench.log.size() && result.first == 0; ++i) {
    const model::CoreModel::Outputs& out = bench.log[i].outputs;
    swaps += out.path_swap ? 1U : 0U;
    if (out.path_tick && swaps == 1) result.path_tick = i;
    if (out.tick) (swaps == 1 ? result.tick : result.first) = i;
  }
  return result;
}

// docs/developer/architecture.md, Sequencers; 29 clocks from where the accumulator is ready, 9 after its last tick.
TEST(CoreModel, HandOverAfterAnArc) {
  for (const std::int64_t radius : {1, 5, 20}) {
    for (const std::uint64_t each : {1U, 2U, 3U, 5U, 9U, 10U, 11U, 14U, 20U, 100U}) {
      const HandOver arc = hand_over(radius, each, true);
      EXPECT_EQ(arc.first, std::max(arc.path_tick + 9 + 29, arc.tick + 37)) << radius << ", " << each;
      const HandOver line = hand_over(radius, each, false);
      EXPECT_EQ(line.first, std::max(line.path_tick + 9 + 4, line.tick + 8)) << radius << ", " << each;
    }
  }
  // A path tick in 20 ticks or more is long finished: 37 and 8 clocks are what remains.
  EXPECT_EQ(hand_over(5, 100, true).first - hand_over(5, 100, true).tick, 37U);
  EXPECT_EQ(hand_over(5, 100, false).first - hand_over(5, 100, false).tick, 8U);
}

TEST(CoreModel, DirectMove) {
  CoreBench bench;
  ASSERT_TRUE(bench.write(reg::frequency_lo(1), 1U << 30));
  ASSERT_TRUE(bench.write(reg::frequency_hi(1), 1));
  ASSERT_TRUE(bench.write(reg::count(1), 17));
  ASSERT_TRUE(bench.write(reg::direction(1), 1));
  ASSERT_TRUE(bench.write(reg::kLengthLo, 100));
  ASSERT_TRUE(bench.write(reg::kStart, 2));
  EXPECT_TRUE((bench.core.outputs().status & 2) != 0);
  ASSERT_TRUE(bench.finish(10000));
  EXPECT_EQ(bench.core.position(1), 0U - 17U);
}

}  // namespace
}  // namespace trammel::testing
