// Golden model of the timer (wait_timer) that judges steps which wait: one clock in HOLD_LIMIT, for all shapers. Not
// thread-safe; no errors are reported.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class WaitTimer {
 public:
  // One rising edge. A limit set in clock c counts from c+1 on.
  void clock(const Setting& setting) {
    tick_ = count_ + 1 >= limit_;
    count_ = tick_ ? 0 : count_ + 1;
    if (setting.set && setting.address == card_map::reg::kHoldLimit) limit_ = setting.data;
  }

  // The same as clock() n times without a setting.
  void advance(std::uint64_t n) {
    if (n == 0) return;
    clock({});  // a limit lowered below the count is caught up here
    if (n == 1) return;
    count_ = static_cast<std::uint32_t>((count_ + (n - 1)) % limit_);
    tick_ = count_ == 0;
  }

  bool tick() const { return tick_; }
  std::uint32_t limit() const { return limit_; }

 private:
  std::uint32_t limit_ = 0xFFFF;  // clocks, at least 1
  std::uint32_t count_ = 0;
  bool tick_ = false;
};

}  // namespace trammel::model
