// Golden model of the buttons. The hold begins in the clock after feed hold becomes active. It ends when cycle start
// is pressed while feed hold is not active. Not thread-safe; no errors are reported.
#pragma once

#include "trammel/model/buses.hpp"

namespace trammel::model {

class ButtonHold {
 public:
  using Inputs = InputRoles;
  // All that the next clock() depends on besides its inputs.
  struct State {
    bool cycle_start = true;  // level in the last clock; a press is a rising edge
    bool hold = false;
  };

  // One rising edge.
  void clock(const InputRoles& in) {
    const bool pressed = in.cycle_start && !state_.cycle_start;
    if (in.feed_hold)
      state_.hold = true;
    else if (pressed)
      state_.hold = false;
    state_.cycle_start = in.cycle_start;
  }

  const State& state() const { return state_; }
  State& state() { return state_; }
  bool hold() const { return state_.hold; }

 private:
  State state_;
};

}  // namespace trammel::model
