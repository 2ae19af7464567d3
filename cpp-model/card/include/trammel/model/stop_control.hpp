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
    bool abort = false;            // event
    std::uint32_t clear = 0;       // event: ones written to FAULT
    bool at_rest = false;          // the ratio is 0
    bool moving = false;           // pieces are giving ticks
    bool fixed = false;            // the present one is fixed
    bool underrun = false;         // what is queued ends: neither a fault nor a cut
    bool probe = false;            // a probe has tripped: likewise
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

  // One rising edge.
  void clock(const Inputs& in) {
    const std::uint32_t events = in.step_fault | (in.mismatch ? card_map::field::kFaultTickMismatch : 0) |
                                 (in.incomplete ? card_map::field::kFaultPathIncomplete : 0) |
                                 (in.missing ? card_map::field::kFaultMissingPeriod : 0);
    const bool at_once = (events & ~reaction_) != 0;
    made_to_hold_ = in.underrun || in.probe;
    hold_stays_ = stays(in.moving, in.at_rest);
    out_.hold = host_holds(in.fixed) || made_to_hold_ || state_ == State::Ramp;
    out_.closed = out_.fault != 0 || state_ != State::Run;
    out_.cut = in.abort;
    out_.stop = state_ == State::Run && events != 0;
    switch (state_) {
      case State::Run:
        if (at_once) halt();
        if (events != 0 && !at_once) state_ = State::Ramp;
        break;
      case State::Ramp:
        if (at_once || in.at_rest || in.abort) halt();
        break;
      case State::Stopped:
        if (out_.fault == 0 && events == 0) state_ = State::Run;
        break;
    }
    out_.fault = (out_.fault & ~in.clear) | events;
    out_.stopping = state_ == State::Ramp;
    if (in.setting.set) set(in.setting);
  }

  const Outputs& outputs() const { return out_; }
  bool stopped() const { return state_ == State::Stopped; }
  bool made_to_hold() const { return made_to_hold_; }  // as of the last clock: by under-run or probe

  // Without an event, a setting, an abort, a clear or a change of made_to_hold(), clock() changes nothing while these
  // stay; where no hold is asked for, whatever they do.
  bool quiet(bool moving, bool fixed, bool at_rest) const {
    const bool same = stays(moving, at_rest) == hold_stays_ && out_.hold == (host_holds(fixed) || made_to_hold_);
    const bool settled = same && out_.closed == (out_.fault != 0 || state_ != State::Run);
    return settled && !out_.cut && !out_.stop &&
           (state_ == State::Run || (state_ == State::Stopped && out_.fault != 0));
  }

 private:
  enum class State : std::uint8_t { Run, Ramp, Stopped };

  // A HOLD waits for the end of fixed pieces, unless it found nothing moving, or the time base at rest, since it was
  // set.
  bool stays(bool moving, bool at_rest) const { return hold_ && (hold_stays_ || !moving || at_rest); }
  bool host_holds(bool fixed) const { return hold_ && (hold_stays_ || !fixed); }

  void halt() {
    state_ = State::Stopped;
    out_.cut = true;
  }

  void set(const Setting& setting) {
    if (setting.address == card_map::reg::kHold) hold_ = setting.data != 0;
    if (setting.address == card_map::reg::kStopReaction) reaction_ = setting.data;
  }

  State state_ = State::Run;
  bool hold_ = false;
  bool hold_stays_ = false;
  bool made_to_hold_ = false;
  std::uint32_t reaction_ = 0;
  Outputs out_;
};

}  // namespace trammel::model
