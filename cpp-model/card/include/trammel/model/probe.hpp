// Golden model of the probe: what a PROBE does from its decoding to PROBE_END.
//
// Off -> Armed (its input was not tripped) -> Ramp (the edge) -> Dropping (at rest) -> Off (PROBE_END has ended; it
// waits until the host has cleared the edge). An input that is tripped at first leads from Off to Dropping. Inputs of
// clock c take effect at c+1, except in trips(), touches() and takes(), which belong to clock c itself. On a card
// with captures the first touch requests the snapshot, before the filter confirms it; a trip without a touch requests
// it one clock later. Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>

#include "trammel/model/buses.hpp"

namespace trammel::model {

class Probe {
 public:
  struct Inputs {
    bool cut = false;
    std::uint32_t levels = 0;
    std::uint32_t raw = 0;    // levels before the filters
    std::uint32_t quiet = 0;  // inputs that have kept their levels for a filter's length
    bool waits = false;       // a PROBE is decoded and no path runs
    bool ends = false;        // PROBE_END has begun
    bool at_rest = false;     // the ratio is 0
    bool stopping = false;    // the ramp of a fault is under way
    bool clear = false;       // event: CONTROL.probe_clear
    LoadWord load;
  };
  enum class Mode : std::uint8_t { Off, Armed, Ramp, Dropping };
  // All that the next clock() depends on besides its inputs.
  struct State {
    Mode mode = Mode::Off;
    std::uint8_t condition = 0;  // {level, input} of the condition decoded last
    std::uint8_t armed_for = 0;  // {level, input} of the PROBE in force
    unsigned waited = 0;         // clocks for which a PROBE has waited
    bool halt = false;
    bool probed = false;
    bool missed = false;
    bool touched = false;  // the snapshot of the touch is taken
    bool before = false;   // one clock ago: armed, and the raw input at the level that trips
    bool late = false;     // a trip one clock ago requests its snapshot
  };
  // Clocks without a path from the first one in which a PROBE waits to the one that takes it.
  static constexpr unsigned kSettle = 8;

  explicit Probe(bool first_touch = false) : first_touch_(first_touch) {}

  // One rising edge.
  void clock(const Inputs& in) {
    const bool late = late_after(in);
    const bool before = before_after(in);
    state_.touched = touched_after(in);
    state_.late = late;
    state_.before = before;
    const bool edge = edges(in);
    const bool take = takes(in) && !edge;
    const bool tripped_already = take && met(in.levels);
    const bool over = in.ends && !state_.probed;
    state_.halt = false;
    if (in.clear) state_.probed = state_.missed = false;
    if (take) state_.missed = false;
    if (edge || tripped_already) state_.probed = true;
    step(in, edge, take, over);
    if (tripped_already) {
      state_.mode = Mode::Dropping;
      state_.halt = true;
    }
    if (in.cut) {
      state_.mode = Mode::Off;
      state_.halt = false;
    }
    state_.waited = in.waits ? state_.waited + 1 : 0;
    if (take) state_.armed_for = state_.condition;
    if (in.load.to(load_target::kCommand)) state_.condition = static_cast<std::uint8_t>(in.load.word & 0x3F);
  }

  const State& state() const { return state_; }
  State& state() { return state_; }

  // True if the condition decoded last is met.
  bool met(std::uint32_t levels) const { return meets(state_.condition, levels); }
  // True if the PROBE is taken in this clock. If the edge of the previous PROBE comes in the same clock, it is
  // dropped.
  bool takes(const Inputs& in) const {
    const bool free = state_.mode == Mode::Off || state_.mode == Mode::Armed;
    return in.waits && state_.waited + 1 >= kSettle && free && !in.stopping && !in.cut;
  }
  // True if a snapshot is requested. None is requested in the clock of a cut, whose own snapshot is under way.
  bool asks(const Inputs& in) const { return touches(in) || (state_.late && !in.cut); }
  // True if the probe trips.
  bool trips(const Inputs& in) const { return edges(in) || (takes(in) && met(in.levels)); }
  // True if PROBE_END must wait.
  bool stays(const Inputs& in) const {
    return edges(in) || state_.mode == Mode::Ramp || (state_.mode == Mode::Dropping && state_.probed);
  }
  bool holds() const { return state_.mode == Mode::Ramp; }
  bool halt() const { return state_.halt; }  // event: the path and the piece under way end here
  bool drops() const { return state_.mode == Mode::Dropping; }
  bool busy() const { return state_.mode != Mode::Off; }
  bool probed() const { return state_.probed; }
  bool missed() const { return state_.missed; }

  // True at a touch, the first one since the PROBE or since the input was quiet.
  bool touches(const Inputs& in) const {
    return first_touch_ && state_.mode == Mode::Armed && meets(state_.armed_for, in.raw) &&
           (!state_.touched || quiet(in)) && !in.stopping && !in.cut;
  }
  bool before_after(const Inputs& in) const {
    return first_touch_ && state_.mode == Mode::Armed && meets(state_.armed_for, in.raw);
  }
  bool late_after(const Inputs& in) const { return trips(in) && !state_.touched && !touches(in) && !in.cut; }
  bool touched_after(const Inputs& in) const {
    if (state_.mode != Mode::Armed || edges(in) || takes(in) || in.cut) return false;
    return touches(in) || (state_.touched && !quiet(in));
  }
  bool edges(const Inputs& in) const {
    return state_.mode == Mode::Armed && meets(state_.armed_for, in.levels) && !in.stopping && !in.cut;
  }

 private:
  // Excludes the clock in which the filter passes the touch: the filter calls the input quiet then.
  bool quiet(const Inputs& in) const { return (in.quiet >> (state_.armed_for & 0x1F) & 1) != 0 && !state_.before; }
  static bool meets(std::uint8_t condition, std::uint32_t levels) {
    constexpr unsigned kInputBits = 5;  // bits of an input number; an absent input stays at 0
    const std::uint32_t input = condition & ((1U << kInputBits) - 1);
    return (std::uint32_t{levels} >> input & 1) == condition >> kInputBits;
  }
  void step(const Inputs& in, bool edge, bool take, bool over) {
    switch (state_.mode) {
      case Mode::Off:
      case Mode::Armed:
        if (edge) {
          state_.mode = Mode::Ramp;
        } else if (take) {
          state_.mode = Mode::Armed;
        } else if (in.ends && state_.mode == Mode::Armed) {
          state_.mode = Mode::Off;
          state_.missed = true;
        }
        break;
      case Mode::Ramp:
        state_.halt = in.at_rest;
        if (in.at_rest) state_.mode = Mode::Dropping;
        break;
      case Mode::Dropping:
        if (over) state_.mode = Mode::Off;
        break;
    }
  }

  bool first_touch_;
  State state_;
};

}  // namespace trammel::model
