// Every line at 8 fraction bits, tick by tick, against the closed form: x_k = floor(1/2 + k * increment / 2^8),
// |x_k - p k / L| <= 1/2 + k / 2^9, x_L = p; and no step after the count.
#include <Vdut.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "trammel/sim/lockstep.hpp"

namespace trammel::lockstep {
namespace {

constexpr int kOne = 1 << 8;

class Generator {
 public:
  Generator() {
    dut_->rst_i = 1;
    clock();
    dut_->rst_i = 0;
  }

  void load(int increment, bool mirror) {
    // The chain has three halfwords, of which only 10 bits are used here: they are in the lowest halfword, which
    // comes first.
    dut_->load_increment_i = 1;
    dut_->word_i = static_cast<std::uint16_t>(increment);
    clock();
    clock();
    clock();
    dut_->load_increment_i = 0;
    dut_->mirror_i = mirror;
  }

  void load_count(int count) {
    dut_->load_count_i = 1;
    dut_->word_i = static_cast<std::uint16_t>(count);
    clock();
    dut_->word_i = 0;
    clock();
    dut_->load_count_i = 0;
  }

  void swap(bool counted) {
    dut_->swap_i = 1;
    dut_->active_i = 1;
    dut_->counted_i = counted;
    clock();
    dut_->swap_i = 0;
    position_ = 0;
  }

  void tick(bool tick) {
    dut_->tick_i = tick;
    clock();
    if (dut_->step_o) position_ += dut_->dir_o ? -1 : 1;
  }

  bool live() { return dut_->live_o; }
  int position() const { return position_; }
  std::uint64_t clocks = 0;

 private:
  void clock() {
    dut_.clock();
    ++clocks;
  }

  Simulated<Vdut> dut_{kZeros};  // inputs that a test does not set are 0
  int position_ = 0;
};

int floor_divide(int value, int by) { return value >= 0 ? value / by : -((-value + by - 1) / by); }

int increment_of(int p, int l) {
  const int rounded = (2 * std::abs(p) * kOne + l) / (2 * l);
  return p < 0 ? -rounded : rounded;
}

constexpr int kLatency = 2;  // clocks from a tick to its step

// True if the line followed the closed form.
bool line_holds(Generator& generator, int p, int l, bool mirror) {
  const int increment = increment_of(p, l);
  const int half = kOne / 2 - (mirror && increment < 0 ? 1 : 0);
  generator.load(increment, mirror);
  generator.swap(false);
  bool good = true;
  for (int clock = 1; clock <= l + kLatency; ++clock) {
    generator.tick(clock <= l);
    const int k = clock - kLatency;
    if (k < 1) continue;
    const int x = generator.position();
    good = good && x == floor_divide(half + k * increment, kOne);
    good = good && 2 * kOne * std::abs(x * l - p * k) <= kOne * l + k * l;
  }
  return good && generator.position() == p;
}

bool counted_line_holds(Generator& generator, int p, int l, int count) {
  generator.load(increment_of(p, l), false);
  generator.load_count(count);
  generator.swap(true);
  // Twice as long as the line lasts: the increments continue, but there must be no more steps.
  for (int clock = 0; clock < 2 * l; ++clock) generator.tick(true);
  for (int clock = 0; clock < kLatency; ++clock) generator.tick(false);
  if (std::abs(generator.position()) != count || generator.live()) return false;
  generator.tick(false);
  return true;
}

TEST(EveryLine, IsTheClosedForm) {
  Generator generator;
  std::uint64_t lines = 0;
  for (int l = 1; l < kOne; ++l) {
    for (int p = -l; p <= l; ++p) {
      for (const bool mirror : {false, true}) {
        if (mirror && p >= 0) continue;  // the preset of both is the same
        ++lines;
        ASSERT_TRUE(line_holds(generator, p, l, mirror)) << p << " pulses in " << l << " ticks, mirror " << mirror;
      }
    }
  }
  EXPECT_EQ(lines, 98175u);
  EXPECT_GT(generator.clocks, 15'000'000u);
  RecordProperty("lines", std::to_string(lines));
  RecordProperty("clocks", std::to_string(generator.clocks));
}

TEST(EveryCountedLine, StopsAtItsCount) {
  Generator generator;
  std::uint64_t lines = 0;
  for (int l = 1; l <= 64; ++l) {
    for (int p = -l; p <= l; ++p) {
      if (p == 0) continue;
      ++lines;
      ASSERT_TRUE(counted_line_holds(generator, p, l, std::abs(p))) << p << " pulses in " << l << " ticks";
      ASSERT_TRUE(counted_line_holds(generator, p, l, std::abs(p) - 1))
          << p << " pulses in " << l << " ticks, one less";
    }
  }
  EXPECT_EQ(lines, 4160u);
}

}  // namespace
}  // namespace trammel::lockstep
