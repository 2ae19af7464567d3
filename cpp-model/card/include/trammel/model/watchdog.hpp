// Golden model of the watchdog over the host: it expires when its time has passed since the last write of WATCHDOG,
// and stays expired until the next write. A time of 0 never expires. Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class Watchdog {
 public:
  using Inputs = Setting;
  // Clocks per unit of WATCHDOG.
  static constexpr std::uint64_t kUnitClocks = 65'536;

  // All that the next clock() depends on besides its inputs.
  struct State {
    std::uint64_t left = 0;  // clocks until it expires; 0: not running. At most 0xFFFF units plus one clock.
    bool expired = false;
  };

  // One rising edge. A time of n units that is written in clock c has expired from clock c + n * kUnitClocks + 2 on.
  void clock(const Setting& setting) {
    if (setting.set && setting.address == card_map::reg::kWatchdog) {
      state_ = {setting.data == 0 ? 0 : setting.data * kUnitClocks + 1, false};
    } else if (state_.left != 0 && --state_.left == 0) {
      state_.expired = true;
    }
  }

  const State& state() const { return state_; }
  State& state() { return state_; }
  bool expired() const { return state_.expired; }
  bool running() const { return state_.left != 0; }

 private:
  State state_;
};

}  // namespace trammel::model
