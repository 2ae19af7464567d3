// One variant of the Verilated card. Each Verilated class has its own file that instantiates it.
#pragma once

#include "card_inputs.hpp"
#include "trammel/sim/lockstep.hpp"
#include "verilated_card.hpp"

namespace trammel::sim {

template <class Dut, unsigned kAxes>
class CardVariant : public VerilatedCard {
 public:
  explicit CardVariant(const CardStraps& straps) {
    dut_->clock_hz_i = straps.clock_hz;
    dut_->output_idle_i = static_cast<std::uint8_t>(straps.output_idle & ((1U << kOutputs) - 1));
    dut_->emergency_stop_level_i = straps.emergency_stop_level;
    dut_->idle_level_i = static_cast<std::uint16_t>(straps.idle_level & ((1U << 2 * kAxes) - 1));
  }

  void run(const model::CardModel::Inputs& in, std::size_t clocks, CardRecord* records) override {
    set_inputs(*dut_, in);
    for (std::size_t i = 0; i < clocks; ++i) {
      dut_.clock();
      records[i].template show_rtl<kAxes>(*dut_);
    }
  }

 protected:
  lockstep::Simulated<Dut> dut_;
};

// Evaluates both edges of each clock, and calls `at_edge` after each: for a trace, and to verify CardVariant, which
// skips the falling edge.
template <class Dut, unsigned kAxes>
class BothEdgesVariant : public CardVariant<Dut, kAxes> {
 public:
  using CardVariant<Dut, kAxes>::CardVariant;

  void run(const model::CardModel::Inputs& in, std::size_t clocks, CardRecord* records) override {
    set_inputs(*this->dut_, in);
    for (std::size_t i = 0; i < clocks; ++i) {
      this->dut_.clock_by_both_edges([this] { at_edge(); });
      records[i].template show_rtl<kAxes>(*this->dut_);
    }
  }

 protected:
  virtual void at_edge() {}
};

}  // namespace trammel::sim
