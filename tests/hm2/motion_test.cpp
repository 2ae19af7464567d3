// Compares pulses with closed forms of the rates, and the accumulator with the pins.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "bench.hpp"

namespace trammel::hm2 {
namespace {

// A rate of r is r * f / 2^32 pulses per second: pulse k comes (k - 1) * 2^32 / r clocks after the first one.
TEST(Hm2Motion, ARateIsStepsPerSecondExactly) {
  for (const std::int64_t rate : {rate_of(100'000), -rate_of(33'333.3), rate_of(1234.5), std::int64_t{7'000'001}}) {
    Bench bench;
    bench.set_rate(1, rate);
    bench.run(1.0);
    ASSERT_GT(bench.steps.pins.size(), 1000U);
    double farthest = 0;
    for (std::size_t k = 0; k < bench.steps.pins.size(); ++k) {
      const driver::PinStep& step = bench.steps.pins[k];
      ASSERT_EQ(step.axis, 1);
      ASSERT_EQ(step.direction, rate > 0 ? 1 : -1);
      const double clocks = static_cast<double>(step.cycle - bench.steps.pins[0].cycle);
      farthest =
          std::max(farthest, std::abs(clocks - static_cast<double>(k) * 0x1p32 / std::abs(static_cast<double>(rate))));
    }
    // Each of the two pulses may be off by a tick of two clocks, and by half a pulse (less than one in total) from the
    // rounding at the ends of lines.
    EXPECT_LE(farthest, 4 + 0x1p32 / std::abs(static_cast<double>(rate))) << rate;
  }
}

// The sum of all rates is exact to 2^-32 of a pulse: lines at the rates, then rest.
TEST(Hm2Motion, PulsesAreTheRoundedSumOfRatesTimesClocks) {
  Bench bench;
  test::Random random(26);
  std::array<std::int64_t, 4> sum{};
  for (int period = 0; period < 2000; ++period) {
    std::array<std::int64_t, 4> rates{};
    for (auto& rate : rates)
      rate = static_cast<std::int64_t>(random.uniform(-1, 1) * static_cast<double>(rate_of(60'000)));
    for (unsigned n = 0; n < 4; ++n) bench.set_rate(n, rates[n]);
    const std::uint64_t before = bench.hostmot2.steps().counts().lines;
    bench.run(0.0004);
    const auto lines = static_cast<std::int64_t>(bench.hostmot2.steps().counts().lines - before);
    for (unsigned n = 0; n < 4; ++n)
      sum[n] += lines * static_cast<std::int64_t>(bench.hostmot2.steps().slice()) * rates[n];
  }
  for (unsigned n = 0; n < 4; ++n) bench.set_rate(n, 0);
  bench.run(0.01);
  EXPECT_FALSE(bench.hostmot2.moves());
  for (unsigned n = 0; n < 4; ++n) {
    const std::int64_t expected = (sum[n] + (std::int64_t{1} << 31)) >> 32;
    EXPECT_EQ(bench.pins(n), expected) << "axis " << n;
    EXPECT_EQ(bench.counter(n), expected) << "axis " << n;
    EXPECT_NEAR(bench.place(n), static_cast<double>(sum[n]) * 0x1p-32, 0x1p-15) << "axis " << n;
  }
  EXPECT_EQ(bench.hostmot2.steps().counts().clamped, 0U);
  EXPECT_EQ(bench.hostmot2.steps().counts().stale_ticks, 0U);
}

// In every reading, the accumulator rounds to the counter, which equals the pulses at the pins.
TEST(Hm2Motion, TheAccumulatorIsTheCounterAndItsFractionIsOnTheWay) {
  Bench bench;
  bench.set_rate(0, rate_of(4000));
  bench.run(0.01);
  double last = bench.place(0);
  double farthest = 0;
  for (int look = 0; look < 3000; ++look) {
    const std::uint64_t before = bench.engine->cycles();
    bench.run(0.0000371);
    const double place = bench.place(0);
    const auto counter = bench.hostmot2.steps().counters()[0];
    ASSERT_LE(std::abs(place - counter), 0.5);
    ASSERT_LE(std::abs(bench.pins(0) - counter), 1);  // one pulse may have come after the reading
    const double clocks = static_cast<double>(bench.engine->cycles() - before);
    farthest = std::max(farthest, std::abs(place - last - clocks * 4000 / kClock));
    last = place;
  }
  EXPECT_LT(farthest, 0.1) << "pulses from a steady velocity, between two looks";
}

// From the datagram to the line with the new rate it takes at least the lead, and at most lead and line.
TEST(Hm2Motion, ARateTakesEffectWithinLeadAndLine) {
  Bench bench;
  test::Random random(5);
  bench.set_rate(0, rate_of(50'000));
  bench.run(0.01);
  double longest = 0;
  for (int turn = 0; turn < 200; ++turn) {
    bench.run(random.uniform(0.001, 0.0015));
    const std::uint64_t told = bench.engine->cycles();
    const std::int8_t direction = turn % 2 == 0 ? -1 : 1;
    bench.set_rate(0, direction * rate_of(50'000));
    bench.run(0.001);
    const auto first = std::find_if(bench.steps.pins.begin(), bench.steps.pins.end(), [&](const driver::PinStep& step) {
      return step.cycle > told && step.direction == direction;
    });
    ASSERT_NE(first, bench.steps.pins.end());
    longest = std::max(longest, static_cast<double>(first->cycle - told) / kClock);
  }
  const double pulse = 1.0 / 50'000;
  EXPECT_LT(longest, StepGenerators::kSlice + StepGenerators::kLead + pulse + 20e-6);
  std::cout << "longest time from a rate to its first pulse: " << longest * 1e6 << " us\n";
}

TEST(Hm2Motion, ARateBeyondTheStepTimesIsClampedAndNoPulseIsCountedThatWasNotMade) {
  Bench bench;
  bench.write(map_at::kStepLength, {50, 50, 50, 50});
  bench.write(map_at::kStepSpace, {50, 50, 50, 50});
  bench.set_rate(2, rate_of(1'000'000));
  bench.run(0.1);
  EXPECT_GT(bench.hostmot2.steps().counts().clamped, 150U);
  bench.set_rate(2, 0);
  bench.run(0.01);
  EXPECT_EQ(bench.pins(2), bench.counter(2));
  EXPECT_NEAR(bench.place(2), static_cast<double>(bench.pins(2)), 0.5);
  EXPECT_GT(bench.pins(2), 8500) << "106 clocks a pulse";
  EXPECT_EQ(bench.hostmot2.bites(), 0U);
}

// hm2_eth writes the longest times for axes that are not configured.
TEST(Hm2Motion, LongStepTimesOfAnAxisThatStandsDelayNobody) {
  Bench bench;
  bench.write(map_at::kStepLength, {10, 0x3FFF, 0x3FFF, 0x3FFF});
  bench.write(map_at::kStepSpace, {10, 0x3FFF, 0x3FFF, 0x3FFF});
  bench.set_rate(0, rate_of(20'000));
  bench.run(0.1);
  EXPECT_NEAR(static_cast<double>(bench.hostmot2.steps().counts().lines), 200, 2);
  bench.set_rate(1, rate_of(100));
  bench.run(0.1);
  EXPECT_LT(bench.hostmot2.steps().counts().lines, 220U);
  bench.set_rate(1, 0);
  bench.run(0.1);
  bench.set_rate(0, 0);
  bench.run(0.1);
  EXPECT_NEAR(static_cast<double>(bench.pins(1)), 10, 1.5);
  for (unsigned n = 0; n < 2; ++n) EXPECT_EQ(bench.pins(n), bench.counter(n));
}

TEST(Hm2Motion, TheLongestStepTimesMoveToo) {
  Bench bench;
  bench.write(map_at::kStepLength, {0x3FFF});
  bench.write(map_at::kStepSpace, {0x3FFF});
  bench.set_rate(0, rate_of(100));
  bench.run(1.0);
  bench.set_rate(0, 0);
  bench.run(0.1);
  EXPECT_NEAR(static_cast<double>(bench.pins(0)), 100, 2);
  EXPECT_EQ(bench.pins(0), bench.counter(0));
}

// New step times wait until the axis is at rest, so that no pulse is cut.
TEST(Hm2Motion, StepTimesThatComeInMotionCountFromTheNextRestOn) {
  Bench bench;
  bench.set_rate(0, rate_of(10'000));
  bench.run(0.01);
  bench.write(map_at::kStepLength, {77});
  bench.run(0.01);
  EXPECT_NE(bench.engine->read(card_map::reg::step_length(0)), 77U);
  bench.set_rate(0, 0);
  bench.run(0.01);
  bench.set_rate(0, rate_of(10'000));
  bench.run(0.01);
  EXPECT_EQ(bench.engine->read(card_map::reg::step_length(0)), 77U);
}

// A fraction of a pulse is kept at rest: the commanded fractions add up over many moves.
TEST(Hm2Motion, FractionsOfPulsesOutliveRests) {
  Bench bench;
  double told = 0;
  for (int turn = 0; turn < 30; ++turn) {
    const std::uint64_t before = bench.hostmot2.steps().counts().lines;
    bench.set_rate(0, rate_of(133));
    bench.run(0.001);
    const std::uint64_t lines = bench.hostmot2.steps().counts().lines - before;
    told += static_cast<double>(lines * bench.hostmot2.steps().slice()) * static_cast<double>(rate_of(133)) * 0x1p-32;
    bench.set_rate(0, 0);
    bench.run(0.003);
    ASSERT_FALSE(bench.hostmot2.moves());
    ASSERT_NEAR(bench.place(0), told, 0.001);
  }
  EXPECT_GT(bench.pins(0), 2);
}

}  // namespace
}  // namespace trammel::hm2
