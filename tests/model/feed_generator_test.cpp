#include "trammel/model/feed_generator.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "feed_pieces.hpp"
#include "trammel/skip/feed_generator.hpp"

namespace trammel::model {
namespace {

TEST(FeedGenerator, ConstantRateGivesTheFlooredProduct) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    FeedGenerator feed;
    const Piece p{random.word() >> (random.word() % 40), 0, 0, 0};
    load_and_swap(feed, p);
    std::uint64_t clocks = 0;
    std::uint64_t ticks = 0;
    for (int part = 0; part < 4; ++part) {
      const std::uint64_t more = random.word() % 700;
      clocks += more;
      ticks += ticks_in(feed, more);
      const uint128 sum = static_cast<uint128>(p.rate >> 16) * clocks;
      ASSERT_EQ(ticks, static_cast<std::uint64_t>(sum >> 48));
      ASSERT_EQ(feed.state().phase, static_cast<std::uint64_t>(sum) & 0xFFFF'FFFF'FFFF);
    }
  }
}

TEST(FeedGenerator, EverySlopeIsTheClosedForm) {
  Random random(2);
  for (int i = 0; i < 400; ++i) {
    FeedGenerator feed;
    const Piece p = random.piece();
    load_and_swap(feed, p);
    for (std::int64_t k = 0; k < 100; ++k) {
      for (std::uint32_t c = 0; c < FeedGenerator::kUpdateClocks; ++c) {
        ASSERT_EQ(feed.state().slope, ideal_slope(p, k)) << "update " << k << " clock " << c;
        enabled_clock(feed);
      }
    }
  }
}

TEST(FeedGenerator, TickAndRateShowThreeClocksLater) {
  FeedGenerator feed;
  swap(feed, {~std::uint64_t{0}});
  EXPECT_EQ(feed.outputs().rate, 0U);
  feed.clock({});
  EXPECT_EQ(feed.outputs().rate, 0U);
  feed.clock({});
  EXPECT_EQ(feed.outputs().rate, 0xFFFF'FFFFU);
  enabled_clock(feed);  // phase 0: no carry yet
  EXPECT_FALSE(enabled_clock(feed));
  feed.clock({});
  EXPECT_FALSE(feed.outputs().tick);
  feed.clock({});
  EXPECT_TRUE(feed.outputs().tick);
  feed.clock({});
  EXPECT_FALSE(feed.outputs().tick);
  EXPECT_TRUE(skip::at_rest(feed));
}

TEST(FeedGenerator, ClearDropsPhaseAndTicksInFlight) {
  for (int before = 0; before < 3; ++before) {
    FeedGenerator feed;
    load_and_swap(feed, {~std::uint64_t{0}});
    enabled_clock(feed);
    enabled_clock(feed);
    for (int i = 0; i < before; ++i) feed.clock({});
    FeedGenerator::Inputs in;
    in.clear = true;
    feed.clock(in);
    EXPECT_TRUE(skip::at_rest(feed)) << before;
    EXPECT_EQ(feed.state().phase, 0U);
    EXPECT_EQ(drain(feed), 0U);
  }
}

// The piece's own acceleration and jerk may arrive up to the 31st enabled clock; those of the last piece never apply.
TEST(FeedGenerator, AccelerationAndJerkComeAfterTheSwap) {
  Random random(9);
  for (int i = 0; i < 200; ++i) {
    FeedGenerator feed;
    load_and_swap(feed, random.piece());
    ticks_in(feed, random.word() % 500);
    const Piece p = random.piece();
    swap(feed, p);
    const std::uint64_t first = random.word() % 24;
    ticks_in(feed, first);
    const auto load = [&feed](unsigned target, std::int64_t value) {
      for (int k = 0; k < 4; ++k) {
        FeedGenerator::Inputs in;
        in.enable = true;
        in.load = {true, static_cast<std::uint16_t>(target),
                   static_cast<std::uint16_t>(static_cast<std::uint64_t>(value) >> (16 * k))};
        feed.clock(in);
      }
    };
    load(feed_target::kAcceleration, p.acceleration);
    load(feed_target::kJerk, p.jerk);
    for (std::uint64_t c = first + 8; c < 2000; ++c) {
      ASSERT_EQ(feed.state().slope, ideal_slope(p, static_cast<std::int64_t>(c / FeedGenerator::kUpdateClocks))) << c;
      enabled_clock(feed);
    }
  }
}

TEST(FeedGenerator, PhaseIsKeptOverSwaps) {
  Random random(3);
  FeedGenerator feed;
  uint128 sum = 0;
  std::uint64_t ticks = 0;
  for (int i = 0; i < 500; ++i) {
    const Piece p = random.piece();
    load_and_swap(feed, p);
    const std::uint64_t clocks = random.word() % 200;
    for (std::uint64_t c = 0; c < clocks; ++c) {
      sum += ideal_slope(p, static_cast<std::int64_t>(c / FeedGenerator::kUpdateClocks));
    }
    ticks += ticks_in(feed, clocks);
    ASSERT_EQ(ticks, static_cast<std::uint64_t>(sum >> 48));
    ASSERT_EQ(feed.state().phase, static_cast<std::uint64_t>(sum) & 0xFFFF'FFFF'FFFF);
  }
}

TEST(FeedGenerator, ClampsAtTheFloorAndAtOne) {
  FeedGenerator feed;
  load_and_swap(feed, {std::uint64_t{1} << 62, -(std::int64_t{1} << 60), 0, 0x1000});
  ticks_in(feed, 32 * 5);
  EXPECT_EQ(feed.state().slope, std::uint64_t{0x1000} << 16);
  ticks_in(feed, 32 * 3);
  EXPECT_EQ(feed.state().slope, std::uint64_t{0x1000} << 16);
  load_and_swap(feed, {std::uint64_t{1} << 62, std::int64_t{1} << 60, 0, 0x1000});
  ticks_in(feed, 32 * 12);
  EXPECT_EQ(feed.state().slope, (std::uint64_t{1} << 48) - 1);
  EXPECT_GE(ticks_in(feed, 320), 319U);
}

// A piece that starts below its floor runs for one update at the given rate, then at the floor.
TEST(FeedGenerator, TheFirstSlopeIsNotClamped) {
  FeedGenerator feed;
  load_and_swap(feed, {std::uint64_t{7} << 32, 0, 0, 0x8000'0000});
  EXPECT_EQ(feed.state().slope, std::uint64_t{7} << 16);
  EXPECT_EQ(skip::FeedAhead(feed).advance(31, 9).enables, 31U);
  EXPECT_EQ(feed.state().slope, std::uint64_t{7} << 16);
  EXPECT_EQ(skip::FeedAhead(feed).advance(1, 9).enables, 1U);
  EXPECT_EQ(feed.state().slope, std::uint64_t{0x8000'0000} << 16);
}

// advance() against clock(), clock by clock: the same carries up to the wanted one, and then the same state.
TEST(FeedGenerator, AdvanceIsExact) {
  Random random(4);
  for (int i = 0; i < 4000; ++i) {
    FeedGenerator clocked;
    Piece p = random.piece();
    if (random.word() % 3 == 0) p.rate |= std::uint64_t{0xFFF} << 52;  // close to 1, where the rate is clamped
    load_and_swap(clocked, p);
    ticks_in(clocked, random.word() % 150);
    FeedGenerator jumping = clocked;
    for (int part = 0; part < 6; ++part) {
      const std::uint64_t limit = random.word() % 4 == 0 ? random.word() % 40 : random.word() % 6000;
      const std::uint64_t carries = random.word() % 3 == 0 ? ~std::uint64_t{0} : 1 + random.word() % 300;
      const skip::FeedAhead::Advanced gone = skip::FeedAhead(jumping).advance(limit, carries);
      ASSERT_LE(gone.enables, limit);
      ASSERT_LE(gone.carries, carries);
      ASSERT_TRUE(gone.enables == limit || gone.carries == carries);
      std::uint64_t made = 0;
      for (std::uint64_t c = 0; c < gone.enables; ++c) {
        enabled_clock(clocked);
        made += skip::carried(clocked, 0) ? 1U : 0U;
      }
      ASSERT_EQ(made, gone.carries) << "piece " << i << " part " << part;
      ASSERT_TRUE(gone.carries != carries || skip::carried(clocked, 0)) << "the last one carries";
      ASSERT_EQ(jumping.state().phase, clocked.state().phase);
      ASSERT_EQ(jumping.state().slope, clocked.state().slope);
      drain(jumping);
      drain(clocked);
      // Compares the outputs and, through the clocks of the next updates, the hidden state.
      for (std::uint64_t c = random.word() % 70; c > 0; --c) {
        ASSERT_EQ(enabled_clock(jumping), enabled_clock(clocked));
        ASSERT_EQ(jumping.outputs().rate, clocked.outputs().rate);
      }
      drain(jumping);
      drain(clocked);
    }
  }
}

}  // namespace
}  // namespace trammel::model
