// Silent pieces on the golden card: a path whose first ticks are silent makes, from there on, the very steps that it
// makes from its begin, whatever it runs on.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

#include "chord_arc.hpp"
#include "core_bench.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;

constexpr std::uint8_t kSilent = card_map::constant::kPieceSilent;
constexpr std::uint64_t kEveryClock = ~std::uint64_t{0};    // rate
constexpr std::uint64_t kEvery16 = std::uint64_t{1} << 60;  // a tick in 16 clocks

// A path over so many feed ticks.
struct Path {
  std::uint64_t ticks = 0;
  std::uint64_t prescale = 0;  // 2^-40 path ticks per feed tick
  std::function<bool(CoreBench&)> send;

  std::uint64_t path_ticks(std::uint64_t feed_ticks) const {
    return static_cast<std::uint64_t>((kOnePulse / 2 + int128{feed_ticks} * static_cast<std::int64_t>(prescale)) >> 40);
  }
};

model::CardConfig all_engines() {
  model::CardConfig config;
  config.engines |= card_map::engines::kArcGenerator | card_map::engines::kAccumulator8;
  return config;
}

struct Bench : CoreBench {
  Bench() : CoreBench(all_engines()) {
    for (unsigned n = 0; n < 4; ++n) write(reg::step_length(n), 1);
  }
  // Pieces first: the path's ticks, of which the first `silent` make no steps.
  void run(const Path& path, std::uint64_t silent) {
    if (silent != 0) ASSERT_TRUE(feed(silent, kEveryClock, 0, 0, 1, kSilent));
    ASSERT_TRUE(feed(path.ticks - silent, kEvery16));
    ASSERT_TRUE(path.send(*this));
    ASSERT_TRUE(end());
    ASSERT_TRUE(finish(100 * path.ticks + 100'000));
    ASSERT_EQ(core.outputs().fault, 0U);
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

Path line(std::mt19937_64& random) {
  const std::uint64_t ticks = 200 + random() % 2000;
  std::vector<std::int64_t> increments;
  for (unsigned n = 0; n < 4; ++n)
    increments.push_back(static_cast<std::int64_t>(random() % kOnePulse) - kOnePulse / 2);
  return {ticks, kOnePulse, [=](CoreBench& bench) { return bench.line(ticks, increments); }};
}

Path circle(std::mt19937_64& random, bool eight) {
  const auto r = static_cast<std::int64_t>(2 + random() % 30);
  const std::uint64_t ticks = 8 * static_cast<std::uint64_t>(r) * (1 + random() % 20);
  const bool clockwise = random() % 2 != 0;
  const std::int64_t made = eight ? CoreBench::steps_in_eight(r) : 8 * r;
  const std::uint64_t prescale = (static_cast<std::uint64_t>(made) * kOnePulse + ticks / 2) / ticks;
  return {ticks, prescale, [=](CoreBench& bench) { return bench.circle(ticks, r, clockwise, eight); }};
}

Path chords(std::mt19937_64& random) {
  model::ArcPoints arc;
  const auto r = static_cast<std::int64_t>(20 + random() % 60);
  arc.start = {r, 0};
  arc.end = {0, -r};
  arc.clockwise = random() % 2 != 0;
  const driver::ArcChordCommand command = model::prepare_command(arc, {0, 0, 40});
  return {command.ticks, command.prescale, [=](CoreBench& bench) {
            std::vector<std::uint32_t> words(driver::kMaxCommandWords);
            words.resize(driver::encode(command, bench.number++, words.data()));
            return bench.send(words);
          }};
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

TEST(SilentPieces, PathGoesOnWithTheStepsThatItWouldHaveMade) {
  std::mt19937_64 random(seed());
  for (unsigned i = 0; i < 160; ++i) {
    const Path path = i % 4 == 0   ? line(random)
                      : i % 4 == 1 ? circle(random, false)
                      : i % 4 == 2 ? circle(random, true)
                                   : chords(random);
    judge(path, i < 12 ? 1 + i / 4 : 1 + random() % (path.ticks - 1));
  }
}

// A tick a clock, and the piece behind begins from rest once the last silent tick has gone through.
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

// The flag goes with each class, and with nothing that is none.
TEST(SilentPieces, FlagsAreRefusedThatHaveNoMeaning) {
  for (unsigned flags = 0; flags < 256; ++flags) {
    Bench bench;
    const bool good = flags < 8 && (flags & 3) != 3;
    EXPECT_EQ(bench.feed(10, kEvery16, 0, 0, 1, static_cast<std::uint8_t>(flags)), good) << flags;
    if (!good) EXPECT_EQ(bench.read(reg::kRefusal) & 0xFF, static_cast<std::uint32_t>(card_map::Reason::BadMask));
  }
}

// What is cut off in silence does not silence what follows.
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
}  // namespace trammel::testing
