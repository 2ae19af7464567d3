// The model of the sequencers against the documented clocks: how fast lines follow each other, how long a dwell lasts,
// and that each tick taken counts for both the path and the piece.
#include "trammel/model/sequencer.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "trammel/model/halfword_queue.hpp"

namespace trammel::model {
namespace {

using card_map::Opcode;
using Halfwords = std::vector<std::uint16_t>;

Halfwords command(Opcode opcode, unsigned mask, std::uint64_t count, std::size_t payload) {
  Halfwords to{static_cast<std::uint16_t>(static_cast<unsigned>(opcode) | mask << 8), static_cast<std::uint16_t>(count),
               static_cast<std::uint16_t>(count >> 16), static_cast<std::uint16_t>(count >> 32)};
  to.resize(to.size() + payload, 0);
  return to;
}

Halfwords line_words(unsigned axes, std::uint64_t ticks) {
  return command(Opcode::Line, (1U << axes) - 1, ticks, 3 * std::size_t{axes});
}
Halfwords piece(std::uint64_t ticks, std::uint8_t piece_class = card_map::constant::kClassFeed) {
  const card_map::Command& layout = *card_map::find_command(static_cast<std::uint8_t>(Opcode::Feed));
  return command(Opcode::Feed, piece_class, ticks, card_map::queue_halfwords(layout, 0) - 4);
}
Halfwords dwell(std::uint64_t clocks) { return command(Opcode::Dwell, 0, clocks, 0); }

// A feed tick comes three clocks after each enable; the engines and axes are always ready.
class Bench {
 public:
  Bench() : geometry_(4096), feed_(4096) {}

  void queue(const std::vector<Halfwords>& geometry, const std::vector<Halfwords>& feed) {
    fill(geometry_, geometry);
    fill(feed_, feed);
  }

  void run(std::uint64_t clocks) {
    for (; clocks != 0; --clocks, ++now) {
      Sequencer::Inputs in;
      in.geometry_empty = geometry_.outputs().empty;
      in.geometry_word = geometry_.outputs().word;
      in.feed_empty = feed_.outputs().empty;
      in.feed_word = feed_.outputs().word;
      in.enable = true;
      in.engine_done = true;
      in.feed_tick = (coming_ & 1) != 0;
      coming_ = sequencer.outputs().feed_clear ? 0 : coming_ >> 1 | (sequencer.outputs().feed_enable ? 4U : 0U);
      HalfwordQueue::Inputs geometry;
      HalfwordQueue::Inputs feed;
      geometry.read = sequencer.geometry_read();
      feed.read = sequencer.feed_read();
      const std::uint32_t begun = sequencer.outputs().geometry_begun;
      sequencer.clock(in);
      geometry_.clock(geometry);
      feed_.clock(feed);
      const Sequencer::Outputs& out = sequencer.outputs();
      if (out.swap) swaps.push_back(now);
      if (out.feed_swap) pieces.push_back(now);
      if (out.geometry_begun != begun) begins.push_back(now);
      ticks += out.tick ? 1U : 0U;
      mismatches += out.mismatch ? 1U : 0U;
    }
  }

  Sequencer sequencer;
  std::uint64_t now = 0;
  std::uint64_t ticks = 0;
  unsigned mismatches = 0;
  std::vector<std::uint64_t> swaps;
  std::vector<std::uint64_t> pieces;
  std::vector<std::uint64_t> begins;

 private:
  static void fill(HalfwordQueue& queue, const std::vector<Halfwords>& commands) {
    HalfwordQueue::Inputs in;
    in.write = true;
    for (const Halfwords& halfwords : commands) {
      for (const std::uint16_t word : halfwords) {
        in.word = word;
        queue.clock(in);
      }
    }
    in = {};
    in.commit = true;
    queue.clock(in);
    queue.clock({});
  }

  HalfwordQueue geometry_;
  HalfwordQueue feed_;
  unsigned coming_ = 0;
};

TEST(Sequencer, ShortLinesFollowAsFastAsTheyAreDecoded) {
  for (unsigned axes = 1; axes <= 8; ++axes) {
    Bench bench;
    // The first line waits for its piece; meanwhile the second line is decoded.
    bench.queue(std::vector<Halfwords>(6, line_words(axes, 1)), {piece(6)});
    bench.run(500);
    ASSERT_EQ(bench.swaps.size(), 6U);
    for (std::size_t i = 3; i < 6; ++i) EXPECT_EQ(bench.swaps[i] - bench.swaps[i - 1], 8 + 3 * axes);
    EXPECT_EQ(bench.ticks, 6U);
  }
}

TEST(Sequencer, LongLinesFollowInTheClockOfTheLastTick) {
  Bench bench;
  bench.queue({line_words(3, 100), line_words(3, 50), dwell(0)}, {piece(150), dwell(0)});
  bench.run(600);
  ASSERT_EQ(bench.swaps.size(), 2U);
  EXPECT_EQ(bench.ticks, 150U);
  // Ticks begin some clocks after the piece, then one comes in each clock.
  EXPECT_GE(bench.swaps[1] - bench.pieces[0], 100U);
  EXPECT_LT(bench.swaps[1] - bench.pieces[0], 110U);
}

TEST(Sequencer, ADwellCountsAtLeastOneClock) {
  const auto distance = [](std::uint64_t clocks) {
    Bench bench;
    bench.queue({dwell(clocks), dwell(0)}, {dwell(clocks), dwell(0)});
    bench.run(clocks + 200);
    EXPECT_EQ(bench.begins.size(), 2U);
    EXPECT_EQ(bench.sequencer.outputs().feed_begun, 2U);
    return bench.begins.back() - bench.begins.front();
  };
  const std::uint64_t none = distance(0);
  for (const std::uint64_t clocks : {1U, 2U, 3U, 16U, 17U, 1000U, 70'000U}) {
    EXPECT_EQ(distance(clocks) - none, clocks - 1) << clocks;
  }
}

TEST(Sequencer, PathsAndPiecesThatDisagreeAreAMismatchAtTheBarrier) {
  for (const bool more_feed : {false, true}) {
    Bench bench;
    bench.queue({line_words(1, more_feed ? 10 : 11), dwell(0)}, {piece(more_feed ? 11 : 10), dwell(0)});
    bench.run(300);
    EXPECT_GT(bench.mismatches, 0U);
    EXPECT_EQ(bench.ticks, 10U);
  }
}

TEST(Sequencer, BegunCountsBothQueues) {
  Bench bench;
  bench.queue({line_words(1, 4), line_words(2, 6), dwell(3)}, {piece(5), piece(3), piece(2), dwell(3)});
  bench.run(500);
  EXPECT_EQ(bench.sequencer.outputs().geometry_begun, 3U);
  EXPECT_EQ(bench.sequencer.outputs().feed_begun, 4U);
  EXPECT_EQ(bench.pieces.size(), 3U);
  EXPECT_EQ(bench.mismatches, 0U);
}

// The class changes with the swap that starts a piece, and stays between pieces and at barriers.
TEST(Sequencer, TheClassIsThatOfThePieceInForce) {
  constexpr std::uint8_t kFeed = card_map::constant::kClassFeed;
  constexpr std::uint8_t kRapid = card_map::constant::kClassRapid;
  constexpr std::uint8_t kFixed = card_map::constant::kClassFixed;
  Bench bench;
  bench.queue({line_words(1, 120), dwell(200), line_words(1, 120)},
              {piece(40, kRapid), piece(40, kFixed), piece(40, kFixed), dwell(200), piece(80), piece(40, kRapid)});
  const std::vector<std::uint8_t> classes{kRapid, kFixed, kFixed, kFeed, kRapid};
  for (int clock = 0; clock < 900; ++clock) {
    bench.run(1);
    const Sequencer::Outputs& out = bench.sequencer.outputs();
    const std::uint8_t expected = bench.pieces.empty() ? kFeed : classes[bench.pieces.size() - 1];
    ASSERT_EQ(out.piece_class, expected) << clock;
    // `moving` is true from the first tick of a piece to the last tick of the last consecutive piece.
    const bool moved = bench.ticks != 0 && bench.ticks != 120 && bench.ticks != 240;
    ASSERT_EQ(out.moving, moved) << clock << ", " << bench.ticks << " ticks";
  }
  EXPECT_EQ(bench.pieces.size(), 5U);
  EXPECT_EQ(bench.ticks, 240U);
}

TEST(Sequencer, ACutAndADirectMoveAreFeed) {
  constexpr std::uint8_t kRapid = card_map::constant::kClassRapid;
  for (const bool cut : {false, true}) {
    Bench bench;
    bench.queue({line_words(1, 100)}, {piece(100, kRapid)});
    bench.run(cut ? 60 : 300);
    EXPECT_EQ(bench.sequencer.outputs().piece_class, kRapid);
    EXPECT_EQ(bench.sequencer.outputs().moving, cut);
    Sequencer::Inputs in;
    in.cut = cut;
    in.direct_go = !cut;
    bench.sequencer.clock(in);
    in = {};
    bench.sequencer.clock(in);
    EXPECT_EQ(bench.sequencer.outputs().piece_class, card_map::constant::kClassFeed);
    EXPECT_FALSE(bench.sequencer.outputs().moving);
    EXPECT_EQ(bench.sequencer.outputs().direct, !cut);
  }
}

}  // namespace
}  // namespace trammel::model
