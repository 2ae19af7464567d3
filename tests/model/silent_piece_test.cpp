// Silent pieces on the golden card. If the first ticks of a path are silent, its later steps are exactly those of the
// whole path, on every engine.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core_bench.hpp"
#include "feed_paths.hpp"

namespace trammel::testing::silent_pieces {
namespace {

namespace reg = card_map::reg;

constexpr std::uint8_t kSilent = card_map::constant::kPieceSilent;
constexpr std::uint64_t kEveryClock = ~std::uint64_t{0};  // rate

struct Bench : CoreBench {
  Bench() : CoreBench(all_engines()) {
    for (unsigned n = 0; n < 4; ++n) write(reg::step_length(n), 1);
  }
  // Sends the pieces, then the path: its first `silent` ticks make no steps.
  void send(const Path& path, std::uint64_t silent) {
    if (silent != 0) {
      ASSERT_TRUE(feed(silent, kEveryClock, 0, 0, 1, kSilent));
    }
    ASSERT_TRUE(feed(path.ticks - silent, kEvery16));
    ASSERT_TRUE(path.send(*this));
    ASSERT_TRUE(end());
  }
  void finish_all(const Path& path) {
    ASSERT_TRUE(finish(100 * path.ticks + 200'000));
    ASSERT_EQ(core.outputs().fault, 0U);
  }
  void run(const Path& path, std::uint64_t silent) {
    send(path, silent);
    finish_all(path);
  }
  void hold() {
    ASSERT_TRUE(write(reg::kHold, 1));
    for (unsigned clocks = 0; core.outputs().ratio != 0 && clocks < 1'000'000; ++clocks) idle(1);
    ASSERT_EQ(core.outputs().ratio, 0U);
  }
  std::vector<std::int32_t> positions() const {
    std::vector<std::int32_t> all;
    for (unsigned n = 0; n < 4; ++n) all.push_back(static_cast<std::int32_t>(core.position(n)));
    return all;
  }
};

using Step = std::tuple<std::uint64_t, unsigned, int>;  // path tick, axis, direction

std::vector<Step> steps_of(const Bench& bench) {
  std::vector<Step> steps;
  for (const auto& [command, tick, axis, direction, cycle] : bench.steps.path)
    steps.emplace_back(tick, axis, direction);
  return steps;
}

void judge(const Path& path, std::uint64_t silent) {
  Bench whole;
  whole.run(path, 0);
  Bench late;
  late.run(path, silent);
  std::vector<Step> expected = steps_of(whole);
  std::vector<std::int32_t> before(4, 0);
  const std::vector<Step> made = steps_of(late);
  const std::uint64_t passed = path.path_ticks(silent);
  const auto first = expected.end() - static_cast<std::ptrdiff_t>(std::min(made.size(), expected.size()));
  for (auto step = expected.begin(); step != first; ++step) before[std::get<1>(*step)] += std::get<2>(*step);
  EXPECT_EQ(std::vector<Step>(first, expected.end()), made) << silent << " of " << path.ticks << " ticks";
  EXPECT_TRUE(std::all_of(expected.begin(), first, [&](const Step& step) { return std::get<0>(step) <= passed; }));
  EXPECT_TRUE(std::all_of(first, expected.end(), [&](const Step& step) { return std::get<0>(step) > passed; }));
  for (unsigned n = 0; n < 4; ++n) EXPECT_EQ(late.positions()[n] + before[n], whole.positions()[n]) << "axis " << n;
}

// On a held card the silent ticks run and nothing else does. When the hold ends, the ratio rises from 0.
void judge_held(const Path& path, std::uint64_t silent) {
  Bench whole;
  whole.run(path, 0);
  Bench late;
  ASSERT_TRUE(late.write(reg::kSlew, 1U << 18));
  ASSERT_NO_FATAL_FAILURE(late.hold());
  ASSERT_NO_FATAL_FAILURE(late.send(path, silent));
  late.idle(20 * path.ticks + 5000);
  EXPECT_EQ(late.taken, silent) << "the piece behind waits for the ratio";
  EXPECT_EQ(late.core.outputs().ratio, 0U);
  EXPECT_EQ(late.core.outputs().feed_begun, 2U);
  EXPECT_TRUE(late.steps.path.empty() && late.steps.pins.empty());
  ASSERT_TRUE(late.write(reg::kHold, 0));
  late.idle(10);
  EXPECT_LT(late.core.outputs().ratio, 0x100U) << "it rises by the slew";
  ASSERT_NO_FATAL_FAILURE(late.finish_all(path));
  std::vector<Step> expected = steps_of(whole);
  const auto passed = [&](const Step& step) { return std::get<0>(step) <= path.path_ticks(silent); };
  std::vector<std::int32_t> before(4, 0);
  for (const Step& step : expected) before[std::get<1>(step)] += passed(step) ? std::get<2>(step) : 0;
  expected.erase(std::remove_if(expected.begin(), expected.end(), passed), expected.end());
  EXPECT_EQ(steps_of(late), expected) << silent << " of " << path.ticks << " ticks";
  for (unsigned n = 0; n < 4; ++n) EXPECT_EQ(late.positions()[n] + before[n], whole.positions()[n]) << "axis " << n;
}

TEST(SilentPieces, RunWhileTheCardStandsHeld) {
  std::mt19937_64 random(seed());
  for (unsigned i = 0; i < 80; ++i) {
    const Path path = i % 4 == 0   ? random_line(random)
                      : i % 4 == 1 ? random_circle(random, false)
                      : i % 4 == 2 ? random_circle(random, true)
                                   : random_chords(random);
    judge_held(path, i < 12 ? 1 + i / 4 : 1 + random() % (path.ticks - 1));
    if (HasFatalFailure()) return;
  }
}

// A program is held in the middle of a path and dropped there. Resumed with silent ticks it reaches the same end; the
// steps before and after are those of the undisturbed path.
void judge_again(const Path& path, std::uint64_t clocks) {
  Bench whole;
  whole.run(path, 0);
  Bench bench;
  ASSERT_TRUE(bench.write(reg::kSlew, 1U << 20));
  ASSERT_NO_FATAL_FAILURE(bench.send(path, 0));
  bench.idle(clocks);
  ASSERT_NO_FATAL_FAILURE(bench.hold());
  bench.idle(1000);
  const std::uint64_t done = bench.taken;
  if (done == path.ticks) return;
  ASSERT_TRUE(bench.write(reg::kControl, card_map::field::kControlAbort));
  bench.idle(100);
  bench.number = 0;
  ASSERT_NO_FATAL_FAILURE(bench.send(path, done));
  bench.idle(20 * path.ticks);
  EXPECT_EQ(bench.taken, 2 * done);
  ASSERT_TRUE(bench.write(reg::kHold, 0));
  ASSERT_NO_FATAL_FAILURE(bench.finish_all(path));
  EXPECT_EQ(steps_of(bench), steps_of(whole)) << done << " of " << path.ticks << " ticks";
  EXPECT_EQ(bench.positions(), whole.positions());
}

TEST(SilentPieces, HeldProgramGoesOnWithTheStepsOfTheUndisturbedPath) {
  std::mt19937_64 random(seed());
  for (unsigned i = 0; i < 80; ++i) {
    const Path path = i % 4 == 0   ? random_line(random)
                      : i % 4 == 1 ? random_circle(random, false)
                      : i % 4 == 2 ? random_circle(random, true)
                                   : random_chords(random);
    judge_again(path, random() % (16 * path.ticks));
    if (HasFatalFailure()) return;
  }
}

// Also at ratios between 0 and 1.
TEST(SilentPieces, TakeAClockATickAtAnyRatio) {
  for (const std::uint32_t ratio : {0U, 1U, 0x8000U}) {
    Bench bench;
    constexpr std::uint64_t kTicks = 10'000;
    ASSERT_TRUE(bench.write(reg::kRatioFeed, ratio));
    bench.idle(100);
    ASSERT_TRUE(bench.feed(kTicks, kEveryClock, 0, 0, 1, kSilent));
    ASSERT_TRUE(bench.line(kTicks, {kOnePulse / 2}));
    bench.idle(kTicks + 60);
    EXPECT_EQ(bench.taken, kTicks) << ratio;
    EXPECT_EQ(bench.core.outputs().ratio, ratio);
  }
}

TEST(SilentPieces, PathGoesOnWithTheStepsThatItWouldHaveMade) {
  std::mt19937_64 random(seed());
  for (unsigned i = 0; i < 160; ++i) {
    const Path path = i % 4 == 0   ? random_line(random)
                      : i % 4 == 1 ? random_circle(random, false)
                      : i % 4 == 2 ? random_circle(random, true)
                                   : random_chords(random);
    judge(path, i < 12 ? 1 + i / 4 : 1 + random() % (path.ticks - 1));
  }
}

// One tick per clock; the next piece starts from rest after the last silent tick.
TEST(SilentPieces, TakeAClockATick) {
  Bench bench;
  constexpr std::uint64_t kTicks = 10'000;
  ASSERT_TRUE(bench.write(reg::kHold, 1));
  ASSERT_TRUE(bench.feed(kTicks, kEveryClock, 0, 0, 1, kSilent));
  ASSERT_TRUE(bench.feed(100, kEvery16));
  ASSERT_TRUE(bench.line(kTicks + 100, {kOnePulse / 2}));
  ASSERT_TRUE(bench.end());
  ASSERT_TRUE(bench.write(reg::kHold, 0));
  const std::uint64_t begin = bench.core.cycles();
  ASSERT_TRUE(bench.finish(3 * kTicks));
  EXPECT_LT(bench.core.cycles() - begin, kTicks + 100 * 16 + 200);
  EXPECT_EQ(bench.steps.path.size(), 50U);
}

// The flag is accepted with every class; flags without a meaning are refused.
TEST(SilentPieces, FlagsAreRefusedThatHaveNoMeaning) {
  for (unsigned flags = 0; flags < 256; ++flags) {
    Bench bench;
    const bool good = flags < 32 && (flags & 3) != 3;
    EXPECT_EQ(bench.feed(10, kEvery16, 0, 0, 1, static_cast<std::uint8_t>(flags)), good) << flags;
    if (!good) {
      EXPECT_EQ(bench.read(reg::kRefusal) & 0xFF, static_cast<std::uint32_t>(card_map::Reason::BadMask));
    }
  }
}

// A fault during the silent ticks of a held card stops it at once and drops the rest.
TEST(SilentPieces, FaultEndsTheSilenceOfAHeldCard) {
  Bench bench;
  ASSERT_NO_FATAL_FAILURE(bench.hold());
  ASSERT_TRUE(bench.feed(1'000'000, kEveryClock, 0, 0, 1, kSilent));
  ASSERT_TRUE(bench.line(1'000'000, {kOnePulse / 2}));
  ASSERT_TRUE(bench.write(reg::kWatchdog, 1));
  while (bench.core.outputs().fault == 0 && bench.core.cycles() < 100'000) bench.idle(1);
  EXPECT_NE(bench.core.outputs().fault, 0U);
  bench.idle(10);
  const std::uint64_t ticks = bench.taken;
  EXPECT_GT(ticks, 10'000U);
  EXPECT_LT(ticks, 1'000'000U);
  bench.idle(1000);
  EXPECT_EQ(bench.taken, ticks);
}

// A cut during silent ticks does not silence the following pieces.
TEST(SilentPieces, CutEndsTheSilence) {
  for (std::uint64_t clocks = 0; clocks < 300; clocks += 3) {
    Bench bench;
    ASSERT_TRUE(bench.feed(10'000, kEveryClock, 0, 0, 1, kSilent));
    ASSERT_TRUE(bench.line(10'000, {kOnePulse / 2}));
    bench.idle(clocks);
    ASSERT_TRUE(bench.write(reg::kControl, card_map::field::kControlAbort));
    bench.idle(4);
    bench.number = 0;
    ASSERT_TRUE(bench.feed(100, kEvery16));
    ASSERT_TRUE(bench.line(100, {kOnePulse}));
    ASSERT_TRUE(bench.end());
    ASSERT_TRUE(bench.finish(2000));
    EXPECT_EQ(bench.core.position(0), 100U) << clocks;
    EXPECT_EQ(bench.steps.path.size(), 100U) << clocks;
  }
}

}  // namespace
}  // namespace trammel::testing::silent_pieces
