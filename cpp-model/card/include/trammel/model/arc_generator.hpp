// Golden model of the arc generator (docs/developer/architecture.md): a circle in chords. X and Y rotate in turns, half
// a chord apart, and what each moves by is the increment of its axis's pulse generator for the chord's path ticks.
// Judged by the distance to the true circle and by the end point. No errors are reported; not thread-safe.
#pragma once

#include <cstdint>

#include "trammel/model/buses.hpp"

namespace trammel::model {

// The rotation alone, without clocks. X and Y are in 2^(m-40) pulses: 2^-40 pulses a path tick, times the 2^m ticks of
// a chord, so that a displacement is an increment.
class ChordRotation {
 public:
  struct State {
    std::int64_t x = 0;          // at whole chord times: X(0)
    std::int64_t y = 0;          // at half chord times: Y(-1/2)
    std::int64_t closing_x = 0;  // 2^-40 pulses a path tick, 48 bits
    std::int64_t closing_y = 0;
    std::uint8_t k = 1;  // a chord turns by 2 asin(2^-(k+1)); 0..31
    std::uint8_t m = 5;  // 2^m path ticks a chord; below 5: no chord follows the first
    bool clockwise = false;
  };

  State state;

  // value / 2^k, rounded to the nearest, ties upwards.
  static std::int64_t turned(std::int64_t value, unsigned k) {
    return (value >> k) + (k == 0 ? 0 : value >> (k - 1) & 1);
  }

  // The next chord of y, from X, or of x, from Y: moves the coordinate, and gives the axis's increment, the closing one
  // in it. In turns, y first.
  std::int64_t chord_y() { return move(state.y, state.clockwise ? -turn(state.x) : turn(state.x)) + state.closing_y; }
  std::int64_t chord_x() { return move(state.x, state.clockwise ? turn(state.y) : -turn(state.y)) + state.closing_x; }

 private:
  std::int64_t turn(std::int64_t from) const { return turned(from, state.k); }

  static std::int64_t move(std::int64_t& coordinate, std::int64_t by) {
    coordinate = static_cast<std::int64_t>(static_cast<std::uint64_t>(coordinate) + static_cast<std::uint64_t>(by));
    return by;
  }
};

// The block. A half chord under way in n clocks, kHalfChord or one more where k >= 16, gives its increment's halfwords
// in the last three of them. It begins in the clock after the start or the last one's end, or after the swap that makes
// its axis's shadow free.
class ArcGenerator {
 public:
  static constexpr unsigned kHalfChord = 8;
  static constexpr unsigned kMinChordBits = 5;

  struct Inputs {
    bool clear = false;  // the arc is over, or cut; wins over everything in its clock
    LoadWord load;       // STATE, CLOSING, SHIFTS, PLANE: only while loadable
    bool start = false;  // the state is loaded
    bool tick = false;   // path tick: at most one after a start until `ready`
  };
  struct Outputs {
    std::uint16_t word = 0;  // means something with load
    std::uint8_t load = 0;   // by axis: a halfword of its next increment
    std::uint8_t swap = 0;   // by axis: takes it; a clock after the path tick that was the chord's last
    bool ready = true;       // path ticks may come
    bool loadable = true;
  };

  // One rising edge.
  void clock(const Inputs& in) {
    take(in.load);
    out_.load = 0;
    out_.swap = 0;
    if (in.clear) {
      under_way_ = false;
      left_ = 0;
      out_.ready = out_.loadable = true;
      return;
    }
    if (in.start) {
      start();
      return;
    }
    if (!under_way_) return;
    const bool x_is_free = !full_x_;
    const bool y_is_free = !full_y_;
    const bool both = full_x_ && full_y_;
    if (in.tick) ++ticks_;
    swap(in.tick, both);
    rotate(x_is_free, y_is_free);
  }

  const Outputs& outputs() const { return out_; }

  // For jumps, only between the start's clocks and those of a half chord. Path ticks up to the one that ends a half
  // chord, that included; the largest number there is where none does.
  std::uint64_t ticks_left() const {
    if (path_.state.m < kMinChordBits) return UINT64_MAX;
    const std::uint64_t half = std::uint64_t{1} << (path_.state.m - 1);
    return half - (ticks_ & (half - 1));
  }
  // n path ticks at once, n < ticks_left().
  void pass(std::uint64_t n) { ticks_ += n; }

  // Without load, start or tick clock() changes nothing any more.
  bool quiet() const {
    return out_.load == 0 && out_.swap == 0 && (!under_way_ || (left_ == 0 && begun_ && full_x_ && full_y_));
  }

 private:
  static constexpr unsigned kHalfwords = 3;

  void take(const LoadWord& load) {
    ChordRotation::State& state = path_.state;
    if (load.to(load_target::kChordState)) join<64>(state.x, state.y, load.word);
    if (load.to(load_target::kChordClosing)) join<48>(state.closing_x, state.closing_y, load.word);
    if (load.to(load_target::kChordShifts)) {
      state.k = load.word & 31;
      state.m = load.word >> 8 & 31;
    }
    if (load.to(load_target::kChordPlane)) {
      state.clockwise = (load.word & 1) != 0;
      axis_x_ = static_cast<std::uint8_t>(1U << (load.word >> 4 & 7));
      axis_y_ = static_cast<std::uint8_t>(1U << (load.word >> 8 & 7));
    }
  }

  // Two chains of `Bits` bits, one behind the other: x first.
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
    under_way_ = true;
    begun_ = false;
    full_x_ = full_y_ = false;
    in_x_ = false;
    ticks_ = 0;
    out_.ready = out_.loadable = false;
    begin();
  }

  void begin() {
    left_ = kHalfChord + (path_.state.k >= 16 ? 1 : 0);
    increment_ = in_x_ ? path_.chord_x() : path_.chord_y();
  }

  // After the first path tick both axes take their first chord, as soon as it is loaded; then y at odd multiples of
  // half a chord, x at even ones.
  void swap(bool tick, bool both_are_full) {
    if (!begun_) {
      if (both_are_full && ticks_ != 0) {
        begun_ = true;
        full_x_ = full_y_ = false;
        out_.swap = axis_x_ | axis_y_;
      }
      return;
    }
    const unsigned half = path_.state.m - 1U;
    if (!tick || path_.state.m < kMinChordBits || (ticks_ & ((std::uint64_t{1} << half) - 1)) != 0) return;
    const bool of_y = (ticks_ >> half & 1) != 0;
    (of_y ? full_y_ : full_x_) = false;
    out_.swap = of_y ? axis_y_ : axis_x_;
  }

  void rotate(bool x_is_free, bool y_is_free) {
    if (left_ != 0) {
      --left_;
      if (left_ != 0 && left_ <= kHalfwords) {
        out_.load = in_x_ ? axis_x_ : axis_y_;
        out_.word = static_cast<std::uint16_t>(static_cast<std::uint64_t>(increment_) >> (16 * (kHalfwords - left_)));
        if (left_ == kHalfwords && in_x_ && !begun_) out_.ready = true;
      }
      if (left_ != 0) return;
      (in_x_ ? full_x_ : full_y_) = true;
      in_x_ = !in_x_;
    }
    if (in_x_ ? x_is_free : y_is_free) begin();
  }

  ChordRotation path_;
  std::uint8_t axis_x_ = 1;
  std::uint8_t axis_y_ = 1;
  bool under_way_ = false;
  bool begun_ = false;   // the first chord is swapped in
  bool in_x_ = false;    // which coordinate moves next, or now
  bool full_x_ = false;  // the axis's shadow holds an increment that is not swapped in
  bool full_y_ = false;
  unsigned left_ = 0;           // clocks of the half chord under way
  std::int64_t increment_ = 0;  // its increment
  std::uint64_t ticks_ = 0;     // since the start
  Outputs out_;
};

}  // namespace trammel::model
