// The pulse generator beside its golden model: one call per clock, every output compared after every edge.
#pragma once

#include <Vdut.h>

#include <cstdint>

#include "trammel/model/pulse_generator.hpp"
#include "trammel/sim/lockstep.hpp"

namespace trammel::lockstep {

class PulseGeneratorBench {
 public:
  using Inputs = model::PulseGenerator::Inputs;

  explicit PulseGeneratorBench(std::uint64_t seed) : check_("pulse_generator", seed) { reset(Inputs{}); }

  // One clock of reset, with these other inputs.
  void reset(const Inputs& in) {
    check_.event("reset");
    apply(in);
    dut_->rst_i = 1;
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::PulseGenerator();
    compare();
  }

  void clock(const Inputs& in) {
    apply(in);
    dut_.clock();
    model_.clock(in);
    compare();
    steps_ += model_.outputs().step ? 1U : 0U;
  }

  // Shifts an increment (2^-40 pulses per tick) in; with `tick`, ticks continue.
  void load_increment(std::int64_t increment, bool tick = false) {
    check_.event("increment", static_cast<std::uint64_t>(increment));
    for (int i = 0; i < 3; ++i) {
      Inputs in;
      in.tick = tick;
      in.load_increment = true;
      in.word = static_cast<std::uint16_t>(static_cast<std::uint64_t>(increment) >> (16 * i));
      clock(in);
    }
  }

  void load_count(std::uint32_t count, bool tick = false) {
    check_.event("count", count);
    for (int i = 0; i < 2; ++i) {
      Inputs in;
      in.tick = tick;
      in.load_count = true;
      in.word = static_cast<std::uint16_t>(count >> (16 * i));
      clock(in);
    }
  }

  void ticks(std::uint64_t n) {
    Inputs in;
    in.tick = true;
    for (std::uint64_t i = 0; i < n; ++i) clock(in);
  }

  void wait(std::uint64_t n) {
    for (std::uint64_t i = 0; i < n; ++i) clock(Inputs{});
  }

  Checker& check() { return check_; }
  const model::PulseGenerator& model() const { return model_; }
  std::uint64_t steps() const { return steps_; }  // steps since reset

 private:
  void compare() {
    check_.next_cycle();
    const auto& out = model_.outputs();
    check_.compare("step_o", dut_->step_o, out.step);
    check_.compare("dir_o", dut_->dir_o, out.dir);
    check_.compare("live_o", dut_->live_o, out.live);
  }

  void apply(const Inputs& in) {
    dut_->clear_i = in.clear;
    dut_->tick_i = in.tick;
    dut_->swap_i = in.swap;
    dut_->chord_i = in.chord;
    dut_->active_i = in.active;
    dut_->counted_i = in.counted;
    dut_->mirror_i = in.mirror;
    dut_->load_increment_i = in.load_increment;
    dut_->load_count_i = in.load_count;
    dut_->word_i = in.word;
  }

  Simulated<Vdut> dut_;
  model::PulseGenerator model_;
  Checker check_;
  std::uint64_t steps_ = 0;
};

}  // namespace trammel::lockstep
