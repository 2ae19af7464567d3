// Golden models of the two gates that hold ticks until their user can take them. Not thread-safe; no errors are
// reported.
#pragma once

#include <cstdint>

namespace trammel::model {

// Ticks of the feed generator, owed to the path.
class TickGate {
 public:
  void clock(bool clear, bool tick, bool take) { count_ = clear ? 0 : count_ + (tick ? 1U : 0U) - (take ? 1U : 0U); }
  bool owed() const { return count_ != 0; }
  bool stall() const { return count_ > 1; }

 private:
  std::uint32_t count_ = 0;
};

// Path ticks of an arc, from the prescaler to the accumulator, which answers a tick with ready low one clock later.
class PathTickGate {
 public:
  void clock(bool clear, bool step, bool engine_ready) {
    const bool give = count_ != 0 && engine_ready && !tick_;
    const bool was_tick = tick_;
    count_ = clear ? 0 : count_ + (step ? 1U : 0U) - (give ? 1U : 0U);
    tick_ = give && !clear;
    ready_ = count_ < 2;
    empty_ = count_ == 0 && !give && !was_tick && engine_ready;
  }
  bool tick() const { return tick_; }    // to the accumulator
  bool ready() const { return ready_; }  // feed ticks may be taken
  bool empty() const { return empty_; }  // nothing waits and the last one is worked off
  bool waiting() const { return count_ != 0; }

 private:
  std::uint32_t count_ = 0;
  bool tick_ = false;
  bool ready_ = true;
  bool empty_ = false;
};

}  // namespace trammel::model
