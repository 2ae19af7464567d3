#include "trammel/model/time_base.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "trammel/skip/time_base.hpp"

namespace trammel::model {
namespace {

constexpr std::uint32_t kWhole = 0x10000;

TimeBase::Inputs inputs(bool hold, std::uint8_t slew_shift = 0) {
  return {hold, {}, card_map::constant::kClassFeed, slew_shift};
}

std::uint64_t run(TimeBase& base, std::uint64_t clocks, bool hold = false, std::uint8_t slew_shift = 0) {
  std::uint64_t enables = 0;
  for (std::uint64_t i = 0; i < clocks; ++i) {
    base.clock(inputs(hold, slew_shift));
    enables += base.outputs().enable;
  }
  return enables;
}

// Takes two clocks, one for each setting.
void set(TimeBase& base, std::uint32_t target, std::uint32_t slew) {
  base.clock({false, {true, card_map::reg::kSlew, slew}});
  base.clock({false, {true, card_map::reg::kRatioFeed, target}});
}

bool arrived(const TimeBase& base, bool hold, std::uint8_t piece_class = card_map::constant::kClassFeed) {
  return skip::TimeBaseAhead(base).clocks_ahead({hold, {}, piece_class}) == skip::kForever;
}

// A time base with this ratio, after an odd number of clocks.
TimeBase at_ratio(std::uint32_t ratio) {
  TimeBase base;
  set(base, ratio, 0xFFF'FFFF);
  run(base, 17);
  EXPECT_TRUE(arrived(base, false));
  EXPECT_EQ(base.outputs().ratio, ratio);
  return base;
}

TEST(TimeBase, EveryClockIsEnabledFromReset) {
  TimeBase base;
  EXPECT_FALSE(base.outputs().enable);
  EXPECT_EQ(base.outputs().ratio, kWhole);
  EXPECT_EQ(run(base, 1000), 1000U);
}

TEST(TimeBase, EnablesAreTheFlooredProductInEveryClock) {
  for (const std::uint32_t ratio : {0U, 1U, 3U, 0x5EB8U, 0x8000U, 0xFFFFU, kWhole}) {
    TimeBase base = at_ratio(ratio);
    // A whole cycle of the phase from 0 on; at phase 0 only the full ratio gives an enable.
    const std::uint64_t first = skip::TimeBaseAhead(base).enabled_in(1);
    const std::uint64_t in_a_turn = run(base, 0x10000);
    EXPECT_EQ(in_a_turn, ratio) << "first " << first;
    TimeBase counted = base;
    std::uint64_t enables = 0;
    for (std::uint64_t n = 1; n <= 3000; ++n) {
      enables += run(counted, 1);
      ASSERT_EQ(enables, skip::TimeBaseAhead(base).enabled_in(n)) << "ratio " << ratio << " clock " << n;
    }
  }
}

TEST(TimeBase, GapsBetweenEnablesDifferByOneClock) {
  for (const std::uint32_t ratio : {777U, 0x5EB8U, 0x9999U, 0xFFFEU}) {
    TimeBase base = at_ratio(ratio);
    while (run(base, 1) == 0) {
    }
    for (int i = 0; i < 2000; ++i) {
      std::uint64_t gap = 1;
      while (run(base, 1) == 0) ++gap;
      ASSERT_GE(gap, kWhole / ratio);
      ASSERT_LE(gap, kWhole / ratio + 1);
    }
  }
}

TEST(TimeBase, SlewIsLinearAndEndsOnTheTarget) {
  constexpr std::uint32_t kSlew = 0x1357;
  TimeBase base = at_ratio(0x1000);
  // The goal is sampled every 4th clock, and its first move is visible 4 clocks later.
  set(base, 0xC000, kSlew);
  std::uint64_t waited = 0;
  TimeBase probe = base;
  while (probe.outputs().ratio == 0x1000) {
    run(probe, 1);
    ++waited;
  }
  EXPECT_LE(waited, 8U);
  run(base, waited);
  const std::uint64_t start = std::uint64_t{0x1000} << 12;
  const std::uint64_t goal = std::uint64_t{0xC000} << 12;
  for (std::uint64_t clocks = 0; clocks < 4 * (goal - start) / kSlew + 400; ++clocks) {
    const std::uint64_t updates = clocks / 4 + 1;
    const std::uint64_t expected = std::min(goal, start + updates * kSlew);
    ASSERT_EQ(base.outputs().ratio, expected >> 12) << "clock " << clocks;
    run(base, 1);
  }
  EXPECT_TRUE(arrived(base, false));
}

TEST(TimeBase, HoldGoesToZeroAndComesBack) {
  TimeBase base = at_ratio(0xABCD);
  set(base, 0xABCD, 0x4'0000);
  std::uint32_t before = base.outputs().ratio;
  while (!arrived(base, true)) {
    run(base, 1, true);
    ASSERT_LE(base.outputs().ratio, before);
    before = base.outputs().ratio;
  }
  EXPECT_EQ(before, 0U);
  EXPECT_EQ(run(base, 100'000, true), 0U);
  EXPECT_EQ(skip::TimeBaseAhead(base).clocks_for(1), skip::kForever);
  while (!arrived(base, false)) {
    run(base, 1);
    ASSERT_GE(base.outputs().ratio, before);
    ASSERT_LE(base.outputs().ratio, 0xABCDU);
    before = base.outputs().ratio;
  }
  EXPECT_EQ(before, 0xABCDU);
}

// A hold from 1 to 0 at a constant slew takes half as many enables as clocks, at any slew.
TEST(TimeBase, AHoldTakesTheTriangleOfItsSlew) {
  for (const std::uint32_t slew : {0x1000U, 0x7777U, 0x10'0001U}) {
    TimeBase base;
    set(base, kWhole, slew);
    std::uint64_t enables = 0;
    while (!arrived(base, true)) enables += run(base, 1, true);
    // Sum over updates of 4 clocks at 1 - i * slew; up to 8 clocks at full ratio pass before the first move.
    const double updates = 268435456.0 / slew;
    EXPECT_NEAR(static_cast<double>(enables), 2 * updates, 12) << "slew " << slew;
  }
}

TEST(TimeBase, AZeroSlewKeepsTheRatio) {
  TimeBase base = at_ratio(0x1234);
  set(base, kWhole, 0);
  run(base, 1000);
  EXPECT_EQ(base.outputs().ratio, 0x1234U);
  EXPECT_EQ(skip::TimeBaseAhead(base).clocks_ahead(inputs(false)), skip::kForever);
}

// Each shift doubles the move per update, from the update after the next on. A doubling that would exceed 28 bits is
// left out.
TEST(TimeBase, AShiftDoublesTheSlew) {
  for (std::uint8_t shift = 0; shift < 4; ++shift) {
    for (const std::uint32_t slew : {1U, 0x777U, 0x12345U, 0x1FF'FFFFU, 0x300'0001U, 0x600'0001U, 0xFFF'FFFFU}) {
      std::uint64_t step = slew;
      for (unsigned i = 0; i < shift && 2 * step < 1U << 28; ++i) step *= 2;
      TimeBase base;
      set(base, kWhole, slew);
      run(base, 38, false, shift);  // with the two clocks of set(): 40 clocks
      run(base, 5, true, shift);
      for (std::uint64_t updates = 1; updates < 300; ++updates) {
        const std::uint64_t gone = std::min<std::uint64_t>(updates * step, 1U << 28);
        ASSERT_EQ(base.outputs().ratio, ((1U << 28) - gone) >> 12) << slew << " by " << shift;
        run(base, 4, true, shift);
      }
    }
  }
}

// A piece with another shift: the update in progress uses the shift of the previous piece, the next one its own.
TEST(TimeBase, AShiftCountsFromTheSecondUpdate) {
  constexpr std::uint32_t kSlew = 0x10000;
  TimeBase base;
  set(base, kWhole, kSlew);
  run(base, 38);
  run(base, 5, true);
  ASSERT_EQ(base.outputs().ratio, kWhole - 0x10);
  run(base, 4, true, 2);
  EXPECT_EQ(base.outputs().ratio, kWhole - 0x20);
  run(base, 4, true, 2);
  EXPECT_EQ(base.outputs().ratio, kWhole - 0x60);
  run(base, 4, true);
  EXPECT_EQ(base.outputs().ratio, kWhole - 0xA0);
  run(base, 4, true);
  EXPECT_EQ(base.outputs().ratio, kWhole - 0xB0);
}

// Between classes the ratio changes as after an override: linearly, and exactly to the ratio of the new class.
TEST(TimeBase, AChangeOfClassSlewsToItsRatio) {
  constexpr std::uint32_t kSlew = 0x2468;
  constexpr std::uint32_t kRatios[] = {0x3000, 0xC000, 0x8001};
  constexpr std::uint32_t kAddresses[] = {card_map::reg::kRatioFeed, card_map::reg::kRatioRapid,
                                          card_map::reg::kRatioFixed};
  const auto in_class = [](TimeBase& base, std::uint8_t piece_class, std::uint64_t clocks) {
    for (; clocks != 0; --clocks) base.clock({false, {}, piece_class});
  };
  for (std::uint8_t from = 0; from < 3; ++from) {
    for (std::uint8_t to = 0; to < 3; ++to) {
      TimeBase base;
      for (std::size_t i = 0; i < 3; ++i) base.clock({false, {true, kAddresses[i], kRatios[i]}, from});
      in_class(base, from, 40);
      ASSERT_EQ(base.outputs().ratio, kRatios[from]);
      base.clock({false, {true, card_map::reg::kSlew, kSlew}, from});
      in_class(base, from, 7);  // 52 clocks so far: the goal is sampled in the next one
      const std::int64_t start = std::int64_t{kRatios[from]} << 12;
      const std::int64_t goal = std::int64_t{kRatios[to]} << 12;
      in_class(base, to, 4);
      for (std::int64_t moves = 0; moves < 30'000; ++moves) {
        const std::int64_t gone = std::min(moves * kSlew, std::abs(goal - start));
        const std::int64_t expected = goal > start ? start + gone : start - gone;
        ASSERT_EQ(base.outputs().ratio, expected >> 12) << from << " to " << to << ", move " << moves;
        in_class(base, to, 4);
      }
      EXPECT_TRUE(arrived(base, false, to));
      EXPECT_EQ(base.outputs().ratio, kRatios[to]);
    }
  }
}

// Anywhere on a ramp, at all slews: within clocks_ahead() the enables, their clocks and the final state are those of
// clock().
TEST(TimeBase, ARampAheadAgreesWithClocks) {
  std::mt19937_64 random(11);
  std::uint64_t ahead = 0;
  for (int i = 0; i < 3000; ++i) {
    TimeBase clocked = at_ratio(static_cast<std::uint32_t>(random() % (kWhole + 1)));
    const auto slew = static_cast<std::uint32_t>((1 + (random() & 0xFFF'FFFE)) >> random() % 28);
    set(clocked, static_cast<std::uint32_t>(random() % 3 == 0 ? 0 : random() % (kWhole + 1)), slew);
    run(clocked, random() % 5000);
    const bool hold = random() % 2 == 0;
    const auto shift = static_cast<std::uint8_t>(random() % 4);
    run(clocked, random() % 20, hold, shift);
    const std::uint64_t known =
        std::min<std::uint64_t>(skip::TimeBaseAhead(clocked).clocks_ahead(inputs(hold, shift)), 20'000);
    const std::uint64_t clocks = known == 0 ? 0 : 1 + random() % known;
    ahead += clocks;
    const TimeBase before = clocked;
    TimeBase skipped = clocked;
    const std::uint64_t enables = skip::TimeBaseAhead(skipped).enabled_in(clocks);
    skip::advance(skipped, {}, clocks);
    ASSERT_EQ(enables, skip::TimeBaseAhead(before).enabled_in(clocks));
    std::uint64_t seen = 0;
    for (std::uint64_t n = 1; n <= clocks; ++n) {
      if (run(clocked, 1, hold, shift) == 0) continue;
      ++seen;
      if (seen != enables && seen % 37 != 1) continue;
      ASSERT_EQ(skip::TimeBaseAhead(before).clocks_for(seen), n) << "slew " << slew << " try " << i;
    }
    ASSERT_EQ(seen, enables) << "slew " << slew << " try " << i;
    for (int k = 0; k < 40; ++k) {
      ASSERT_EQ(skipped.outputs().enable, clocked.outputs().enable) << "slew " << slew << " try " << i << ", " << k;
      ASSERT_EQ(skipped.outputs().ratio, clocked.outputs().ratio) << "slew " << slew << " try " << i << ", " << k;
      run(skipped, 1, hold, shift);
      run(clocked, 1, hold, shift);
    }
  }
  EXPECT_GT(ahead, 1'000'000U);
}

// Within clocks_ahead() the ratio as the under-run guard sees it does not change, and does not become 0.
TEST(TimeBase, ARampAheadStaysInItsPart) {
  for (const std::uint32_t slew : {1U, 37U, 0x1000U, 0x2'0001U}) {
    TimeBase base;
    set(base, kWhole, slew);
    std::uint64_t parts = 0;
    for (int i = 0; i < 4000; ++i) {
      const std::uint64_t known = skip::TimeBaseAhead(base).clocks_ahead(inputs(true));
      if (known == skip::kForever) break;
      const std::uint32_t part = (base.outputs().ratio + 255) / 256;
      skip::advance(base, {}, known);
      ASSERT_EQ((base.outputs().ratio + 255) / 256, part);
      run(base, 1, true);
      if ((base.outputs().ratio + 255) / 256 != part) ++parts;
    }
    EXPECT_EQ(parts, 256U) << "slew " << slew;
    EXPECT_EQ(base.outputs().ratio, 0U);
  }
}

TEST(TimeBase, AdvanceAndItsInverseAgreeWithClocks) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 2000; ++i) {
    const auto ratio = static_cast<std::uint32_t>(random() % 5 == 0 ? kWhole : random() % (kWhole + 1));
    TimeBase clocked = at_ratio(ratio);
    run(clocked, random() % 100);
    TimeBase skipped = clocked;
    const std::uint64_t clocks = random() % 500;
    EXPECT_EQ(skip::TimeBaseAhead(skipped).enabled_in(clocks), run(clocked, clocks));
    skip::advance(skipped, {}, clocks);
    ASSERT_EQ(skipped.outputs().enable, clocked.outputs().enable);
    const std::uint64_t enables = 1 + random() % 50;
    const std::uint64_t needed = skip::TimeBaseAhead(clocked).clocks_for(enables);
    if (ratio > 300) {
      TimeBase probe = clocked;
      EXPECT_EQ(run(probe, needed - 1), enables - 1);
      EXPECT_EQ(run(probe, 1), 1U);
    }
    // A later change must find both at the same clock of the update.
    set(clocked, 0x3000, 0x12'3456);
    set(skipped, 0x3000, 0x12'3456);
    for (int k = 0; k < 24; ++k) {
      clocked.clock(inputs(k > 11));
      skipped.clock(inputs(k > 11));
      ASSERT_EQ(skipped.outputs().enable, clocked.outputs().enable);
      ASSERT_EQ(skipped.outputs().ratio, clocked.outputs().ratio);
    }
  }
}

}  // namespace
}  // namespace trammel::model
