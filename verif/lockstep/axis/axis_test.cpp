// Lockstep of a whole axis: lines, external steps and random times, every output in every cycle.
#include "trammel/model/axis.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include <random>

#include "lockstep.hpp"

namespace trammel::lockstep {
namespace {

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("axis", seed), random_(seed) {
    apply();
    dut_->rst_i = 1;
    for (int i = 0; i < 4; ++i) dut_.clock();
    dut_->rst_i = 0;
  }

  // A line, or a stretch of external steps, with its own times.
  void path() {
    settings();
    const bool external = below(4) == 0;
    const std::int64_t top = std::int64_t{1} << (30 + below(11));
    const std::int64_t magnitude = static_cast<std::int64_t>(random_() >> 24) % (top + 1);
    load(below(2) == 0 ? magnitude : -magnitude);
    in_.generator.swap = true;
    in_.generator.active = !external;
    in_.generator.mirror = below(2) == 0;
    clock();
    in_.generator.swap = false;
    // The old line's steps leave the generator before the first external one.
    for (int i = 0; i < 3; ++i) clock();
    const unsigned every = 1 + below(20);
    const unsigned clocks = 20 + below(500);
    for (unsigned i = 0; i < clocks; ++i) {
      in_.generator.tick = below(every) == 0;
      in_.ext_step = external && below(every) == 0;
      in_.ext_dir = below(3) == 0;
      clock();
    }
    in_.ext_step = false;
    in_.generator.tick = false;
  }

  Checker& check() { return check_; }
  std::uint64_t steps() const { return steps_; }

 private:
  void settings() {
    const unsigned top = 1U << below(5);
    in_.shaper.step_length = static_cast<std::uint16_t>(below(top));
    in_.shaper.step_space = static_cast<std::uint16_t>(below(top));
    in_.shaper.dir_setup = static_cast<std::uint16_t>(below(top));
    in_.shaper.dir_hold = static_cast<std::uint16_t>(below(top));
    in_.shaper.mode = static_cast<std::uint8_t>(below(16));
  }

  void load(std::int64_t increment) {
    check_.event("increment", static_cast<std::uint64_t>(increment));
    in_.generator.load_increment = true;
    for (int i = 0; i < 3; ++i) {
      in_.generator.word = static_cast<std::uint16_t>(static_cast<std::uint64_t>(increment) >> (16 * i));
      clock();
    }
    in_.generator.load_increment = false;
  }

  void clock() {
    in_.shaper.hold_tick = below(100) == 0;
    in_.shaper.clear_fault = below(60) == 0;
    apply();
    dut_.clock();
    model_.clock(in_);
    check_.next_cycle();
    const auto out = model_.outputs();
    check_.compare("path_step_o", dut_->path_step_o, out.path_step);
    check_.compare("path_dir_o", dut_->path_dir_o, out.path_dir);
    check_.compare("live_o", dut_->live_o, out.live);
    check_.compare("step_o", dut_->step_o, out.shaper.step);
    check_.compare("dir_o", dut_->dir_o, out.shaper.dir);
    check_.compare("position_o", dut_->position_o, out.shaper.position);
    check_.compare("busy_o", dut_->busy_o, out.shaper.busy);
    check_.compare("fault_o", dut_->fault_o, out.shaper.fault);
    steps_ += out.path_step ? 1 : 0;
  }

  void apply() {
    dut_->clear_i = in_.generator.clear;
    dut_->tick_i = in_.generator.tick;
    dut_->swap_i = in_.generator.swap;
    dut_->active_i = in_.generator.active;
    dut_->counted_i = in_.generator.counted;
    dut_->mirror_i = in_.generator.mirror;
    dut_->load_increment_i = in_.generator.load_increment;
    dut_->load_count_i = in_.generator.load_count;
    dut_->word_i = in_.generator.word;
    dut_->ext_step_i = in_.ext_step;
    dut_->ext_dir_i = in_.ext_dir;
    dut_->step_length_i = in_.shaper.step_length;
    dut_->step_space_i = in_.shaper.step_space;
    dut_->dir_setup_i = in_.shaper.dir_setup;
    dut_->dir_hold_i = in_.shaper.dir_hold;
    dut_->mode_i = in_.shaper.mode;
    dut_->hold_tick_i = in_.shaper.hold_tick;
    dut_->clear_fault_i = in_.shaper.clear_fault;
  }

  unsigned below(unsigned n) { return static_cast<unsigned>(random_() >> 32) % n; }

  Simulated<Vdut> dut_;
  model::Axis model_;
  model::Axis::Inputs in_;
  Checker check_;
  std::mt19937_64 random_;
  std::uint64_t steps_ = 0;
};

void random_paths() {
  Bench bench(seed_from_environment(20260703));
  const std::uint64_t length = scaled(400'000);
  while (bench.check().cycles() < length) bench.path();
  EXPECT_EQ(bench.check().comparisons(), bench.check().cycles() * 8);
  EXPECT_GT(bench.steps(), 10'000U);
}

TEST(Axis, RandomPaths) { EXPECT_EQ(judge(random_paths), ""); }

}  // namespace
}  // namespace trammel::lockstep
