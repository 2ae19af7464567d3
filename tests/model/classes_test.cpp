// Classes of pieces on the golden model of the whole core: which ratio applies when, and which pieces end before a
// HOLD.
#include <gtest/gtest.h>

#include <random>

#include "core_bench.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr std::uint8_t kFeedClass = card_map::constant::kClassFeed;
constexpr std::uint8_t kRapidClass = card_map::constant::kClassRapid;
constexpr std::uint8_t kFixedClass = card_map::constant::kClassFixed;
constexpr std::uint32_t kWhole = 0x10000;
constexpr std::uint64_t kEvery16 = std::uint64_t{1} << 60;  // rate: a tick in 16 enabled clocks
constexpr std::uint64_t kTicks = 500;

// A core with one piece per class in `classes`; each piece carries one line of 500 ticks and 50 steps.
struct Bench : CoreBench {
  explicit Bench(const std::vector<std::uint8_t>& classes) {
    idle(300);
    write(reg::kHold, 1);
    idle(20);
    for (const std::uint8_t piece_class : classes) {
      feed(kTicks, kEvery16, 0, 0, 1, piece_class);
      line(kTicks, {kOnePulse / 10});
    }
  }
  void ratios(std::uint32_t feed_ratio, std::uint32_t rapid, std::uint32_t fixed) {
    write(reg::kRatioFeed, feed_ratio);
    write(reg::kRatioRapid, rapid);
    write(reg::kRatioFixed, fixed);
  }
  // Runs until `paths` paths have begun and the last of them has taken `path_ticks` ticks.
  void until(std::uint32_t paths, std::uint64_t path_ticks) {
    std::uint64_t seen = 0;
    while (core.outputs().geometry_begun < paths) clock({});
    while (seen < path_ticks) {
      clock({});
      seen += core.outputs().tick ? 1U : 0U;
    }
  }
  bool held() const { return (core.outputs().status & field::kStatusHeld) != 0; }
};

// The clocks of a piece depend only on the ratio of its class: 16 * 500 / ratio.
TEST(Classes, EachPieceRunsAtItsOwnRatio) {
  const std::vector<std::uint8_t> classes{kFeedClass, kRapidClass, kFixedClass, kFixedClass, kRapidClass, kFeedClass};
  for (const auto& [feed_ratio, rapid, fixed] :
       {std::tuple{kWhole, kWhole, kWhole}, std::tuple{0x5EB8U, kWhole, kWhole}, std::tuple{kWhole, 0x4000U, 0x8000U},
        std::tuple{0x2000U, 0x4000U, 0x9999U}}) {
    Bench bench(classes);
    bench.ratios(feed_ratio, rapid, fixed);
    bench.write(reg::kHold, 0);
    const std::uint32_t ratio_of[] = {feed_ratio, rapid, fixed};
    std::uint64_t before = 0;
    for (std::uint32_t path = 1; path <= classes.size() + 1; ++path) {
      if (path <= classes.size())
        bench.until(path, 2);
      else
        while ((bench.core.outputs().status & field::kStatusPathActive) != 0) bench.clock({});
      const std::uint64_t now = bench.core.cycles();
      if (path > 1) {
        // From the second tick of one path to that of the next, or to the end of the last one; the ratio changes in
        // between.
        const double ticks = path <= classes.size() ? kTicks : kTicks - 2;
        EXPECT_NEAR(static_cast<double>(now - before), 16.0 * ticks * kWhole / ratio_of[classes[path - 2]], 200)
            << path << " ratio " << ratio_of[classes[path - 2]];
      }
      before = now;
    }
  }
}

// Overrides of other classes in the middle of a piece: the ratio stays constant in every clock, and so does the time.
TEST(Classes, AnOverrideMovesItsOwnClassAlone) {
  for (const std::uint8_t running : {kFeedClass, kRapidClass, kFixedClass}) {
    Bench bench({running});
    bench.ratios(0x8000, 0x8000, 0x8000);
    bench.write(reg::kHold, 0);
    bench.until(1, 100);
    const std::uint64_t begin = bench.core.cycles();
    constexpr std::uint32_t kRatios[] = {reg::kRatioFeed, reg::kRatioRapid, reg::kRatioFixed};
    for (const std::uint32_t ratio : {0U, 0x1234U, kWhole}) {
      for (const std::uint8_t other : {kFeedClass, kRapidClass, kFixedClass}) {
        if (other != running) bench.write(kRatios[other], ratio);
      }
      for (int clock = 0; clock < 500; ++clock) {
        bench.clock({});
        ASSERT_EQ(bench.core.outputs().ratio, 0x8000U) << int{running};
      }
    }
    while ((bench.core.outputs().status & field::kStatusPathActive) != 0) bench.clock({});
    EXPECT_NEAR(static_cast<double>(bench.core.cycles() - begin), 400.0 * 32, 40);
    EXPECT_EQ(bench.steps.path.size(), 50U);
  }
}

// The list of path steps does not depend on ratios, holds or their times.
TEST(Classes, ThePathIsTheSameWhateverTheTimeBaseDoes) {
  const std::vector<std::uint8_t> classes{kFeedClass, kFixedClass, kFixedClass, kRapidClass,
                                          kFeedClass, kFixedClass, kRapidClass};
  const auto run = [&](std::uint64_t seed) {
    std::mt19937_64 random(seed);
    Bench bench(classes);
    bench.write(reg::kHold, 0);
    while ((bench.read(reg::kStatus) & field::kStatusBusy) != 0) {
      if (seed == 0) {
        bench.idle(500);
        continue;
      }
      bench.ratios(static_cast<std::uint32_t>(0x1000 + random() % 0xF001),
                   static_cast<std::uint32_t>(0x1000 + random() % 0xF001),
                   static_cast<std::uint32_t>(0x1000 + random() % 0xF001));
      bench.write(reg::kSlew, static_cast<std::uint32_t>(0x1'0000 + random() % 0x100'0000));
      bench.write(reg::kHold, random() % 4 == 0 ? 1 : 0);
      bench.idle(random() % 3000);
    }
    EXPECT_EQ(bench.steps.path.size(), 50 * classes.size());
    std::vector<std::tuple<std::uint64_t, std::uint64_t, unsigned, int>> path;
    for (const auto& [command, tick, axis, direction, cycle] : bench.steps.path)
      path.emplace_back(command, tick, axis, direction);
    return path;
  };
  const auto path = run(0);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) ASSERT_TRUE(run(seed) == path) << seed;
}

// A HOLD during a fixed piece begins after the last of consecutive fixed pieces; abort does not wait.
TEST(Classes, AHoldLetsFixedPiecesEnd) {
  Bench bench({kFeedClass, kFixedClass, kFixedClass, kFixedClass, kRapidClass});
  bench.write(reg::kHold, 0);
  bench.until(2, 100);
  bench.write(reg::kHold, 1);
  // 1,400 ticks of 16 clocks, all at the full ratio.
  for (std::uint64_t clock = 0; clock < 22'300; ++clock) {
    bench.clock({});
    ASSERT_EQ(bench.core.outputs().ratio, kWhole) << clock;
  }
  bench.idle(400);
  EXPECT_TRUE(bench.held());
  EXPECT_EQ(bench.read(reg::kFeedBegun), 5U);
  EXPECT_EQ(bench.steps.path.size(), 200U);
  bench.idle(50'000);
  EXPECT_EQ(bench.steps.path.size(), 200U) << "the rapid piece waits";
  bench.write(reg::kHold, 0);
  bench.idle(12'000);
  EXPECT_EQ(bench.steps.path.size(), 250U);

  Bench cut({kFixedClass, kFixedClass});
  cut.write(reg::kHold, 0);
  cut.until(1, 100);
  cut.write(reg::kHold, 1);
  cut.idle(1000);
  EXPECT_FALSE(cut.held());
  cut.write(reg::kControl, field::kControlAbort);
  cut.idle(20);
  EXPECT_EQ(cut.core.outputs().status & (field::kStatusPathActive | field::kStatusFeedActive), 0U);
  EXPECT_TRUE(cut.held()) << "nothing moves any more";
}

// HOLD in each clock around the border of a feed and a fixed piece: it takes effect before the fixed piece or after it,
// never within it.
TEST(Classes, AHoldAtTheBorderTakesBeforeOrAfterTheFixedPiece) {
  Bench probe({kFeedClass, kFixedClass, kFeedClass});
  probe.write(reg::kHold, 0);
  const std::uint64_t begin = probe.core.cycles();
  probe.until(2, 1);
  const std::uint64_t border = probe.core.cycles() - begin;
  unsigned before = 0;
  unsigned after = 0;
  for (std::uint64_t wait = border - 40; wait <= border + 20; ++wait) {
    Bench bench({kFeedClass, kFixedClass, kFeedClass});
    bench.write(reg::kHold, 0);
    bench.idle(wait);
    bench.write(reg::kHold, 1);
    bench.idle(12'000);
    ASSERT_TRUE(bench.held()) << wait;
    const std::size_t steps = bench.steps.path.size();
    if (steps <= 51)
      ++before;
    else
      ++after;
    ASSERT_TRUE(steps <= 51 || steps >= 99) << wait - border << ": " << steps;
    bench.idle(50'000);
    ASSERT_EQ(bench.steps.path.size(), steps);
    bench.write(reg::kHold, 0);
    bench.idle(30'000);
    ASSERT_EQ(bench.steps.path.size(), 150U);
  }
  EXPECT_GT(before, 10U);
  EXPECT_GT(after, 10U);
}

// A fixed piece begins during a slow ramp to a hold. It ends at its own ratio, then the hold goes on.
TEST(Classes, AFixedPieceThatBeginsOnTheWayToAHoldIsLetEnd) {
  Bench bench({kFeedClass, kFixedClass, kFeedClass});
  bench.write(reg::kHold, 0);
  bench.idle(40);
  bench.write(reg::kSlew, 0x2'0000);  // 8,192 clocks from 1 to 0
  bench.until(1, 450);
  bench.write(reg::kHold, 1);
  bench.until(2, 5);
  EXPECT_LT(bench.core.outputs().ratio, 0xF800U);
  EXPECT_GT(bench.core.outputs().ratio, 0x1000U);
  bench.until(2, 400);
  EXPECT_EQ(bench.core.outputs().ratio, kWhole);
  bench.idle(40'000);
  EXPECT_TRUE(bench.held());
  const std::size_t steps = bench.steps.path.size();
  EXPECT_GT(steps, 100U);
  EXPECT_LT(steps, 150U);
}

// A fixed piece that is sent while the machine is at rest in a hold does not end the hold.
TEST(Classes, AFixedPieceSentInAHoldDoesNotMove) {
  Bench bench({kFixedClass, kFixedClass});
  bench.idle(50'000);
  EXPECT_TRUE(bench.held());
  EXPECT_TRUE(bench.steps.path.empty());
  // HOLD is set while nothing runs, with a slow ramp. A piece that is sent during the ramp ramps down with it.
  CoreBench late;
  late.idle(300);
  late.write(reg::kSlew, 0x2'0000);
  late.write(reg::kHold, 1);
  late.feed(kTicks, kEvery16, 0, 0, 1, kFixedClass);
  late.line(kTicks, {kOnePulse / 10});
  late.idle(60'000);
  EXPECT_EQ(late.core.outputs().ratio, 0U);
  EXPECT_GT(late.steps.path.size(), 5U);
  EXPECT_LT(late.steps.path.size(), 40U);
}

// A fault with a ramped stop does not wait for the end of a fixed piece.
TEST(Classes, ARampedFaultDoesNotWait) {
  Bench bench({kFixedClass});
  bench.write(reg::kStopReaction, 1);
  bench.write(reg::kSlew, 0x10'0000);
  bench.write(reg::kHoldLimit, 10);
  bench.write(reg::step_space(0), 5000);  // the second step waits too long
  bench.write(reg::kHold, 0);
  bench.idle(20);
  while ((bench.core.outputs().status & field::kStatusStopping) == 0) bench.clock({});
  const std::uint32_t before = bench.core.outputs().ratio;
  bench.idle(400);
  EXPECT_LT(bench.core.outputs().ratio + 90, before);
  while ((bench.core.outputs().status & field::kStatusStopping) != 0) bench.clock({});
  bench.idle(5);
  EXPECT_LT(bench.steps.path.size(), 50U);
  EXPECT_EQ(bench.core.outputs().status & field::kStatusFeedActive, 0U);
}

// Between pieces, at a barrier and after the end, the ratio stays that of the last class. A cut and a direct move
// select the feed ratio.
TEST(Classes, TheLastClassStaysBetweenPieces) {
  CoreBench bench;
  bench.idle(300);
  bench.write(reg::kRatioFeed, 0x3000);
  bench.write(reg::kRatioRapid, 0x7000);
  bench.write(reg::kRatioFixed, 0xB000);
  const auto one = [&bench](std::uint8_t piece_class) {
    bench.feed(100, kEvery16, 0, 0, 1, piece_class);
    bench.line(100, {0});
    bench.idle(16 * 100 * 8);
  };
  bench.idle(30);
  EXPECT_EQ(bench.core.outputs().ratio, 0x3000U);
  one(kRapidClass);
  EXPECT_EQ(bench.core.outputs().ratio, 0x7000U);
  bench.send(command_words(card_map::Opcode::Dwell, 0, bench.number++, 300, {}));
  bench.idle(1000);
  EXPECT_EQ(bench.core.outputs().ratio, 0x7000U);
  one(kFixedClass);
  EXPECT_EQ(bench.core.outputs().ratio, 0xB000U);
  bench.write(reg::kControl, field::kControlAbort);
  bench.number = 0;
  bench.idle(30);
  EXPECT_EQ(bench.core.outputs().ratio, 0x3000U) << "after a cut";
  one(kRapidClass);
  EXPECT_EQ(bench.core.outputs().ratio, 0x7000U);
  bench.write(reg::frequency_hi(0), 1);
  bench.write(reg::count(0), 3);
  bench.write(reg::kLengthLo, 2000);
  EXPECT_TRUE(bench.write(reg::kStart, 1));
  bench.idle(60);
  EXPECT_EQ(bench.core.outputs().ratio, 0x3000U) << "a direct move";
  EXPECT_NE(bench.core.outputs().status & field::kStatusDirect, 0U);
}

// Watermarks over the bus: STATUS, the interrupt, and refused values.
TEST(Watermarks, ShowInStatusAndRaiseTheInterrupt) {
  CoreBench bench;
  bench.idle(300);
  bench.write(reg::kHold, 1);
  bench.write(reg::kIrqEnable, field::kStatusFeedLow);
  bench.idle(20);
  EXPECT_FALSE(bench.core.outputs().irq) << "no watermark, never low";
  EXPECT_FALSE(bench.write(reg::kFeedWatermark, 0x10000)) << "16 bits";
  bench.write(reg::kFeedWatermark, 41);  // two pieces of 20 halfwords are fewer
  bench.write(reg::kGeometryWatermark, 1);
  bench.idle(4);
  EXPECT_TRUE(bench.core.outputs().irq);
  EXPECT_EQ(bench.read(reg::kStatus) & (field::kStatusFeedLow | field::kStatusGeometryLow),
            field::kStatusFeedLow | field::kStatusGeometryLow);
  // One piece has begun, and 12 halfwords of the next one are decoded.
  for (int i = 0; i < 4; ++i) bench.feed(100, kEvery16);
  bench.idle(60);
  EXPECT_FALSE(bench.core.outputs().irq);
  EXPECT_EQ(bench.read(reg::kFeedRoom), 2560U - 48);
  EXPECT_EQ(bench.read(reg::kStatus) & (field::kStatusFeedLow | field::kStatusGeometryLow), field::kStatusGeometryLow);
  for (int i = 0; i < 5; ++i) bench.line(400, {0});
  bench.write(reg::kHold, 0);
  while (!bench.core.outputs().irq) bench.clock({});
  EXPECT_LE(2560 - bench.read(reg::kFeedRoom), 40U);
  bench.write(reg::kControl, field::kControlSnapshot);
  EXPECT_NE(bench.read(reg::status(card_map::Area::Snap)) & field::kStatusFeedLow, 0U);
}

}  // namespace
}  // namespace trammel::testing
