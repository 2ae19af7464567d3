// Golden model of the probe: what becomes of a PROBE from its decoding to PROBE_END.
//
// Off -> Armed (its input was not tripped) -> Ramp (the edge) -> Dropping (at rest) -> Off (PROBE_END is over, which
// waits until the host has cleared the edge). An input that is tripped at first goes from Off to Dropping. Everything
// that comes in clock c shows at c+1, but for trips() and taken(), which are of the clock itself. Not thread-safe; no
// errors are reported.
#pragma once

#include <cstdint>

#include "trammel/model/buses.hpp"

namespace trammel::model {

class Probe {
 public:
  struct Inputs {
    bool cut = false;
    std::uint16_t levels = 0;
    bool waits = false;     // a PROBE is decoded and no path runs
    bool ends = false;      // PROBE_END has begun
    bool at_rest = false;   // the ratio is 0
    bool stopping = false;  // a fault's ramp
    bool clear = false;     // event: CONTROL.probe_clear
    LoadWord load;
  };
  // Clocks without a path from the first one in which a PROBE waits to the one that takes it.
  static constexpr unsigned kSettle = 8;

  // One rising edge.
  void clock(const Inputs& in) {
    const bool edge = edges(in);
    const bool take = takes(in);
    const bool tripped_already = take && met(in.levels);
    const bool over = in.ends && !probed_;
    halt_ = false;
    if (in.clear) probed_ = missed_ = false;
    if (take) missed_ = false;
    if (edge || tripped_already) probed_ = true;
    step(in, edge, take, over);
    if (tripped_already) {
      state_ = State::Dropping;
      halt_ = true;
    }
    if (in.cut) {
      state_ = State::Off;
      halt_ = false;
    }
    waited_ = in.waits ? waited_ + 1 : 0;
    if (take) armed_for_ = condition_;
    if (in.load.to(load_target::kCommand)) condition_ = static_cast<std::uint8_t>(in.load.word & 0x3F);
  }

  // The condition decoded last is met.
  bool met(std::uint16_t levels) const { return meets(condition_, levels); }
  // The PROBE is taken in this clock.
  bool takes(const Inputs& in) const {
    const bool free = state_ == State::Off || (state_ == State::Armed && !edges(in));
    return in.waits && waited_ + 1 >= kSettle && free && !in.stopping && !in.cut;
  }
  // A snapshot is wanted.
  bool trips(const Inputs& in) const { return edges(in) || (takes(in) && met(in.levels)); }
  // PROBE_END must wait.
  bool stays(const Inputs& in) const {
    return edges(in) || state_ == State::Ramp || (state_ == State::Dropping && probed_);
  }
  bool holds() const { return state_ == State::Ramp; }
  bool halt() const { return halt_; }  // event: what runs ends here
  bool drops() const { return state_ == State::Dropping; }
  bool busy() const { return state_ != State::Off; }
  bool probed() const { return probed_; }
  bool missed() const { return missed_; }

  // With these inputs clock() changes nothing.
  bool quiet(const Inputs& in) const {
    const bool moves = (state_ == State::Armed && (edges(in) || in.ends)) || (state_ == State::Ramp && in.at_rest) ||
                       (state_ == State::Dropping && in.ends && !probed_);
    const bool settles = in.waits ? takes(in) || waited_ < kSettle : waited_ != 0;
    return !in.cut && !in.clear && !halt_ && !moves && !settles && !in.load.valid;
  }

 private:
  enum class State : std::uint8_t { Off, Armed, Ramp, Dropping };

  static bool meets(std::uint8_t condition, std::uint16_t levels) {
    constexpr unsigned kInputBits = 5;  // the number of an input; one that the card lacks stays at 0
    const std::uint32_t input = condition & ((1U << kInputBits) - 1);
    return (std::uint32_t{levels} >> input & 1) == condition >> kInputBits;
  }
  bool edges(const Inputs& in) const {
    return state_ == State::Armed && meets(armed_for_, in.levels) && !in.stopping && !in.cut;
  }
  void step(const Inputs& in, bool edge, bool take, bool over) {
    switch (state_) {
      case State::Off:
      case State::Armed:
        if (edge) {
          state_ = State::Ramp;
        } else if (take) {
          state_ = State::Armed;
        } else if (in.ends && state_ == State::Armed) {
          state_ = State::Off;
          missed_ = true;
        }
        break;
      case State::Ramp:
        halt_ = in.at_rest;
        if (in.at_rest) state_ = State::Dropping;
        break;
      case State::Dropping:
        if (over) state_ = State::Off;
        break;
    }
  }

  State state_ = State::Off;
  std::uint8_t condition_ = 0;  // {level, input}, decoded last
  std::uint8_t armed_for_ = 0;
  unsigned waited_ = 0;  // clocks
  bool halt_ = false;
  bool probed_ = false;
  bool missed_ = false;
};

}  // namespace trammel::model
