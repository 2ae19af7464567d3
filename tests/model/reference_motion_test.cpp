// Tests of the statements about lines, direct moves, barriers and pins in docs/reference/behaviour.md, on the golden
// model of the whole card, through its bus only.
#include "reference_page.hpp"

namespace trammel::reference_page {
namespace {

// LENGTH and COUNT that disagree: the axis makes exactly COUNT pulses, and the move takes the longer of the two.
TEST(ReferencePage, LengthAndCountThatDisagree) {
  const auto run = [](std::uint32_t count, std::uint64_t length) {
    Host host;
    host.direct(kOnePulse / 100, count, length);
    host.write(reg::kHoldLimit, 0xFFFF);
    const std::uint64_t begin = host.card.cycles();
    EXPECT_TRUE(host.write(reg::kStart, 3));
    host.idle();
    EXPECT_EQ(host.position(0), static_cast<std::int32_t>(count));
    EXPECT_EQ(host.position(1), -static_cast<std::int32_t>(count));
    const std::uint64_t last = host.pins.empty() ? begin : host.pins.back().tick;
    return std::make_pair(last - begin, host.card.cycles() - begin);
  };
  // A pulse per 100 clocks: 1000 clocks have 10.
  const auto [agree_last, agree_end] = run(10, 1000);
  EXPECT_LT(agree_last, 1100U);
  const auto [few_last, few_end] = run(4, 1000);
  EXPECT_LT(few_last, 500U) << "the axis stops at its count";
  EXPECT_GE(few_end, 1000U) << "and the move goes on";
  const auto [many_last, many_end] = run(30, 1000);
  EXPECT_GT(many_last, 2900U) << "at the same frequency until the count is made";
  EXPECT_LT(many_end, 3300U);
  EXPECT_LT(agree_end, 1300U);
}

// Ties: at half a pulse per tick, every second tick is exactly between two pulses.
TEST(ReferencePage, TiesOfLinesAndOfDirectMoves) {
  const auto ticks_of = [](std::int64_t increment) {
    Host host;
    host.send(line(8, increment));
    host.send(feed(8, 40));
    host.send(driver::EndCommand{});
    host.idle();
    std::vector<std::uint64_t> ticks;
    for (const PathStep& step : host.path) ticks.push_back(step.tick);
    return ticks;
  };
  // x_k = floor(1/2 + k / 2): steps up come at the tie, steps down one tick after it.
  EXPECT_EQ(ticks_of(kOnePulse / 2), (std::vector<std::uint64_t>{1, 3, 5, 7}));
  EXPECT_EQ(ticks_of(-kOnePulse / 2), (std::vector<std::uint64_t>{2, 4, 6, 8}));
  Host host;
  host.direct(kOnePulse / 2, 4, 8);
  EXPECT_TRUE(host.write(reg::kStart, 3));
  host.idle();
  ASSERT_EQ(host.path.size(), 8U);
  for (std::size_t i = 0; i < 8; i += 2) {
    EXPECT_EQ(host.path[i].tick, host.path[i + 1].tick) << "an axis and its mirror image step together";
    EXPECT_EQ(host.path[i].direction, -host.path[i + 1].direction);
  }
}

// Clocks without a tick at a barrier, at one tick per clock. Each of the two lines has 4 ticks and a step at the second
// one, so that without the barrier the steps would be 4 clocks apart.
TEST(ReferencePage, ABarrierOfNClocksStopsTheTicksForOverheadAndMaxOneN) {
  const auto gap = [](const driver::Command& barrier, unsigned axes) {
    Host host(8);
    host.write(reg::kHold, 1);
    host.clocks(20);
    driver::LineCommand next = line(4, kOnePulse / 4);
    next.mask = static_cast<std::uint8_t>((1U << axes) - 1);
    host.send(line(4, kOnePulse / 4));
    host.send(feed(4));
    host.send(barrier);
    host.send(next);
    host.send(feed(4));
    host.write(reg::kHold, 0);
    host.clocks(3000);
    EXPECT_EQ(host.pins.size(), 2U);
    return host.pins[1].tick - host.pins[0].tick - 4;
  };
  for (unsigned axes = 1; axes <= 8; ++axes) {
    const std::uint64_t overhead = std::max(38U, 22 + 3 * axes);
    EXPECT_EQ(gap(driver::DwellCommand{0}, axes), overhead + 1) << axes;
    EXPECT_EQ(gap(driver::DwellCommand{1}, axes), overhead + 1);
    EXPECT_EQ(gap(driver::DwellCommand{2}, axes), overhead + 2);
    EXPECT_EQ(gap(driver::DwellCommand{1000}, axes), overhead + 1000);
    EXPECT_EQ(gap(driver::EndCommand{}, axes), overhead + 1);
  }
}

// Levels of the pins in each mode while axis 0 makes three steps up and three down.
TEST(ReferencePage, WhichPinIsWhich) {
  const auto pins = [](std::uint32_t mode) {
    Host host;
    host.write(reg::mode(0), mode);
    host.write(reg::step_length(0), 4);
    host.clocks(5);
    host.send(line(3, kOnePulse));
    host.send(line(3, -kOnePulse));
    host.send(feed(6, 100));
    host.send(driver::EndCommand{});
    std::vector<unsigned> seen;
    for (int clock = 0; clock < 2000; ++clock) {
      host.card.clock({});
      const auto& out = host.card.outputs();
      const unsigned now = (out.step & 1U) | (out.dir & 1U) << 1;
      if (seen.empty() || seen.back() != now) seen.push_back(now);
    }
    return seen;
  };
  using Seen = std::vector<unsigned>;  // bit 0 first pin, bit 1 second
  EXPECT_EQ(pins(0), (Seen{0, 1, 0, 1, 0, 1, 0, 2, 3, 2, 3, 2, 3, 2})) << "STEP, and DIR high for negative";
  EXPECT_EQ(pins(1), (Seen{0, 1, 0, 1, 0, 1, 0, 2, 0, 2, 0, 2, 0})) << "first pin up, second down";
  EXPECT_EQ(pins(2), (Seen{0, 1, 3, 2, 3, 1, 0})) << "the first pin leads going up";
  EXPECT_EQ(pins(field::kModeInvertFirst), (Seen{1, 0, 1, 0, 1, 0, 1, 3, 2, 3, 2, 3, 2, 3}));
}

TEST(ReferencePage, TheShapersReversal) {
  Host host;
  host.write(reg::step_length(0), 5);
  host.write(reg::step_space(0), 3);
  host.write(reg::dir_setup(0), 7);
  host.write(reg::dir_hold(0), 9);
  host.write(reg::kHold, 1);
  host.clocks(20);
  host.send(line(1, kOnePulse));
  host.send(line(1, -kOnePulse));
  host.send(feed(2));
  host.send(driver::EndCommand{});
  host.write(reg::kHold, 0);
  host.idle();
  ASSERT_EQ(host.pins.size(), 2U);
  EXPECT_EQ(host.pins[1].tick - host.pins[0].tick, 5U + 3 + 9 + 7 + 12);
}

TEST(ReferencePage, TheShapersShortestPeriod) {
  for (const std::uint32_t length : {0U, 1U, 5U}) {
    for (const std::uint32_t space : {0U, 1U, 9U}) {
      Host host;
      host.write(reg::step_length(0), length);
      host.write(reg::step_space(0), space);
      host.write(reg::kHold, 1);
      host.clocks(20);
      host.send(line(4, kOnePulse));
      host.send(feed(4));
      host.send(driver::EndCommand{});
      host.write(reg::kHold, 0);
      host.idle();
      ASSERT_EQ(host.pins.size(), 4U);
      const std::uint64_t period = std::max(1U, length) + space + 6 - (length == 0 ? 1 : 0);
      for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(host.pins[i].tick - host.pins[i - 1].tick, period) << length;
    }
  }
}

}  // namespace
}  // namespace trammel::reference_page
