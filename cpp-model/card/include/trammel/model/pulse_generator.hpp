// Golden model of the pulse generator: after k ticks of a line the axis is floor(1/2 + k * increment / 2^40) pulses
// from the start of the line. Plain 64-bit arithmetic; delay lines model the card's fixed latencies.
//
// Source: Zeng, Zhang & Huang, "A New Linear Interpolation Algorithm" (one-shot velocity), with an initial phase of
// one half. Not thread-safe; no errors are reported: the caller must keep the rules below.
//
// A chord takes the next increment and keeps the phase, so the sum of increments continues.
//
// Rules, which the card keeps: swaps and chords are at least 3 clocks apart; no load in the 2 clocks after either; no
// swap, no chord and no count load while `live`; a line uses up its count, so each counted line needs a new one.
#pragma once

#include <cstdint>

#include "trammel/model/wide.hpp"

namespace trammel::model {

class PulseGenerator {
 public:
  static constexpr int kFractionBits = 40;
  static constexpr std::uint64_t kOne = std::uint64_t{1} << kFractionBits;  // one pulse per tick, the largest increment
  static constexpr std::int64_t kMask = static_cast<std::int64_t>(kOne - 1);
  // An event on its way to the outputs: 4 bits per clock, the nearest event in the lowest bits.
  static constexpr unsigned kStep = 1;
  static constexpr unsigned kBackwards = 2;
  static constexpr unsigned kEnd = 4;  // the count is complete

  struct Inputs {
    bool clear = false;  // ends the line, drops the steps in flight; wins over tick and swap in its clock
    bool tick = false;
    bool swap = false;            // the next line begins with the tick of the following clock
    bool active = false;          // sampled with swap: 0 makes no steps
    bool counted = false;         // sampled with swap: the count ends the line
    bool mirror = false;          // sampled with swap: backwards exactly mirrors forwards
    bool load_increment = false;  // shifts `word` in; 3 halfwords, lowest first, 42 bits signed, 2^-40 pulses per tick
    bool load_count = false;      // shifts `word` in; 2 halfwords, lowest first, pulses
    std::uint16_t word = 0;
    bool chord = false;  // swaps the increment only: neither the phase nor whether the axis steps changes
  };
  struct Outputs {
    bool step = false;  // 3 clocks after the tick that made it
    bool dir = false;   // direction of the last step, 1 = negative
    bool live = false;  // a counted axis has not completed its count
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    std::int64_t phase = 0;      // 0..2^40-1, 2^-40 pulses
    std::int64_t increment = 0;  // -2^40..2^40, up to twice as much where an arc's fields contradict each other
    std::uint64_t next = 0;      // 48 bits shifted in
    std::uint32_t count = 0;     // steps left
    std::uint32_t pipe = 0;
    bool open = false;
    bool counted = false;
    Outputs out;
  };

  // One rising edge.
  void clock(const Inputs& in) {
    if (in.load_increment | in.load_count) load(in);
    if (in.clear) {
      clear();
      return;
    }
    const unsigned event = state_.pipe & 0xF;
    state_.pipe >>= 4;
    if (event != 0)
      arrive(event);
    else
      state_.out.step = false;
    if (in.tick) tick();
    if (in.swap) swap(in);
    if (in.chord) take_increment();
  }

  const Outputs& outputs() const { return state_.out; }
  const State& state() const { return state_; }
  State& state() { return state_; }

 private:
  void tick() {
    state_.phase += state_.increment;
    // A carry or borrow of one. Two at once, beyond one pulse per tick, are an error of the host and make no step.
    const bool crossed = (state_.phase >> kFractionBits & 1) != 0;
    if (crossed && state_.open) {
      unsigned event = state_.phase < 0 ? kStep | kBackwards : kStep;
      if (state_.counted && --state_.count == 0) {
        event |= kEnd;
        state_.open = false;  // until the next swap; the next line's count may be loaded after it
      }
      state_.pipe |= event << 4;
    }
    state_.phase &= kMask;
  }

  void swap(const Inputs& in) {
    take_increment();
    state_.phase = static_cast<std::int64_t>(kOne / 2) - (in.mirror && state_.increment < 0 ? 1 : 0);
    state_.open = in.active;
    state_.counted = in.counted && in.active;
    state_.out.live = state_.counted;
    if (state_.counted && state_.count == 0) {
      state_.pipe |= kEnd << 4;
      state_.open = false;
    }
  }

  // Sign-extended from bit 41.
  void take_increment() { state_.increment = static_cast<std::int64_t>(state_.next << 22) >> 22; }

  void arrive(unsigned event) {
    state_.out.step = (event & kStep) != 0;
    if (state_.out.step) state_.out.dir = (event & kBackwards) != 0;
    if ((event & kEnd) != 0) state_.out.live = false;
  }

  void load(const Inputs& in) {
    if (in.load_increment) state_.next = (state_.next >> 16) | (std::uint64_t{in.word} << 32);
    if (in.load_count) state_.count = (state_.count >> 16) | (std::uint32_t{in.word} << 16);
  }

  void clear() {
    state_.pipe = 0;
    state_.open = false;
    state_.counted = false;
    state_.out.step = false;
    state_.out.live = false;
  }

  State state_;
};

}  // namespace trammel::model
