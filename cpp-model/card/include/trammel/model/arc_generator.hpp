// Golden model of the arc generator (docs/developer/architecture.md): it makes a circle from chords. X and Y rotate
// in turns, half a chord apart. The displacement of a coordinate becomes the increment of its axis's pulse generator
// for the path ticks of the chord. The tests judge the distance to the true circle and the end point. No errors are
// reported; not thread-safe.
#pragma once

#include <cstdint>

#include "trammel/model/buses.hpp"

namespace trammel::model {

// The rotation alone, without clocks. The unit of X and Y is 2^(m-40) pulses: an increment counts 2^-40 pulses per
// path tick and a chord lasts 2^m ticks. The displacement per chord is therefore the increment, without scaling.
class ChordRotation {
 public:
  struct State {
    std::int64_t x = 0;          // X(0): sampled at whole chord times
    std::int64_t y = 0;          // Y(-1/2): sampled at half chord times
    std::int64_t closing_x = 0;  // added to every increment; 2^-40 pulses per path tick, 48 bits
    std::int64_t closing_y = 0;
    std::uint8_t k = 1;  // a chord turns by the angle 2 asin(2^-(k+1)); 0..31
    std::uint8_t m = 5;  // a chord lasts 2^m path ticks; below 5: no chord follows the first
    bool clockwise = false;
  };

  State state;

  // value / 2^k, rounded to the nearest, ties upwards.
  static std::int64_t turned(std::int64_t value, unsigned k) {
    return (value >> k) + (k == 0 ? 0 : value >> (k - 1) & 1);
  }

  // chord_y() makes the next chord of y from X, chord_x() that of x from Y. Each moves its coordinate and returns the
  // increment of the axis, which includes the closing increment. Callers alternate, chord_y() first.
  std::int64_t chord_y() { return move(state.y, state.clockwise ? -turn(state.x) : turn(state.x)) + state.closing_y; }
  std::int64_t chord_x() { return move(state.x, state.clockwise ? turn(state.y) : -turn(state.y)) + state.closing_x; }

 private:
  std::int64_t turn(std::int64_t from) const { return turned(from, state.k); }

  static std::int64_t move(std::int64_t& coordinate, std::int64_t by) {
    coordinate = static_cast<std::int64_t>(static_cast<std::uint64_t>(coordinate) + static_cast<std::uint64_t>(by));
    return by;
  }
};

// The clocked block. A half chord takes kHalfChord clocks, or one more if k >= 16, and outputs the halfwords of its
// increment in the last three of them. It begins in the clock after one of these: the start, the end of the previous
// half chord, the swap that frees the axis's shadow register.
class ArcGenerator {
 public:
  static constexpr unsigned kHalfChord = 8;
  static constexpr unsigned kMinChordBits = 5;

  struct Inputs {
    bool clear = false;  // the arc is over or cut; wins over start and tick
    LoadWord load;       // load bus; STATE, CLOSING, SHIFTS, PLANE only while `loadable`
    bool start = false;  // event: the arc begins; its state is loaded
    bool tick = false;   // path tick; between a start and `ready` at most one
  };
  struct Outputs {
    std::uint16_t word = 0;  // valid while a bit of `load` is set
    std::uint8_t load = 0;   // bit per axis: `word` is a halfword of the axis's next increment
    std::uint8_t swap = 0;   // bit per axis: takes its next increment; one clock after the last path tick of the chord
    bool ready = true;       // path ticks are accepted
    bool loadable = true;
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    ChordRotation path;
    std::uint8_t axis_x = 1;
    std::uint8_t axis_y = 1;
    bool under_way = false;
    bool begun = false;   // both axes have taken their first chord
    bool in_x = false;    // the coordinate that rotates now or next is x
    bool full_x = false;  // the axis's shadow holds an increment that is not swapped in
    bool full_y = false;
    unsigned left = 0;           // clocks left of the half chord under way
    std::int64_t increment = 0;  // increment of the half chord under way
    std::uint64_t ticks = 0;     // path ticks since the start
    Outputs out;
  };

  // One rising edge.
  void clock(const Inputs& in) {
    take(in.load);
    state_.out.load = 0;
    state_.out.swap = 0;
    if (in.clear) {
      state_.under_way = false;
      state_.left = 0;
      state_.out.ready = state_.out.loadable = true;
      return;
    }
    if (in.start) {
      start();
      return;
    }
    if (!state_.under_way) return;
    const bool x_is_free = !state_.full_x;
    const bool y_is_free = !state_.full_y;
    const bool both = state_.full_x && state_.full_y;
    if (in.tick) ++state_.ticks;
    swap(in.tick, both);
    rotate(x_is_free, y_is_free);
  }

  const Outputs& outputs() const { return state_.out; }
  const State& state() const { return state_; }
  State& state() { return state_; }

 private:
  static constexpr unsigned kHalfwords = 3;

  void take(const LoadWord& load) {
    ChordRotation::State& state = state_.path.state;
    if (load.to(load_target::kChordState)) join<64>(state.x, state.y, load.word);
    if (load.to(load_target::kChordClosing)) join<48>(state.closing_x, state.closing_y, load.word);
    if (load.to(load_target::kChordShifts)) {
      state.k = load.word & 31;
      state.m = load.word >> 8 & 31;
    }
    if (load.to(load_target::kChordPlane)) {
      state.clockwise = (load.word & 1) != 0;
      state_.axis_x = static_cast<std::uint8_t>(1U << (load.word >> 4 & 7));
      state_.axis_y = static_cast<std::uint8_t>(1U << (load.word >> 8 & 7));
    }
  }

  // Two chains of `Bits` bits in series; the halfwords of x arrive first.
  template <unsigned Bits>
  static void join(std::int64_t& x, std::int64_t& y, std::uint16_t word) {
    const auto passed = static_cast<std::uint16_t>(y);
    std::uint64_t low = static_cast<std::uint64_t>(x) << (64 - Bits) >> (64 - Bits);
    std::uint64_t high = static_cast<std::uint64_t>(y) << (64 - Bits) >> (64 - Bits);
    shift_in<Bits>(low, passed);
    shift_in<Bits>(high, word);
    x = static_cast<std::int64_t>(low << (64 - Bits)) >> (64 - Bits);
    y = static_cast<std::int64_t>(high << (64 - Bits)) >> (64 - Bits);
  }

  void start() {
    state_.under_way = true;
    state_.begun = false;
    state_.full_x = state_.full_y = false;
    state_.in_x = false;
    state_.ticks = 0;
    state_.out.ready = state_.out.loadable = false;
    begin();
  }

  void begin() {
    state_.left = kHalfChord + (state_.path.state.k >= 16 ? 1 : 0);
    state_.increment = state_.in_x ? state_.path.chord_x() : state_.path.chord_y();
  }

  // After the first path tick both axes take their first chord, as soon as both are loaded. After that y takes a
  // chord at odd multiples of half a chord, x at even multiples.
  void swap(bool tick, bool both_are_full) {
    if (!state_.begun) {
      if (both_are_full && state_.ticks != 0) {
        state_.begun = true;
        state_.full_x = state_.full_y = false;
        state_.out.swap = state_.axis_x | state_.axis_y;
      }
      return;
    }
    const unsigned half = state_.path.state.m - 1U;
    if (!tick || state_.path.state.m < kMinChordBits || (state_.ticks & ((std::uint64_t{1} << half) - 1)) != 0) return;
    const bool of_y = (state_.ticks >> half & 1) != 0;
    (of_y ? state_.full_y : state_.full_x) = false;
    state_.out.swap = of_y ? state_.axis_y : state_.axis_x;
  }

  void rotate(bool x_is_free, bool y_is_free) {
    if (state_.left != 0) {
      --state_.left;
      if (state_.left != 0 && state_.left <= kHalfwords) {
        state_.out.load = state_.in_x ? state_.axis_x : state_.axis_y;
        state_.out.word = static_cast<std::uint16_t>(static_cast<std::uint64_t>(state_.increment) >>
                                                     (16 * (kHalfwords - state_.left)));
        if (state_.left == kHalfwords && state_.in_x && !state_.begun) state_.out.ready = true;
      }
      if (state_.left != 0) return;
      (state_.in_x ? state_.full_x : state_.full_y) = true;
      state_.in_x = !state_.in_x;
    }
    if (state_.in_x ? x_is_free : y_is_free) begin();
  }

  State state_;
};

}  // namespace trammel::model
