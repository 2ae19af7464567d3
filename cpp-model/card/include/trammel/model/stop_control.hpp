// Golden model of the stop control: every cause of a stop, in one place. FAULT stores the causes. The card runs
// (RUN), ramps to a stop (RAMP), takes no more ticks and waits until everything on its way has reached the pins
// (CLOSING), or is stopped until FAULT is clear (STOPPED). A cut drops queues, paths and all decoded commands; it
// ends CLOSING, or follows an abort.
//
// Inputs of clock c take effect at c+1 in fault, cut, stop and stopping; hold and closed follow the mode one clock
// later. Not thread-safe; no errors are reported.
#pragma once

#include <algorithm>
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
    bool missing = false;          // event: a period is missing in position streaming
    bool expired = false;          // level: the watchdog has expired
    bool link_lost = false;        // level
    bool emergency = false;        // level: the emergency stop
    StopCauses causes;             // from the machine's inputs
    bool soft_limit = false;       // event: a pulse beyond one
    bool abort = false;            // event
    std::uint32_t clear = 0;       // event: ones written to FAULT
    bool at_rest = false;          // the ratio is 0
    bool moving = false;           // pieces are giving ticks
    bool fixed = false;            // the piece under way is of class fixed
    bool underrun = false;         // an under-run hold, which is neither a fault nor a cut
    bool probe = false;            // a tripped probe holds, which is neither a fault nor a cut
    bool button = false;           // the feed hold button holds, like HOLD
    bool take = false;             // a tick is taken in this clock
    bool quiet = true;             // no path tick is on its way to an engine, and none makes a step
    bool pulses = false;           // an axis is busy
    bool busy = false;             // something runs or is queued
    Setting setting;               // HOLD, STOP_REACTION
  };
  struct Outputs {
    std::uint32_t fault = 0;
    bool hold = false;      // the time base must hold
    bool cut = false;       // event
    bool stop = false;      // event: the first cause of a stop
    bool closed = false;    // neither commands nor START are accepted
    bool stopping = false;  // a ramp or the closing is under way
  };
  enum class Mode : std::uint8_t { Run, Ramp, Closing, Stopped };
  // The card is settled after this many clocks in which nothing moved.
  static constexpr unsigned kSettleClocks = 31;
  // All that the next clock() depends on besides its inputs.
  struct State {
    Mode mode = Mode::Run;
    unsigned settled = 0;  // clocks in which nothing moved, up to kSettleClocks
    bool hold = false;     // the register HOLD
    bool hold_stays = false;
    bool made_to_hold = false;
    std::uint32_t reaction = card_map::field::kStopReactionDriveFault | card_map::field::kStopReactionWatchdog |
                             card_map::field::kStopReactionProbe | card_map::field::kStopReactionToolSetter |
                             card_map::field::kStopReactionSoftLimit | card_map::field::kStopReactionLinkLoss;
    Outputs out;
  };

  // One rising edge.
  void clock(const Inputs& in) {
    const std::uint32_t events = causes_of(in);
    const bool at_once = (events & ~state_.reaction) != 0 || in.causes.beyond;
    state_.made_to_hold = in.underrun || in.probe;
    state_.hold_stays = stays(in);
    state_.out.hold = asked_hold(in) || state_.made_to_hold || state_.mode == Mode::Ramp || (closing() && in.at_rest);
    state_.out.closed = state_.out.fault != 0 || state_.mode != Mode::Run;
    // An abort during a fault's ramp does not cut at once: it begins CLOSING, which ends with the fault's cut.
    state_.out.cut = finished() || (in.abort && (stopped() || (state_.mode == Mode::Run && events == 0)));
    const unsigned settled = counts(in) ? std::min(state_.settled + 1, kSettleClocks) : 0;
    const Mode next = next_mode(in, events != 0, at_once);
    state_.out.stop = state_.mode == Mode::Run && events != 0;
    state_.mode = next;
    state_.settled = settled;
    state_.out.fault = (state_.out.fault & ~in.clear) | events;
    state_.out.stopping = state_.mode == Mode::Ramp || closing();
    if (in.setting.set) set(in.setting);
  }

  const Outputs& outputs() const { return state_.out; }
  const State& state() const { return state_; }
  State& state() { return state_; }
  bool stopped() const { return state_.mode == Mode::Stopped; }
  bool closing() const { return state_.mode == Mode::Closing; }
  bool shut() const { return closing() || stopped(); }  // no tick is taken
  // True if the snapshot REST is requested in this clock. It shows the next clock, that of the cut.
  bool rests(const Inputs& in) const { return finished() || (in.abort && state_.mode == Mode::Run && in.busy); }
  bool settled() const { return state_.settled == kSettleClocks; }
  // True if a cause comes in this clock, a stop is under way, or the card is stopped.
  bool caused(const Inputs& in) const { return state_.mode != Mode::Run || causes_of(in) != 0; }
  // True in a clock in which nothing moves. The first clock of a stop restarts the count.
  bool counts(const Inputs& in) const {
    return (in.at_rest || shut()) && in.quiet && !in.pulses && !in.take && !state_.out.stop;
  }
  bool made_to_hold() const { return state_.made_to_hold; }  // in the last clock, by under-run or probe

  // A hold, by HOLD or by the button, waits for the end of fixed pieces. It does not wait if, since it was set,
  // nothing was moving or the time base was at rest.
  bool stays(const Inputs& in) const { return asked(in) && (state_.hold_stays || !in.moving || in.at_rest); }
  bool asked_hold(const Inputs& in) const { return asked(in) && (state_.hold_stays || !in.fixed); }

 private:
  bool asked(const Inputs& in) const { return state_.hold || in.button; }

  static std::uint32_t causes_of(const Inputs& in) {
    return in.step_fault | (in.mismatch ? card_map::field::kFaultTickMismatch : 0) |
           (in.incomplete ? card_map::field::kFaultPathIncomplete : 0) |
           (in.missing ? card_map::field::kFaultMissingPeriod : 0) |
           (in.expired ? card_map::field::kFaultWatchdog : 0) |
           (in.emergency ? card_map::field::kFaultEmergencyStop : 0) |
           (in.link_lost ? card_map::field::kFaultLinkLoss : 0) |
           (in.soft_limit ? card_map::field::kFaultSoftLimit : 0) | bits_of(in.causes);
  }

  static std::uint32_t bits_of(const StopCauses& causes) {
    return (causes.limit ? card_map::field::kFaultLimit : 0) |
           (causes.drive_fault ? card_map::field::kFaultDriveFault : 0) |
           (causes.probe ? card_map::field::kFaultProbe : 0) |
           (causes.tool_setter ? card_map::field::kFaultToolSetter : 0);
  }

  // Nothing is on its way to the pins: the cut follows.
  bool finished() const { return closing() && settled() && !state_.out.stop; }

  Mode next_mode(const Inputs& in, bool any, bool at_once) const {
    switch (state_.mode) {
      case Mode::Run:
        if (at_once || (any && in.abort)) return Mode::Closing;
        return any ? Mode::Ramp : Mode::Run;
      case Mode::Ramp:
        return at_once || in.at_rest || in.abort ? Mode::Closing : Mode::Ramp;
      case Mode::Closing:
        return finished() ? Mode::Stopped : Mode::Closing;
      case Mode::Stopped:
        break;
    }
    return state_.out.fault == 0 && !any ? Mode::Run : Mode::Stopped;
  }

  void set(const Setting& setting) {
    if (setting.address == card_map::reg::kHold) state_.hold = setting.data != 0;
    if (setting.address == card_map::reg::kStopReaction) state_.reaction = setting.data;
  }

  State state_;
};

}  // namespace trammel::model
