// Golden model of the soft limits: a pulse that leaves an axis beyond the end of its range towards which it moved is
// a cause of a stop. Positions count modulo 2^32: an end is judged correctly while the axis is less than 2^31 pulses
// away from it.
//
// Each clock looks at one axis, in rounds of 4, or of 8 with more than 4 axes. The end on the side of the axis's last
// pulse was read one clock before; if the axis has turned since, it waits for the next round. If an axis that is
// looked at in clock c has made a pulse since the previous look, and is beyond that end, it is a cause at c+2 and in
// FAULT and LIMIT_STATE at c+3. Not thread-safe; no errors are reported. Settings in the first 16 clocks after a reset
// are taken here and lost in the RTL; the card has no access that early.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class SoftLimits {
 public:
  struct Inputs {
    std::uint8_t counts = 0;  // a bit per axis: a pulse begins; the position includes it in the next clock
    std::uint8_t back = 0;    // with `counts`: the pulse is negative
    std::array<std::uint32_t, card_map::kMaxAxes> position{};
    bool clear = false;  // event: FAULT.soft_limit is cleared
    Setting setting;     // SOFT_LIMITS; SOFT_MINUS and SOFT_PLUS of each axis
  };
  struct Cause {
    bool any = false;
    std::uint8_t axis = 0;
    bool back = false;  // the axis is beyond its negative end
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    std::array<std::array<std::uint32_t, 2>, card_map::kMaxAxes> ends{};  // negative, positive
    std::uint8_t has = 0;                                                 // SOFT_LIMITS
    std::uint8_t moved = 0;                                               // axes with a pulse since the last look
    std::uint8_t back = 0;                                                // axes whose last pulse was negative
    unsigned phase = 0;                                                   // the axis whose end is read
    std::uint32_t end = 0;                                                // the end that was read
    bool end_back = false;                                                // the end that was read is the negative one
    Cause judged;
    Cause cause;
    bool named = false;       // a cause was reported since FAULT.soft_limit was cleared
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

  // The part of clock() that belongs to the scan only.
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
  // True if a pulse that brings the axis to `position` is beyond the end.
  bool too_far(unsigned axis, std::uint32_t position, bool back) const {
    return bit(state_.has, axis) && beyond(position, state_.ends[axis][back ? 0 : 1], back);
  }

 private:
  static bool bit(unsigned mask, unsigned n) { return (mask >> n & 1) != 0; }
  static bool beyond(std::uint32_t position, std::uint32_t end, bool back) {
    const std::uint32_t left = back ? position - end : end - position;  // pulses to the end; negative beyond it
    return static_cast<std::int32_t>(left) < 0;
  }
  unsigned present() const { return (1U << axes_) - 1; }
  unsigned looked_at() const { return (state_.phase + round() - 1) % round(); }
  bool judges() const { return bit(state_.moved, looked_at()) && bit(state_.back, looked_at()) == state_.end_back; }

  // LIMIT_STATE changes in the clock in which FAULT takes the cause.
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
