// Golden model of the soft limits: a pulse that leaves an axis beyond an end of its range, on the side to which it
// went, is a cause of a stop. Positions count modulo 2^32: an end is judged right while the axis stands less than 2^31
// pulses away from it.
//
// One axis is looked at in each clock, in a round of 4, or of 8 with more than 4 axes. The end on the side of its last
// pulse was read a clock before; where the axis has turned since, it waits for the next round. An axis that is looked
// at in clock c, a pulse having come since the last time, is a cause at c+2 and in FAULT and LIMIT_STATE at c+3. Not
// thread-safe; no errors are reported.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class SoftLimits {
 public:
  struct Inputs {
    std::uint8_t counts = 0;  // a bit an axis: a pulse begins, and the position has it in the next clock
    std::uint8_t back = 0;    // with it: backwards
    std::array<std::uint32_t, card_map::kMaxAxes> position{};
    bool clear = false;  // event: FAULT.soft_limit is cleared
    Setting setting;     // SOFT_LIMITS; SOFT_MINUS and SOFT_PLUS of each axis
  };
  struct Cause {
    bool any = false;
    std::uint8_t axis = 0;
    bool back = false;  // at its negative end
  };
  // All that the next clock() depends on beside its inputs.
  struct State {
    std::array<std::array<std::uint32_t, 2>, card_map::kMaxAxes> ends{};  // negative, positive
    std::uint8_t has = 0;                                                 // SOFT_LIMITS
    std::uint8_t moved = 0;                                               // axes with a pulse since they were looked at
    std::uint8_t back = 0;                                                // of the last pulse
    unsigned phase = 0;                                                   // the axis whose end is read
    std::uint32_t end = 0;                                                // as read
    bool end_back = false;                                                // it is the negative one
    Cause judged;
    Cause cause;
    bool named = false;       // since FAULT.soft_limit was cleared
    std::uint32_t shown = 0;  // LIMIT_STATE
  };

  explicit SoftLimits(unsigned axes = card_map::kMaxAxes) : axes_(axes) {}

  // One rising edge.
  void clock(const Inputs& in) {
    show(in.clear);
    state_.cause = state_.judged;
    const unsigned axis = looked_at();
    state_.judged = {};
    if (judges() && beyond(in.position[axis], state_.end, state_.end_back))
      state_.judged = {true, static_cast<std::uint8_t>(axis), state_.end_back};
    look(in.counts);
    state_.back = static_cast<std::uint8_t>((state_.back & ~in.counts) | (in.back & in.counts & present()));
    if (in.setting.set) set(in.setting);
  }

  // The part of a clock that is of the round alone.
  void look(std::uint8_t counts) {
    const unsigned done = judges() ? 1U << looked_at() : 0;
    const unsigned read = state_.phase;
    state_.end_back = bit(state_.back, read);
    state_.end = state_.ends[read][state_.end_back ? 0 : 1];
    state_.moved = static_cast<std::uint8_t>(((state_.moved & ~done) | counts) & state_.has);
    state_.phase = (state_.phase + 1) % round();
  }

  const State& state() const { return state_; }
  State& state() { return state_; }
  bool cause() const { return state_.cause.any; }
  std::uint32_t limit_state() const { return state_.shown; }
  unsigned round() const { return axes_ > 4 ? 8 : 4; }  // clocks
  // Whether a pulse that brings an axis here is one too far.
  bool too_far(unsigned axis, std::uint32_t position, bool back) const {
    return bit(state_.has, axis) && beyond(position, state_.ends[axis][back ? 0 : 1], back);
  }

 private:
  static bool bit(unsigned mask, unsigned n) { return (mask >> n & 1) != 0; }
  static bool beyond(std::uint32_t position, std::uint32_t end, bool back) {
    const std::uint32_t left = back ? position - end : end - position;  // to the end; negative beyond it
    return static_cast<std::int32_t>(left) < 0;
  }
  unsigned present() const { return (1U << axes_) - 1; }
  unsigned looked_at() const { return (state_.phase + round() - 1) % round(); }
  bool judges() const { return bit(state_.moved, looked_at()) && bit(state_.back, looked_at()) == state_.end_back; }

  // LIMIT_STATE, as FAULT takes the cause.
  void show(bool clear) {
    if (clear) {
      state_.named = false;
      state_.shown = 0;
    }
    if (!state_.cause.any || state_.named) return;
    state_.named = true;
    state_.shown = std::uint32_t{state_.cause.axis} << card_map::field::kLimitStateSoftAxisShift |
                   (state_.cause.back ? 0 : card_map::field::kLimitStateSoftPlus);
  }

  void set(const Setting& setting) {
    if (setting.address == card_map::reg::kSoftLimits) state_.has = static_cast<std::uint8_t>(setting.data & present());
    for (unsigned n = 0; n < axes_; ++n) {
      if (setting.address == card_map::reg::soft_minus(n)) state_.ends[n][0] = setting.data;
      if (setting.address == card_map::reg::soft_plus(n)) state_.ends[n][1] = setting.data;
    }
  }

  unsigned axes_;
  State state_;
};

}  // namespace trammel::model
