// Golden model of the deviation accumulator (docs/developer/architecture.md): makes conics and lines in steps that
// the deviation F chooses. In 4 directions: Goldberg & Goldberg, "XY Interpolation Algorithms", Table 2. The text and
// the tables of that paper contradict each other about the sense of direction; the tables are right: D = 0 turns
// counter-clockwise with x right and y up. In 8 directions: the step with the least deviation among a step in x, one
// in y, and both at once (docs/decisions/0003). The tests judge it by the papers' vectors and by distances to the
// true curve. No errors are reported; not thread-safe.
#pragma once

#include <cstdint>

#include "trammel/model/buses.hpp"
#include "trammel/model/wide.hpp"

namespace trammel::model {

// The path alone, without clocks: chooses the next step. Units: pulses; F and gradients in the host's scale.
class DeviationPath {
 public:
  using Word = uint128;

  // The state of a path, with the card's widths: F, GX, GY 80 bits signed; halves 48 bits.
  struct State {
    Word deviation = 0;        // F * 2^48: the sign is bit 127, so sums wrap at 80 bits as in the card
    Word gradient_x = 0;       // GX * 2^48
    Word gradient_y = 0;       // GY * 2^48
    std::uint64_t half_x = 0;  // CX/2
    std::uint64_t half_y = 0;  // CY/2
    std::uint32_t left_x = 0;  // signed displacement to the end, two's complement
    std::uint32_t left_y = 0;
    std::uint16_t quadrants = 0;  // quadrant changes left
    bool clockwise = false;
    bool eight_directions = false;
    bool finishing = false;  // a coordinate of the end is reached: only the displacement left decides
  };
  struct Step {
    bool in_x = false;
    bool in_y = false;  // in 8 directions with in_x or alone; in 4 directions only if not in_x
    bool negative_x = false;
    bool negative_y = false;
  };
  static constexpr int kAlign = 48;  // 128 - 80

  State state;

  // Begins a path at `state`, which must be loaded.
  void begin() { state.finishing = false; }

  // True at the end: no quadrant changes and no displacement are left.
  bool at_end() const { return state.quadrants == 0 && state.left_x == 0 && state.left_y == 0; }

  // Makes the next step; not to be called at the end.
  Step step() {
    const Step next = choose();
    const bool x_was_negative = top(state.gradient_x);
    const bool y_was_negative = top(state.gradient_y);
    if (next.in_x) apply(next.negative_x, state.half_x, state.gradient_x, state.left_x);
    if (next.in_y) apply(next.negative_y, state.half_y, state.gradient_y, state.left_y);
    const bool changed = top(state.gradient_x) != x_was_negative || top(state.gradient_y) != y_was_negative;
    if (changed && state.quadrants != 0) --state.quadrants;
    return next;
  }

 private:
  static bool top(Word word) { return (word >> 127) != 0; }

  // True if a step of this sign does not bring the coordinate nearer to its end.
  static bool reached(std::uint32_t left, bool negative) {
    const auto signed_left = static_cast<std::int32_t>(left);
    return negative ? signed_left >= 0 : signed_left <= 0;
  }

  Step choose() {
    Step next;
    next.negative_x = top(state.gradient_y) == state.clockwise;
    next.negative_y = top(state.gradient_x) != state.clockwise;
    if (!state.finishing && state.quadrants == 0) {
      state.finishing = reached(state.left_x, next.negative_x) || reached(state.left_y, next.negative_y);
    }
    if (state.finishing) {
      next.in_x = state.left_x != 0;
      next.in_y = state.left_y != 0 && (state.eight_directions || !next.in_x);
      next.negative_x = static_cast<std::int32_t>(state.left_x) < 0;
      next.negative_y = static_cast<std::int32_t>(state.left_y) < 0;
    } else if (state.eight_directions) {
      choose_least(next);
    } else {
      // On or outside the curve the axis that moves towards its zero steps; inside the curve the other axis steps.
      const bool x_moves_outward = next.negative_x == top(state.gradient_x);
      const bool inside = top(state.deviation);
      next.in_x = x_moves_outward == inside;
      next.in_y = !next.in_x;
    }
    return next;
  }

  // One axis moves towards its zero and changes F by Ui (mostly negative); the other moves away from its zero and
  // changes F by Uo (positive). So F + Ui < F + Ui + Uo < F + Uo. Of two neighbours in this order, the sign of their
  // sum tells which one is nearer to 0.
  void choose_least(Step& next) const {
    const bool x_inward = next.negative_x != top(state.gradient_x);
    const Word by_x = change(next.negative_x, state.half_x, state.gradient_x);
    const Word by_y = change(next.negative_y, state.half_y, state.gradient_y);
    const Word by_inward = x_inward ? by_x : by_y;
    const Word by_outward = x_inward ? by_y : by_x;
    const Word both = state.deviation + by_inward + by_outward;
    const bool inward_alone = !top(state.deviation + by_inward + both);
    const bool outward_alone = !inward_alone && top(state.deviation + by_outward + both);
    next.in_x = x_inward ? !outward_alone : !inward_alone;
    next.in_y = x_inward ? !inward_alone : !outward_alone;
  }

  static Word change(bool negative, std::uint64_t half, Word gradient) {
    return (static_cast<Word>(half) << kAlign) + (negative ? Word{0} - gradient : gradient);
  }

  void apply(bool negative, std::uint64_t half, Word& gradient, std::uint32_t& left) {
    const Word second = static_cast<Word>(half) << kAlign;
    state.deviation += change(negative, half, gradient);
    if (negative) {
      gradient -= 2 * second;
      left += 1;
    } else {
      gradient += 2 * second;
      left -= 1;
    }
  }
};

class DeviationAccumulator {
 public:
  struct Inputs {
    bool rst = false;
    LoadWord load;       // load bus; the accumulator owns the targets DEVIATION to PLANE
    bool start = false;  // event, only at rest: all nine chains are loaded, the last halfword before this clock
    bool tick = false;   // path tick, only while ready
    bool clear = false;
  };
  struct Outputs {
    bool step_x = false;  // high for one clock per step; in 8 directions both can be high together
    bool dir_x = false;   // 1 = negative; holds between steps
    bool step_y = false;
    bool dir_y = false;
    bool ready = false;
    bool at_end = false;  // valid with ready
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    DeviationPath path;
    DeviationPath::Step next;
    Outputs out;
    bool emit = false;  // a step appears at the outputs after the next edge
    unsigned wait = 0;  // clocks until ready
  };
  // A tick in clock c gives its step at c + kStepLatency and `ready` at c + kTickPeriod. A start in clock c gives
  // `ready` at c + kStartLatency. In 8 directions `ready` comes kCompareClocks later, because the candidates of the
  // next step are compared first.
  static constexpr unsigned kStepLatency = 2;
  static constexpr unsigned kTickPeriod = 9;
  static constexpr unsigned kStartLatency = 2;
  static constexpr unsigned kCompareClocks = 8;
  // In this many last clocks before `ready` a load may be requested: it arrives when the block is at rest.
  static constexpr unsigned kAskClocks = 4;

  // One rising edge.
  void clock(const Inputs& in) {
    state_.out.step_x = false;
    state_.out.step_y = false;
    const bool emit = state_.emit;
    const bool accept = in.tick && state_.out.ready && !state_.out.at_end;
    state_.emit = false;
    const bool load = is_own(in.load);
    if (in.rst || in.clear || load) {
      state_.wait = 0;
      state_.out.ready = false;
      state_.out.at_end = false;
      if (load) take(in.load);
      if (in.rst) {
        state_.out.dir_x = false;
        state_.out.dir_y = false;
      }
      if (in.rst || in.clear) return;
    } else if (in.start) {
      state_.path.begin();
      state_.out.ready = false;
      state_.wait = kStartLatency + compare_clocks() - 1;
    } else if (accept) {
      state_.next = state_.path.step();
      state_.emit = true;
      state_.out.ready = false;
      state_.wait = kTickPeriod + compare_clocks() - 1;
    } else if (state_.wait != 0 && --state_.wait == 0) {
      state_.out.ready = true;
      state_.out.at_end = state_.path.at_end();
    }
    if (emit) show();
  }

  const Outputs& outputs() const { return state_.out; }
  const State& state() const { return state_; }
  State& state() { return state_; }

  // True during a step or before the first one, as long as no load may be requested.
  bool stepping() const { return state_.wait > kAskClocks; }

  static bool is_own(const LoadWord& load) {
    return load.valid && load.target >= load_target::kDeviation && load.target <= load_target::kPlane;
  }

 private:
  void take(const LoadWord& load);

  unsigned compare_clocks() const { return state_.path.state.eight_directions ? kCompareClocks : 0; }

  void show() {
    state_.out.step_x = state_.next.in_x;
    state_.out.step_y = state_.next.in_y;
    if (state_.next.in_x) state_.out.dir_x = state_.next.negative_x;
    if (state_.next.in_y) state_.out.dir_y = state_.next.negative_y;
  }

  State state_;
};

}  // namespace trammel::model
