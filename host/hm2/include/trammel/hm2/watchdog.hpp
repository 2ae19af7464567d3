// hostmot2's watchdog, in clocks of the card. It bites (expires) if it is not written in time, and stays bitten until
// the driver clears its status. Off after a reset. Pure state, not thread-safe.
#pragma once

#include <cstdint>

namespace trammel::hm2 {

class Watchdog {
 public:
  static constexpr std::uint32_t kOff = 0x80000000;  // bit of the timer that switches it off
  static constexpr std::uint64_t kNever = UINT64_MAX;

  // Register writes at `clock`.
  void set_timer(std::uint32_t timer, std::uint64_t clock) {  // expires timer + 1 clocks after `clock`
    timer_ = timer;
    restart(clock);
  }
  void reset(std::uint32_t value, std::uint64_t clock) {  // has an effect only with its key
    if (value >> 24 == kKey) restart(clock);
  }
  // Returns true if this write has cleared a bite.
  bool set_status(std::uint32_t value, std::uint64_t clock) {
    if (!bitten_ || (value & 1) != 0) return false;
    bitten_ = false;
    restart(clock);
    return true;
  }

  void bite() { bitten_ = true; }
  bool bitten() const { return bitten_; }
  std::uint32_t timer() const { return timer_; }
  // The clock at which the watchdog bites.
  std::uint64_t deadline() const { return bitten_ || (timer_ & kOff) != 0 ? kNever : deadline_; }

 private:
  static constexpr std::uint32_t kKey = 0x5A;

  void restart(std::uint64_t clock) { deadline_ = clock + timer_ + 1; }

  std::uint32_t timer_ = kOff;
  std::uint64_t deadline_ = 0;
  bool bitten_ = false;
};

}  // namespace trammel::hm2
