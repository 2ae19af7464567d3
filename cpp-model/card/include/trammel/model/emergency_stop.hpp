// Golden model of the emergency stop's pin, clock by clock. The pin's level sets a latch. Only a clear resets the
// latch, and only after the latch has become the cause of a stop and the pin is seen inactive. In the RTL the latch
// needs no clock, so it also catches a pulse between two clock edges; that has a test of its own. Not thread-safe; no
// errors are reported.
#pragma once

namespace trammel::model {

class EmergencyStop {
 public:
  struct Inputs {
    bool pin = false;
    bool clear = false;  // event: a one was written to FAULT.emergency_stop
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    bool latched = false;
    bool pin_last = false;  // level of the pin one clock ago
    bool pin_seen = false;  // level of the pin two clocks ago
    bool latch_last = false;
    bool latch_seen = false;
    bool operator==(const State& o) const {
      return latched == o.latched && pin_last == o.pin_last && pin_seen == o.pin_seen && latch_last == o.latch_last &&
             latch_seen == o.latch_seen;
    }
  };

  // `level`: strap, the level at the pin that means stop.
  explicit EmergencyStop(bool level = true) : level_(level) {}

  // Reset, with this level at the pin.
  void reset(bool pin) {
    state_ = {};
    state_.latched = pin == level_;
  }
  // One rising edge.
  void clock(const Inputs& in) { state_ = next(in); }

  const State& state() const { return state_; }
  State& state() { return state_; }
  bool latched() const { return state_.latched; }
  // True if the cause of a stop is active; `clear`: a clear comes in this clock.
  bool stops(bool clear) const { return state_.latch_seen && !clears(clear); }
  // True if clocks with these inputs change nothing, however many pass.
  bool rests(const Inputs& in) const { return next(in) == state_; }

 private:
  bool clears(bool clear) const { return clear && state_.latch_seen && state_.pin_seen != level_; }

  State next(const Inputs& in) const {
    const bool pressed = in.pin == level_;
    State s;
    s.pin_last = in.pin;
    s.pin_seen = state_.pin_last;
    s.latched = pressed || (state_.latched && !clears(in.clear));
    s.latch_last = (pressed || state_.latched) && !clears(in.clear);
    s.latch_seen = state_.latch_last && !clears(in.clear);
    return s;
  }

  bool level_;
  State state_;
};

}  // namespace trammel::model
