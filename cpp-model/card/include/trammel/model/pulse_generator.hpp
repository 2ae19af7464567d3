// Golden model of the pulse generator: after k ticks of a line the axis stands at floor(1/2 + k * increment / 2^40)
// pulses from the line's start. Plain 64-bit arithmetic; the card's fixed latencies are delay lines.
//
// Source: Zeng, Zhang & Huang, "A New Linear Interpolation Algorithm" (one-shot velocity), with the phase starting at
// one half. Not thread-safe; no errors are reported: the rules below are the caller's.
//
// A chord takes the next increment and keeps the phase: the sum of increments goes on where it is.
//
// Rules, the card's own: swaps and chords at least 3 clocks apart; no load in the 2 clocks after either; no swap, no
// chord and no count load while `live`; a count is used up by its line and loaded anew for the next.
#pragma once

#include <cstdint>

#include "trammel/model/wide.hpp"

namespace trammel::model {

class PulseGenerator {
 public:
  static constexpr int kFractionBits = 40;
  static constexpr std::uint64_t kOne = std::uint64_t{1} << kFractionBits;  // one pulse a tick, the largest increment

  struct Inputs {
    bool clear = false;  // ends the line, drops the steps in flight; wins over tick and swap in its clock
    bool tick = false;
    bool swap = false;            // the next line begins with the tick of the following clock
    bool active = false;          // sampled with swap: 0 makes no steps
    bool counted = false;         // sampled with swap: the count ends the line
    bool mirror = false;          // sampled with swap: backwards exactly mirrors forwards
    bool load_increment = false;  // shifts `word` in; 3 halfwords, lowest first, 42 bits signed, 2^-40 pulses a tick
    bool load_count = false;      // shifts `word` in; 2 halfwords, lowest first, pulses
    std::uint16_t word = 0;
    bool chord = false;  // as a swap, of the increment alone: the phase goes on, and so does whether the axis steps
  };
  struct Outputs {
    bool step = false;  // 3 clocks after the tick that made it
    bool dir = false;   // 1 = negative; of the last step
    bool live = false;  // a counted axis that has not made its count
  };

  // One rising edge.
  void clock(const Inputs& in) {
    if (in.load_increment | in.load_count) load(in);
    if (in.clear) {
      clear();
      return;
    }
    const unsigned event = pipe_ & 0xF;
    pipe_ >>= 4;
    if (event != 0)
      arrive(event);
    else
      out_.step = false;
    if (in.tick) tick();
    if (in.swap) swap(in);
    if (in.chord) take_increment();
  }

  const Outputs& outputs() const { return out_; }

  // Nothing is in flight: without tick, swap, chord, load or clear, clock() changes nothing any more.
  bool quiet() const { return pipe_ == 0 && !out_.step; }

  // n clocks without tick, swap, chord, load or clear; only when quiet().
  void advance(std::uint64_t) {}

  // n ticks that make no step, n <= silent_ticks(); only when quiet().
  void silent_ticks(std::uint64_t n) {
    const auto sum = static_cast<std::uint64_t>(phase_) + n * static_cast<std::uint64_t>(increment_);
    phase_ = static_cast<std::int64_t>(sum & static_cast<std::uint64_t>(kMask));
  }

  // The tick after silent_ticks() silent ones: true when its step is backwards. The step is not in flight.
  bool step_at_once() {
    phase_ += increment_;
    const bool backwards = phase_ < 0;
    phase_ &= kMask;
    return backwards;
  }

  // A step of a tick taken `clocks_ago` clocks ago (0: in the last one), for the outputs alone.
  void place_step(std::uint64_t clocks_ago, bool backwards) {
    const unsigned event = backwards ? kStep | kBackwards : kStep;
    if (clocks_ago == 0) pipe_ |= event << 4;
    if (clocks_ago == 1) pipe_ |= event;
    if (clocks_ago == 2) out_.step = true;
    if (clocks_ago >= 2) out_.dir = backwards;
  }

  // How many ticks in a row would make no step; the largest number there is where none ever would.
  std::uint64_t silent_ticks() const {
    if (!open_ || increment_ == 0) return UINT64_MAX;
    if (increment_ > 0) return static_cast<std::uint64_t>((kMask - phase_) / increment_);
    return static_cast<std::uint64_t>(phase_ / -increment_);
  }

  // For increments that are not negative (a prescaler's). Ticks up to the one that makes the `steps`-th step from now,
  // that included; the largest number there is where there is none, or that far away.
  std::uint64_t ticks_until(std::uint64_t steps) const {
    constexpr unsigned kFirst = 24;
    if (!open_ || increment_ <= 0 || steps >> kFractionBits != 0) return UINT64_MAX;
    // ceil((steps * 2^40 - phase) / increment), the quotient in two parts.
    const auto by = static_cast<std::uint64_t>(increment_);
    const std::uint64_t first = (steps << kFirst) / by;
    const std::uint64_t rest = (steps << kFirst) % by << (kFractionBits - kFirst);
    if (first >> 46 != 0) return UINT64_MAX;
    const std::int64_t last = static_cast<std::int64_t>(rest % by) - phase_;
    const std::int64_t more = last > 0 ? 1 : -(-last / increment_);
    return (first << (kFractionBits - kFirst)) + rest / by + static_cast<std::uint64_t>(more);
  }
  // n ticks at once; how many steps they make. None of these is in flight.
  std::uint64_t pass(std::uint64_t n) {
    const uint128 sum =
        uint128{n} * uint128{static_cast<std::uint64_t>(increment_)} + uint128{static_cast<std::uint64_t>(phase_)};
    phase_ = static_cast<std::int64_t>(static_cast<std::uint64_t>(sum) & static_cast<std::uint64_t>(kMask));
    return static_cast<std::uint64_t>(sum >> kFractionBits);
  }

  // At most a pulse a tick, either way; else ticks go one by one.
  bool within_a_pulse() const { return increment_ <= kMask + 1 && increment_ >= -kMask - 1; }

  std::int64_t increment() const { return increment_; }  // of the present line, 2^-40 pulses a tick

 private:
  static constexpr std::int64_t kMask = static_cast<std::int64_t>(kOne - 1);
  // An event on its way to the outputs, 4 bits for each clock, the nearest lowest.
  static constexpr unsigned kStep = 1;
  static constexpr unsigned kBackwards = 2;
  static constexpr unsigned kEnd = 4;  // the count is made

  void tick() {
    phase_ += increment_;
    // A carry or borrow of one; beyond a pulse a tick, which is the host's fault, two at once are none.
    const bool crossed = (phase_ >> kFractionBits & 1) != 0;
    if (crossed && open_) {
      unsigned event = phase_ < 0 ? kStep | kBackwards : kStep;
      if (counted_ && --count_ == 0) {
        event |= kEnd;
        open_ = false;  // for good: the next line's count may be loaded after it
      }
      pipe_ |= event << 4;
    }
    phase_ &= kMask;
  }

  void swap(const Inputs& in) {
    take_increment();
    phase_ = static_cast<std::int64_t>(kOne / 2) - (in.mirror && increment_ < 0 ? 1 : 0);
    open_ = in.active;
    counted_ = in.counted && in.active;
    out_.live = counted_;
    if (counted_ && count_ == 0) {
      pipe_ |= kEnd << 4;
      open_ = false;
    }
  }

  // Sign-extended from bit 41.
  void take_increment() { increment_ = static_cast<std::int64_t>(next_ << 22) >> 22; }

  void arrive(unsigned event) {
    out_.step = (event & kStep) != 0;
    if (out_.step) out_.dir = (event & kBackwards) != 0;
    if ((event & kEnd) != 0) out_.live = false;
  }

  void load(const Inputs& in) {
    if (in.load_increment) next_ = (next_ >> 16) | (std::uint64_t{in.word} << 32);
    if (in.load_count) count_ = (count_ >> 16) | (std::uint32_t{in.word} << 16);
  }

  void clear() {
    pipe_ = 0;
    open_ = false;
    counted_ = false;
    out_.step = false;
    out_.live = false;
  }

  std::int64_t phase_ = 0;      // 0..2^40-1, 2^-40 pulses
  std::int64_t increment_ = 0;  // -2^40..2^40, up to twice as much where an arc's fields contradict each other
  std::uint64_t next_ = 0;      // 48 bits shifted in
  std::uint32_t count_ = 0;     // steps left
  std::uint32_t pipe_ = 0;
  bool open_ = false;
  bool counted_ = false;
  Outputs out_;
};

}  // namespace trammel::model
