// Golden model of the stop control: every cause of a stop, in one place. FAULT remembers causes; the card is in RUN,
// ramps to a stop (RAMP), or stands until FAULT is clear (STOPPED). A cut drops queues, paths and everything decoded.
//
// What comes in clock c shows at c+1: fault, cut, stop, stopping. hold and closed follow the state a clock later.
// Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class StopControl {
 public:
  struct Inputs {
    std::uint32_t step_fault = 0;  // events, by axis
    bool mismatch = false;         // event
    bool incomplete = false;       // event
    bool missing = false;          // event: of position streaming
    bool expired = false;          // level: the watchdog has expired
    StopCauses causes;             // from the machine's inputs
    bool abort = false;            // event
    std::uint32_t clear = 0;       // event: ones written to FAULT
    bool at_rest = false;          // the ratio is 0
    bool moving = false;           // pieces are giving ticks
    bool fixed = false;            // the present one is fixed
    bool underrun = false;         // what is queued ends: neither a fault nor a cut
    bool probe = false;            // a probe has tripped: likewise
    bool button = false;           // the feed hold button holds, as HOLD does
    Setting setting;               // HOLD, STOP_REACTION
  };
  struct Outputs {
    std::uint32_t fault = 0;
    bool hold = false;      // of the time base
    bool cut = false;       // event
    bool stop = false;      // event: the first cause of a stop
    bool closed = false;    // neither command nor START is taken
    bool stopping = false;  // the ramp to a stop
  };
  enum class Mode : std::uint8_t { Run, Ramp, Stopped };
  // All that the next clock() depends on beside its inputs.
  struct State {
    Mode mode = Mode::Run;
    bool hold = false;  // the register
    bool hold_stays = false;
    bool made_to_hold = false;
    std::uint32_t reaction = card_map::field::kStopReactionDriveFault | card_map::field::kStopReactionWatchdog |
                             card_map::field::kStopReactionProbe | card_map::field::kStopReactionToolSetter;
    Outputs out;
  };

  // One rising edge.
  void clock(const Inputs& in) {
    const std::uint32_t events = in.step_fault | (in.mismatch ? card_map::field::kFaultTickMismatch : 0) |
                                 (in.incomplete ? card_map::field::kFaultPathIncomplete : 0) |
                                 (in.missing ? card_map::field::kFaultMissingPeriod : 0) |
                                 (in.expired ? card_map::field::kFaultWatchdog : 0) | bits_of(in.causes);
    const bool at_once = (events & ~state_.reaction) != 0 || in.causes.beyond;
    state_.made_to_hold = in.underrun || in.probe;
    state_.hold_stays = stays(in);
    state_.out.hold = asked_hold(in) || state_.made_to_hold || state_.mode == Mode::Ramp;
    state_.out.closed = state_.out.fault != 0 || state_.mode != Mode::Run;
    state_.out.cut = in.abort;
    state_.out.stop = state_.mode == Mode::Run && events != 0;
    switch (state_.mode) {
      case Mode::Run:
        if (at_once) halt();
        if (events != 0 && !at_once) state_.mode = Mode::Ramp;
        break;
      case Mode::Ramp:
        if (at_once || in.at_rest || in.abort) halt();
        break;
      case Mode::Stopped:
        if (state_.out.fault == 0 && events == 0) state_.mode = Mode::Run;
        break;
    }
    state_.out.fault = (state_.out.fault & ~in.clear) | events;
    state_.out.stopping = state_.mode == Mode::Ramp;
    if (in.setting.set) set(in.setting);
  }

  const Outputs& outputs() const { return state_.out; }
  const State& state() const { return state_; }
  State& state() { return state_; }
  bool stopped() const { return state_.mode == Mode::Stopped; }
  bool made_to_hold() const { return state_.made_to_hold; }  // as of the last clock: by under-run or probe

  // A hold, of HOLD or the button, waits for the end of fixed pieces, unless it found nothing moving, or the time base
  // at rest, since it was set.
  bool stays(const Inputs& in) const { return asked(in) && (state_.hold_stays || !in.moving || in.at_rest); }
  bool asked_hold(const Inputs& in) const { return asked(in) && (state_.hold_stays || !in.fixed); }

 private:
  bool asked(const Inputs& in) const { return state_.hold || in.button; }

  static std::uint32_t bits_of(const StopCauses& causes) {
    return (causes.limit ? card_map::field::kFaultLimit : 0) |
           (causes.drive_fault ? card_map::field::kFaultDriveFault : 0) |
           (causes.probe ? card_map::field::kFaultProbe : 0) |
           (causes.tool_setter ? card_map::field::kFaultToolSetter : 0);
  }

  void halt() {
    state_.mode = Mode::Stopped;
    state_.out.cut = true;
  }

  void set(const Setting& setting) {
    if (setting.address == card_map::reg::kHold) state_.hold = setting.data != 0;
    if (setting.address == card_map::reg::kStopReaction) state_.reaction = setting.data;
  }

  State state_;
};

}  // namespace trammel::model
