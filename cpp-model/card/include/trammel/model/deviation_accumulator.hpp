// Golden model of the deviation accumulator (docs/developer/architecture.md): conics and lines by steps chosen from the
// deviation F. In 4 directions: Goldberg & Goldberg, "XY Interpolation Algorithms", Table 2; the text's sense of
// direction is the reverse of its tables, which hold: D = 0 turns counter-clockwise with x right and y up. In 8
// directions: the least deviation among a step in x, one in y, and both at once (docs/decisions/0003).
// Judged by the papers' vectors and by distances to the true curve. No errors are reported; not thread-safe.
#pragma once

#include <cstdint>

#include "trammel/model/buses.hpp"
#include "trammel/model/wide.hpp"

namespace trammel::model {

// The path alone: which step comes next, without clocks. Units: pulses; F and gradients in the host's scale.
class DeviationPath {
 public:
  using Word = uint128;

  // What a path starts with, at the card's widths: F, GX, GY 80 bits signed; halves 48 bits.
  struct State {
    Word deviation = 0;        // F * 2^48: with the sign in bit 127, wrapping at 80 bits comes by itself
    Word gradient_x = 0;       // GX * 2^48
    Word gradient_y = 0;       // GY * 2^48
    std::uint64_t half_x = 0;  // CX/2
    std::uint64_t half_y = 0;  // CY/2
    std::uint32_t left_x = 0;  // signed displacement to the end, two's complement
    std::uint32_t left_y = 0;
    std::uint16_t quadrants = 0;  // quadrant changes left
    bool clockwise = false;
    bool eight_directions = false;
  };
  struct Step {
    bool in_x = false;
    bool in_y = false;  // in 8 directions beside in_x or alone, in 4 where not in_x
    bool negative_x = false;
    bool negative_y = false;
  };
  static constexpr int kAlign = 48;  // 128 - 80

  State state;

  // Begins at `state`; the end is not yet in sight.
  void begin() { finishing_ = false; }

  // No quadrants left and no displacement.
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

  // True when a step of this sign does not bring the coordinate nearer to the end's.
  static bool reached(std::uint32_t left, bool negative) {
    const auto signed_left = static_cast<std::int32_t>(left);
    return negative ? signed_left >= 0 : signed_left <= 0;
  }

  Step choose() {
    Step next;
    next.negative_x = top(state.gradient_y) == state.clockwise;
    next.negative_y = top(state.gradient_x) != state.clockwise;
    if (!finishing_ && state.quadrants == 0) {
      finishing_ = reached(state.left_x, next.negative_x) || reached(state.left_y, next.negative_y);
    }
    if (finishing_) {
      next.in_x = state.left_x != 0;
      next.in_y = state.left_y != 0 && (state.eight_directions || !next.in_x);
      next.negative_x = static_cast<std::int32_t>(state.left_x) < 0;
      next.negative_y = static_cast<std::int32_t>(state.left_y) < 0;
    } else if (state.eight_directions) {
      choose_least(next);
    } else {
      // On or outside the curve the axis that moves towards its zero steps, inside it the other one.
      const bool x_moves_outward = next.negative_x == top(state.gradient_x);
      const bool inside = top(state.deviation);
      next.in_x = x_moves_outward == inside;
      next.in_y = !next.in_x;
    }
    return next;
  }

  // One axis moves towards its zero, the other away from it; F changes by Ui (mostly negative), Uo (positive) or both.
  // So F + Ui < F + Ui + Uo < F + Uo: which of two neighbours is nearer to 0 says the sign of their sum.
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

  bool finishing_ = false;
};

class DeviationAccumulator {
 public:
  struct Inputs {
    bool rst = false;
    LoadWord load;       // load bus; targets DEVIATION to PLANE are its own
    bool start = false;  // state is loaded: all nine chains, the last halfword before this clock; only at rest
    bool tick = false;   // path tick, while ready
    bool clear = false;
  };
  struct Outputs {
    bool step_x = false;  // one clock a step; in 8 directions both at once too
    bool dir_x = false;   // 1 = negative; holds between steps
    bool step_y = false;
    bool dir_y = false;
    bool ready = false;
    bool at_end = false;  // valid with ready
  };
  // A tick at c gives its step at c + kStepLatency and ready again at c + kTickPeriod; a start, ready at c +
  // kStartLatency. In 8 directions the candidates of the next step are compared before that.
  static constexpr unsigned kStepLatency = 2;
  static constexpr unsigned kTickPeriod = 9;
  static constexpr unsigned kStartLatency = 2;
  static constexpr unsigned kCompareClocks = 8;
  // The last clocks before ready in which a load may be asked for: it comes when the block is at rest.
  static constexpr unsigned kAskClocks = 4;

  // One rising edge.
  void clock(const Inputs& in) {
    out_.step_x = false;
    out_.step_y = false;
    const bool emit = emit_;
    const bool accept = in.tick && out_.ready && !out_.at_end;
    emit_ = false;
    const bool load = is_own(in.load);
    if (in.rst || in.clear || load) {
      wait_ = 0;
      out_.ready = false;
      out_.at_end = false;
      if (load) take(in.load);
      if (in.rst) {
        out_.dir_x = false;
        out_.dir_y = false;
      }
      if (in.rst || in.clear) return;
    } else if (in.start) {
      path_.begin();
      out_.ready = false;
      wait_ = kStartLatency + compare_clocks() - 1;
    } else if (accept) {
      next_ = path_.step();
      emit_ = true;
      out_.ready = false;
      wait_ = kTickPeriod + compare_clocks() - 1;
    } else if (wait_ != 0 && --wait_ == 0) {
      out_.ready = true;
      out_.at_end = path_.at_end();
    }
    if (emit) show();
  }

  const Outputs& outputs() const { return out_; }

  // In a step or before the first one, and no load may be asked for yet.
  bool stepping() const { return wait_ > kAskClocks; }

  // Nothing is under way: without inputs no output will change.
  bool quiet() const { return wait_ == 0 && !emit_ && !out_.step_x && !out_.step_y; }

  // `clocks` clocks without inputs; the same as that many calls of clock({}).
  void advance(std::uint64_t clocks) {
    for (; clocks != 0 && !quiet(); --clocks) clock({});
  }

 private:
  static bool is_own(const LoadWord& load) {
    return load.valid && load.target >= load_target::kDeviation && load.target <= load_target::kPlane;
  }

  void take(const LoadWord& load);

  unsigned compare_clocks() const { return path_.state.eight_directions ? kCompareClocks : 0; }

  void show() {
    out_.step_x = next_.in_x;
    out_.step_y = next_.in_y;
    if (next_.in_x) out_.dir_x = next_.negative_x;
    if (next_.in_y) out_.dir_y = next_.negative_y;
  }

  DeviationPath path_;
  DeviationPath::Step next_;
  Outputs out_;
  bool emit_ = false;  // a step goes out at the next edge
  unsigned wait_ = 0;  // clocks until ready
};

}  // namespace trammel::model
