// Lockstep of the step shaper: random steps, times, modes, wait ticks and resets, every output in every cycle.
#include "trammel/model/step_shaper.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include <random>

#include "trammel/sim/lockstep.hpp"

namespace trammel::lockstep {
namespace {

class Bench {
 public:
  using Inputs = model::StepShaper::Inputs;

  explicit Bench(std::uint64_t seed) : check_("step_shaper", seed), random_(seed) { reset(Inputs{}); }

  // One clock of reset, with these other inputs. The strap for the levels of the pins in reset is random.
  void reset(const Inputs& in) {
    check_.event("reset");
    const unsigned idle_level = below(4);
    dut_->idle_level_i = static_cast<CData>(idle_level);
    apply(in);
    dut_->rst_i = 1;
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::StepShaper(idle_level);
    position_ahead_ = 0;
    compare();
  }

  void clock(const Inputs& in) {
    apply(in);
    dut_.clock();
    model_.clock(in);
    compare();
    if (model_.outputs().fault) ++faulty_;
  }

  // A stretch with one choice of times, mode and densities; the times may change in the middle.
  void stretch(unsigned clocks) {
    Inputs in;
    const unsigned every = 1 + below(40);
    const unsigned turns = 1 + below(6);
    const unsigned wait_every = 20 + below(300);
    times(in);
    in.mode = static_cast<std::uint8_t>(below(16));
    check_.event("mode", in.mode);
    for (unsigned i = 0; i < clocks; ++i) {
      if (below(200) == 0) times(in);
      in.step = below(every) == 0;
      if (in.step && below(turns) == 0) in.dir = !in.dir;
      in.wait_tick = below(wait_every) == 0;
      if (below(3000) == 0) reset(in);
      if (below(100) == 0) position_near_a_carry();
      clock(in);
    }
  }

  Checker& check() { return check_; }
  unsigned below(unsigned n) { return static_cast<unsigned>(random_() >> 32) % n; }
  std::uint64_t faulty() const { return faulty_; }
  const model::StepShaper& model() const { return model_; }

 private:
  // Moves the position to a few steps on either side of a power of two, including 2^32. The port is the register
  // itself. The pins show the two low bits of the position, which do not change.
  void position_near_a_carry() {
    const std::uint32_t position = (1U << below(32)) * below(2) + below(9) - 4;
    position_ahead_ = (position - model_.outputs().position) & ~3U;
    dut_->position_o = model_.outputs().position + position_ahead_;
  }

  void compare() {
    check_.next_cycle();
    const auto& out = model_.outputs();
    check_.compare("step_o", dut_->step_o, out.step);
    check_.compare("dir_o", dut_->dir_o, out.dir);
    check_.compare("position_o", dut_->position_o, out.position + position_ahead_);
    check_.compare("busy_o", dut_->busy_o, out.busy);
    check_.compare("fault_o", dut_->fault_o, out.fault);
  }

  void times(Inputs& in) {
    const unsigned top = 1U << below(6);
    in.step_length = static_cast<std::uint16_t>(below(top));
    in.step_space = static_cast<std::uint16_t>(below(top));
    in.dir_setup = static_cast<std::uint16_t>(below(top));
    in.dir_hold = static_cast<std::uint16_t>(below(top));
    check_.event("length and space", std::uint64_t{in.step_length} << 16 | in.step_space);
  }

  void apply(const Inputs& in) {
    dut_->step_i = in.step;
    dut_->dir_i = in.dir;
    dut_->step_length_i = in.step_length;
    dut_->step_space_i = in.step_space;
    dut_->dir_setup_i = in.dir_setup;
    dut_->dir_hold_i = in.dir_hold;
    dut_->mode_i = in.mode;
    dut_->wait_tick_i = in.wait_tick;
  }

  Simulated<Vdut> dut_;
  model::StepShaper model_;
  Checker check_;
  std::mt19937_64 random_;
  std::uint32_t position_ahead_ = 0;  // the RTL's position minus the model's
  std::uint64_t faulty_ = 0;
};

// The largest times, one at a time: every phase must end.
void longest_times() {
  Bench bench(0);
  for (int which = 0; which < 4; ++which) {
    Bench::Inputs in;
    in.step_length = which == 0 ? 0xFFFF : 1;
    in.step_space = which == 1 ? 0xFFFF : 0;
    in.dir_setup = which == 2 ? 0xFFFF : 0;
    in.dir_hold = which == 3 ? 0xFFFF : 0;
    for (unsigned i = 0; i < 70'000; ++i) {
      in.step = i < 3;
      in.dir = (i & 1) != 0;
      bench.clock(in);
    }
    in.step = false;
    for (unsigned i = 0; i < 200'000 && bench.model().outputs().busy; ++i) bench.clock(in);
    if (bench.model().outputs().busy) throw std::logic_error("the axis stalls");
  }
  EXPECT_EQ(bench.check().comparisons(), bench.check().cycles() * 5);
}

void random_steps() {
  Bench bench(seed_from_environment(20260702));
  const std::uint64_t length = scaled(600'000);
  while (bench.check().cycles() < length) bench.stretch(50 + bench.below(2000));
  EXPECT_EQ(bench.check().comparisons(), bench.check().cycles() * 5);
  EXPECT_GT(bench.faulty(), 1000U);
}

TEST(StepShaper, RandomSteps) { EXPECT_EQ(judge(random_steps), ""); }
TEST(StepShaper, LongestTimes) { EXPECT_EQ(judge(longest_times), ""); }

}  // namespace
}  // namespace trammel::lockstep
