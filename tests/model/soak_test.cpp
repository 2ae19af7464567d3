// Long random traffic on the golden core alone, with counters that start near their ends: positions around 2^31 and
// 2^32, the time of the card around 2^32, 2^40 and 2^63. The test counts the pulses at the STEP and DIR pins and knows
// the pulses of each line; positions, ends of lines, FAULT and the time must agree with these. TRAMMEL_LONG=N makes the
// run N times as long (scripts/test --long soak); TRAMMEL_SEED selects another one.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "core_bench.hpp"
#include "trammel/skip/card.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr unsigned kSoakAxes = 4;
constexpr std::uint64_t kSoakClocks = 5'000'000;

model::CardConfig soak_config() {
  model::CardConfig config;
  config.axes = kSoakAxes;
  return config;
}

// A core and the pulses that it has made.
class Soak {
 public:
  explicit Soak(std::uint64_t seed) : bench(soak_config()), random(seed) {
    bench.core.set_steps(nullptr);  // there would be 10^8 steps
    bench.after_clock = [this] {
      if (clock_by_clock) look();
    };
    bench.idle(300);
    for (unsigned n = 0; n < kSoakAxes; ++n) {
      bench.write(reg::step_length(n), 1 + static_cast<std::uint32_t>(below(3)));
      bench.write(reg::step_space(n), 1 + static_cast<std::uint32_t>(below(3)));
      bench.write(reg::dir_setup(n), static_cast<std::uint32_t>(below(4)));
      bench.write(reg::dir_hold(n), static_cast<std::uint32_t>(below(4)));
    }
    for (unsigned n = 0; n < kSoakAxes; ++n) expected[n] = bench.core.position(n);
  }

  std::uint64_t below(std::uint64_t n) { return random() % n; }

  void run(std::uint64_t clocks) {
    while (clocks != 0) {
      const std::uint64_t gone = clock_by_clock ? 0 : skip::jump(bench.core, clocks);
      if (gone == 0) bench.clock({});
      clocks -= std::max<std::uint64_t>(gone, 1);
    }
  }
  // Runs until the card is not busy, for at most 10^8 clocks.
  bool rests() {
    run(16);
    for (std::uint64_t left = 100'000'000; left > 0; left -= std::min<std::uint64_t>(left, 256)) {
      if ((bench.core.outputs().status & field::kStatusBusy) == 0) return true;
      run(256);
    }
    return false;
  }

  // At rest: puts each position around one of its ends, and the time some clocks below one of its ends.
  void put_counters_near_their_ends() {
    auto& motion = bench.core.state().motion.state();
    for (unsigned n = 0; n < kSoakAxes; ++n) {
      constexpr std::uint32_t kEnds[] = {0x80000000U, 0U};
      motion.axes[n].state().shaper.state().out.position =
          static_cast<std::uint32_t>(kEnds[below(2)] - 500 + below(1000));
    }
    constexpr unsigned kTimeBits[] = {32, 40, 63};
    bench.core.state().registers.state().time = (std::uint64_t{1} << kTimeBits[below(3)]) - below(100'000);
    bench.idle(100);
    for (unsigned n = 0; n < kSoakAxes; ++n) expected[n] = bench.core.position(n);
  }

  CoreBench bench;
  std::mt19937_64 random;
  std::array<std::uint32_t, kSoakAxes> expected{};  // positions according to the lines, modulo 2^32
  std::array<std::uint32_t, kSoakAxes> counted{};   // according to the edges at the pins, while clock_by_clock is set
  std::uint64_t pulses = 0;                         // of all lines
  std::uint64_t edges = 0;                          // at STEP pins, while clock_by_clock is set
  bool clock_by_clock = false;                      // may change at rest only

 private:
  // Watches STEP and DIR as a drive does: a pulse at each rising edge of STEP.
  void look() {
    const auto& out = bench.core.outputs();
    const std::uint32_t rising = out.step & ~step_;
    step_ = out.step;
    for (unsigned n = 0; rising >> n != 0; ++n) {
      if ((rising >> n & 1) == 0) continue;
      counted[n] += (out.dir >> n & 1) != 0 ? ~std::uint32_t{0} : 1U;
      ++edges;
    }
  }

  std::uint32_t step_ = 0;
};

// Lines of up to 2,000 pulses with at least 14 ticks per pulse, so that steps catch up after a change of DIR; then the
// pieces for their ticks.
void send_lines(Soak& soak) {
  std::uint64_t ticks = 0;
  for (std::uint64_t lines = 1 + soak.below(4); lines != 0; --lines) {
    std::array<std::int64_t, kSoakAxes> pulses{};
    std::int64_t most = 1;
    for (unsigned n = 0; n < kSoakAxes; ++n) {
      pulses[n] = static_cast<std::int64_t>(soak.below(4001)) - 2000;
      most = std::max(most, std::abs(pulses[n]));
    }
    const auto line_ticks = static_cast<std::int64_t>(static_cast<std::uint64_t>(most) * (14 + soak.below(12)));
    std::vector<std::int64_t> increments;
    for (unsigned n = 0; n < kSoakAxes; ++n) {
      const int128 share = int128{pulses[n]} * kOnePulse;
      increments.push_back(
          static_cast<std::int64_t>((share + (share < 0 ? -line_ticks : line_ticks) / 2) / line_ticks));
      soak.expected[n] += static_cast<std::uint32_t>(pulses[n]);
      soak.pulses += static_cast<std::uint64_t>(std::abs(pulses[n]));
    }
    ASSERT_TRUE(soak.bench.line(static_cast<std::uint64_t>(line_ticks), increments));
    ticks += static_cast<std::uint64_t>(line_ticks);
  }
  while (ticks != 0) {
    const std::uint64_t piece = std::min(ticks, 500 + soak.below(20'000));
    const auto rate = static_cast<std::uint64_t>((0.05 + 0.009 * static_cast<double>(soak.below(100))) * 0x1p64);
    ASSERT_TRUE(soak.bench.feed(piece, rate));
    ticks -= piece;
  }
}

// Actions of a host or a button that change the time of a path; they must not change its steps.
void disturb_time(Soak& soak) {
  soak.run(soak.below(20'000));
  switch (soak.below(4)) {
    case 0:
      soak.bench.write(reg::kHold, 1);
      soak.run(soak.below(50'000));
      soak.bench.write(reg::kHold, 0);
      break;
    case 1:
      soak.bench.write(reg::kRatioFeed, 1 + static_cast<std::uint32_t>(soak.below(0x10000)));
      soak.run(soak.below(5'000));
      soak.bench.write(reg::kRatioFeed, 0x10000);
      break;
    case 2:
      soak.bench.write(reg::kControl, field::kControlSnapshot);
      break;
    default:
      break;
  }
}

void expect_positions(const Soak& soak) {
  for (unsigned n = 0; n < kSoakAxes; ++n) {
    EXPECT_EQ(soak.bench.core.position(n), soak.expected[n]) << "position of axis " << n << " and pulses of its lines";
    if (!soak.clock_by_clock) continue;
    EXPECT_EQ(soak.counted[n], soak.expected[n]) << "edges of axis " << n << " and its lines";
  }
}

TEST(Soak, PositionsAreThePulsesAndLinesEndWhereTheyShould) {
  const char* given = std::getenv("TRAMMEL_LONG");
  const std::uint64_t clocks = kSoakClocks * (given != nullptr ? std::stoull(given) : 1);
  Soak soak(seed());
  std::uint64_t programs = 0;
  for (; soak.bench.core.cycles() < clocks && !HasFailure(); ++programs) {
    SCOPED_TRACE("TRAMMEL_SEED=" + std::to_string(seed()) + " program " + std::to_string(programs));
    if (soak.below(3) == 0) soak.put_counters_near_their_ends();
    soak.clock_by_clock = programs % 4 == 0;
    soak.counted = soak.expected;
    const std::uint64_t begun = soak.bench.core.cycles();
    const std::uint64_t time = soak.bench.core.state().registers.time();
    send_lines(soak);
    for (std::uint64_t n = soak.below(3); n != 0; --n) disturb_time(soak);
    ASSERT_TRUE(soak.rests()) << "it did not come to rest";
    expect_positions(soak);
    EXPECT_EQ(soak.bench.read(reg::kFault), 0U);
    const std::uint64_t gone = soak.bench.core.cycles() - begun;
    EXPECT_EQ(soak.bench.core.state().registers.time() - time, gone) << "clocks of the card's time";
  }
  EXPECT_GT(soak.pulses, clocks / 1000);
  EXPECT_GT(soak.edges, soak.pulses / 20);
  std::printf("%llu clocks of soak\n", static_cast<unsigned long long>(soak.bench.core.cycles()));
  RecordProperty("pulses", std::to_string(soak.pulses));
  RecordProperty("programs", std::to_string(programs));
}

}  // namespace
}  // namespace trammel::testing
