// Lockstep of the pulse generator: directed corner cases and random lines, every output in every cycle.
#include <gtest/gtest.h>

#include <random>

#include "pulse_generator_bench.hpp"

namespace trammel::lockstep {
namespace {

constexpr std::int64_t kOne = std::int64_t{1} << 40;
constexpr bool kCounted = TRAMMEL_COUNTED != 0;  // the generator has a count that can end a line

PulseGeneratorBench::Inputs swap_in(bool active, bool counted, bool mirror, bool tick) {
  PulseGeneratorBench::Inputs in;
  in.swap = true;
  in.active = active;
  in.counted = counted;
  in.mirror = mirror;
  in.tick = tick;
  return in;
}

// The largest increments in both directions, with a tick in every clock: a step in every clock, and exactly the
// count.
void full_rate() {
  if (!kCounted) return;
  PulseGeneratorBench bench(0);
  for (const std::int64_t increment : {kOne, -kOne}) {
    for (const std::uint32_t count : {0U, 1U, 2U, 15U, 16U, 17U, 32U, 65536U, 70001U}) {
      const std::uint64_t before = bench.steps();
      bench.load_increment(increment);
      bench.load_count(count);
      bench.clock(swap_in(true, true, increment < 0, false));
      bench.ticks(count + 20);
      bench.wait(5);
      if (bench.steps() - before != count) throw std::logic_error("the model itself missed the count");
      if (bench.model().outputs().live) throw std::logic_error("live after its count");
    }
  }
  EXPECT_EQ(bench.check().comparisons(), bench.check().cycles() * 3);
  EXPECT_GT(bench.check().cycles(), 250'000U);
}

// A line and its mirror image whose phases meet exactly one half and zero, swapped without a gap.
void seams() {
  PulseGeneratorBench bench(0);
  for (int repeat = 0; repeat < 2000; ++repeat) {
    for (const std::int64_t increment :
         {kOne / 2, -kOne / 2, kOne / 4, -kOne / 4, kOne, -kOne, kOne - 1, 1 - kOne, kOne / 2 - 1, 1 - kOne / 2}) {
      bench.load_increment(increment, true);
      bench.clock(swap_in(true, false, repeat % 2 != 0, repeat % 3 != 0));
      bench.ticks(static_cast<std::uint64_t>(2 + repeat % 7));
    }
  }
  EXPECT_EQ(bench.check().comparisons(), bench.check().cycles() * 3);
}

// Chords: the increment changes with the swap that keeps the phase, forwards and backwards, with a tick in every
// clock and while the carry between the halves is on its way.
void chords() {
  PulseGeneratorBench bench(0);
  for (int repeat = 0; repeat < 500; ++repeat) {
    bench.load_increment(repeat % 2 != 0 ? kOne / 3 : -kOne / 3);
    bench.clock(swap_in(repeat % 5 != 0, false, false, true));
    bench.ticks(2);
    for (const std::int64_t increment : {kOne - 1, -kOne, kOne / 2 + repeat, 1 - kOne / 2, kOne, std::int64_t{0}}) {
      bench.load_increment(increment, repeat % 3 != 0);
      PulseGeneratorBench::Inputs in;
      in.chord = true;
      in.tick = repeat % 4 != 0;
      bench.clock(in);
      bench.ticks(static_cast<std::uint64_t>(2 + repeat % 7));
    }
  }
  EXPECT_EQ(bench.check().comparisons(), bench.check().cycles() * 3);
  EXPECT_GT(bench.steps(), 2'000U);
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : bench_(seed), random_(seed) {}

  void line() {
    load();
    const unsigned kind = below(8);
    counted_ = kCounted && kind < 3;
    if (counted_) bench_.load_count(below(4) == 0 ? below(3) : below(60), tick());
    bench_.clock(swap_in(kind != 7, counted_, below(2) == 0, tick()));
    if (!counted_ && below(3) == 0) arc();
    if (below(6) == 0) {  // while the swap, or the first step, is still on its way
      run(below(6));
      return abort();
    }
    run(2 + below(150));
    if (!counted_) return;
    // A counted line ends before the next one: at its count, or by an abort.
    const unsigned clocks = below(400);
    for (unsigned i = 0; i < clocks && bench_.model().outputs().live; ++i) run(1);
    if (bench_.model().outputs().live) abort();
  }

  PulseGeneratorBench& bench() { return bench_; }

 private:
  // Further increments, each taken by a chord; the phase continues.
  void arc() {
    for (unsigned left = below(6); left != 0; --left) {
      run(2 + below(40));
      load();
      PulseGeneratorBench::Inputs in;
      in.chord = true;
      in.tick = tick();
      bench_.clock(in);
    }
  }

  void abort() {
    bench_.check().event("clear");
    const bool reset = below(4) == 0;
    PulseGeneratorBench::Inputs in;
    in.clear = !reset;
    in.tick = tick();
    in.swap = below(2) == 0;
    in.chord = !in.swap && below(2) == 0;
    in.active = true;
    if (reset)
      bench_.reset(in);
    else
      bench_.clock(in);
    run(3);
  }

  void load() {
    const unsigned kind = below(4);
    std::int64_t magnitude = static_cast<std::int64_t>(random_() & static_cast<std::uint64_t>(kOne - 1));
    if (kind == 0) magnitude >>= below(40);
    if (kind == 1) magnitude = kOne - (magnitude >> (20 + below(20)));
    rate_ = below(5);
    bench_.load_increment(below(2) == 0 ? magnitude : -magnitude, tick());
  }

  void run(unsigned clocks) {
    for (unsigned i = 0; i < clocks; ++i) {
      PulseGeneratorBench::Inputs in;
      in.tick = tick();
      bench_.clock(in);
    }
  }

  bool tick() { return rate_ == 0 || below(rate_) == 0; }
  unsigned below(unsigned n) { return static_cast<unsigned>(random_() >> 32) % n; }

  PulseGeneratorBench bench_;
  std::mt19937_64 random_;
  unsigned rate_ = 0;
  bool counted_ = false;
};

void random_lines() {
  Random random(seed_from_environment(20260701));
  const std::uint64_t length = scaled(400'000);
  while (random.bench().check().cycles() < length) random.line();
  EXPECT_EQ(random.bench().check().comparisons(), random.bench().check().cycles() * 3);
  EXPECT_GT(random.bench().steps(), 50'000U);
}

TEST(PulseGenerator, FullRateAndCounts) { EXPECT_EQ(judge(full_rate), ""); }
TEST(PulseGenerator, Seams) { EXPECT_EQ(judge(seams), ""); }
TEST(PulseGenerator, Chords) { EXPECT_EQ(judge(chords), ""); }
TEST(PulseGenerator, RandomLines) { EXPECT_EQ(judge(random_lines), ""); }

}  // namespace
}  // namespace trammel::lockstep
