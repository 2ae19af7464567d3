// Golden model of the health outputs, which tell an emergency-stop chain that the card is healthy: a level, and a
// square wave for a charge pump. Inputs of clock c take effect at c + 1. Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class CardHealth {
 public:
  static constexpr std::uint64_t kForever = ~std::uint64_t{0};

  struct Inputs {
    Setting setting;  // HEALTH_CAUSES, CHARGE_PUMP
    std::uint32_t fault = 0;
    bool fed = false;  // the watchdog runs
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    std::uint32_t causes = 0;  // HEALTH_CAUSES
    std::uint32_t half = 0;    // CHARGE_PUMP: clocks from one edge to the next; 0: no wave
    std::uint32_t count = 0;   // clocks since the last edge
    bool healthy = false;
    bool pump = false;
  };

  // One rising edge.
  void clock(const Inputs& in) {
    const bool beats = state_.healthy && state_.half != 0;
    const bool edge = beats && state_.count + 1 >= state_.half;
    state_.pump = beats && state_.pump != edge;
    state_.count = beats && !edge ? state_.count + 1 : 0;
    state_.healthy = healthy_with(in);
    if (!in.setting.set) return;
    if (in.setting.address == card_map::reg::kHealthCauses) state_.causes = in.setting.data;
    if (in.setting.address == card_map::reg::kChargePump) state_.half = in.setting.data;
  }

  const State& state() const { return state_; }
  State& state() { return state_; }
  bool healthy() const { return state_.healthy; }
  bool pump() const { return state_.pump; }
  // The number of clocks for which these inputs change nothing but `count`.
  std::uint64_t quiet_clocks(const Inputs& in) const {
    if (in.setting.set || healthy_with(in) != state_.healthy) return 0;
    if (!state_.healthy || state_.half == 0) return state_.pump || state_.count != 0 ? 0 : kForever;
    return state_.count + 1 >= state_.half ? 0 : state_.half - 1 - state_.count;
  }
  void pass(std::uint64_t clocks) {
    if (state_.healthy && state_.half != 0) state_.count += static_cast<std::uint32_t>(clocks);
  }

 private:
  bool healthy_with(const Inputs& in) const {
    const bool hungry = (state_.causes & card_map::field::kHealthCausesNoWatchdog) != 0 && !in.fed;
    return (in.fault & state_.causes) == 0 && !hungry;
  }

  State state_;
};

}  // namespace trammel::model
