// The golden core as a whole, by what the page says of it.
#include "trammel/model/core_model.hpp"

#include <gtest/gtest.h>

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
