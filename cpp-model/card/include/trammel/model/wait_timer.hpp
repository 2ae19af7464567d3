// Golden model of wait_timer, which limits how long steps may wait: one tick every HOLD_LIMIT clocks, for all
// shapers. Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class WaitTimer {
 public:
  using Inputs = Setting;
  // All that the next clock() depends on besides its inputs.
  struct State {
    std::uint32_t limit = 0xFFFF;  // clocks, at least 1
    std::uint32_t count = 0;
    bool tick = false;
  };

  // One rising edge. A limit set in clock c counts from c+1 on.
  void clock(const Setting& setting) {
    state_.tick = state_.count + 1 >= state_.limit;
    state_.count = state_.tick ? 0 : state_.count + 1;
    if (setting.set && setting.address == card_map::reg::kHoldLimit) state_.limit = setting.data;
  }

  const State& state() const { return state_; }
  State& state() { return state_; }
  bool tick() const { return state_.tick; }
  std::uint32_t limit() const { return state_.limit; }

 private:
  State state_;
};

}  // namespace trammel::model
