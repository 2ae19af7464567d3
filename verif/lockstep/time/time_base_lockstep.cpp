// Lockstep of the time base: RTL and model, both outputs in every cycle.
#include <gtest/gtest.h>

#include <random>

#include "Vdut.h"
#include "lockstep.hpp"
#include "trammel/model/time_base.hpp"

namespace trammel {
namespace {

constexpr std::uint64_t kComparedSignals = 2;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : checker_("time_base", seed) {
    dut_->rst_i = 1;
    dut_->target_i = 0x10000;
    dut_->slew_i = 0;
    dut_->hold_i = 0;
    dut_.clock();
    dut_.clock();
    dut_->rst_i = 0;
  }

  void run(const model::TimeBase::Inputs& in, std::uint64_t clocks) {
    checker_.event("target", in.target);
    checker_.event("slew", in.slew);
    checker_.event("hold", in.hold);
    dut_->target_i = in.target;
    dut_->slew_i = in.slew;
    dut_->hold_i = in.hold;
    for (std::uint64_t i = 0; i < clocks; ++i) {
      dut_.clock();
      model_.clock(in);
      checker_.compare("enable_o", dut_->enable_o, model_.outputs().enable);
      checker_.compare("ratio_o", dut_->ratio_o, model_.outputs().ratio);
      checker_.next_cycle();
    }
  }

  // Every signal of every cycle was compared, and there were as many cycles as the scenario meant to run.
  void expect_cycles(std::uint64_t cycles) const {
    EXPECT_EQ(checker_.cycles(), cycles);
    EXPECT_EQ(checker_.comparisons(), kComparedSignals * cycles);
  }

 private:
  lockstep::Checker checker_;
  lockstep::Simulated<Vdut> dut_;
  model::TimeBase model_;
};

std::uint32_t log_uniform(std::mt19937_64& random, int bits) {
  return static_cast<std::uint32_t>(random() >> (64 - bits) >> (random() % static_cast<unsigned>(bits)));
}

// Ratios at and around 0, 1 and the goal, slews of one unit and of everything at once; hold and resume in between.
void directed() {
  Bench bench(0);
  std::uint64_t cycles = 0;
  const auto run = [&](std::uint32_t target, std::uint32_t slew, bool hold, std::uint64_t clocks) {
    bench.run({target, slew, hold}, clocks);
    cycles += clocks;
  };
  for (const std::uint32_t slew : {0xFFF'FFFFU, 0xFFF'FFFEU, 0x100'0001U, 0x123'4567U}) {
    for (const std::uint32_t target : {0x10000U, 0xFFFFU, 1U, 0U, 0x8000U, 0x5EB8U}) {
      run(target, slew, false, 203);
      run(target, slew, true, 61);
      run(target, slew, false, 30);
    }
  }
  run(0x10000, 1, false, 4001);
  run(0xFFFF, 1, false, 20011);
  run(0, 0, false, 50);
  run(3, 0xFFF, false, 70001);
  bench.expect_cycles(cycles);
}

void random_inputs() {
  const std::uint64_t seed = lockstep::seed_from_environment(1);
  std::mt19937_64 random(seed);
  Bench bench(seed);
  std::uint64_t cycles = 0;
  const std::uint64_t length = lockstep::scaled(2'000'000);
  while (cycles < length) {
    model::TimeBase::Inputs in;
    in.target = random() % 4 == 0 ? 0x10000 : log_uniform(random, 16);
    in.slew = log_uniform(random, 28);
    in.hold = random() % 4 == 0;
    // Mostly short: changes then fall on each of the four clocks of an update.
    const std::uint64_t clocks = 1 + random() % (random() % 8 == 0 ? 5000 : 40);
    bench.run(in, clocks);
    cycles += clocks;
  }
  bench.expect_cycles(cycles);
}

TEST(TimeBaseLockstep, DirectedAndRandom) {
  const std::string complaint = lockstep::judge([] {
    directed();
    random_inputs();
  });
  EXPECT_EQ(complaint, "");
}

}  // namespace
}  // namespace trammel
