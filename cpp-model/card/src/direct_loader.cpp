#include "trammel/model/direct_loader.hpp"

#include "trammel/card_map.hpp"

namespace trammel::model {

namespace {

using card_map::Reason;
namespace reg = card_map::reg;

constexpr std::uint64_t kOnePulse = std::uint64_t{1} << card_map::constant::kFractionBits;
constexpr int kAxisClocks = 17;
constexpr int kOtherClocks = 8;  // clocks of each other phase

LoadWord halfword(unsigned target, std::uint64_t value, int index) {
  return {true, static_cast<std::uint16_t>(target), static_cast<std::uint16_t>(value >> (16 * index))};
}

}  // namespace

void DirectLoader::enter(Phase phase) {
  state_.phase = phase;
  state_.step = -1;
}

// Halfwords go out lowest first; a negative frequency as its two's complement.
LoadWord DirectLoader::frequency_halfword(int index) const {
  return halfword(load_target::increment(state_.axis), state_.negative ? 0 - state_.frequency : state_.frequency,
                  index);
}

LoadWord DirectLoader::read_axis(const Inputs& in) {
  const std::uint32_t addresses[] = {reg::direction(state_.axis), reg::frequency_lo(state_.axis),
                                     reg::frequency_hi(state_.axis), reg::count(state_.axis)};
  state_.out.address = word_address(addresses[state_.step / 4 % 4]);
  switch (state_.step) {
    case 3:
      state_.negative = (in.data & 1) != 0;
      break;
    case 7:
      state_.frequency = in.data;
      return frequency_halfword(0);
    case 8:
      return frequency_halfword(1);
    case 11:
      state_.frequency |= std::uint64_t{in.data} << 32;
      if (state_.frequency > kOnePulse) state_.bad_value = true;
      return frequency_halfword(2);
    case 15:
    case 16:
      if (in.data != 0 && state_.frequency == 0) state_.bad_value = true;
      return halfword(load_target::count(state_.axis), in.data, state_.step - 15);
    default:
      break;
  }
  return {};
}

LoadWord DirectLoader::read_length(const Inputs& in) {
  state_.out.address = word_address(state_.step < 4 ? reg::kLengthLo : reg::kLengthHi);
  if (state_.step == 3 || state_.step == 4) {
    state_.length |= in.data;
    return halfword(load_target::kTicks, in.data, state_.step - 3);
  }
  if (state_.step != 7) return {};
  state_.length |= std::uint64_t{in.data} << 32;
  return halfword(load_target::kTicks, in.data, 0);
}

void DirectLoader::decide(const Inputs& in) {
  Reason reason = Reason::None;
  if (state_.bad_value || state_.length == 0) reason = Reason::BadValue;
  if (state_.busy) reason = Reason::Busy;
  if (state_.closed || in.closed) reason = Reason::Faulted;
  if (state_.bad_mask) reason = Reason::BadValue;
  state_.out.done = true;
  state_.out.error = reason != Reason::None;
  state_.out.go = !state_.out.error;
  state_.out.reason = static_cast<std::uint8_t>(reason);
}

void DirectLoader::go_on(const Inputs& in) {
  state_.out.load = state_.taken;
  state_.out.done = false;
  state_.out.go = false;
  LoadWord taken;
  switch (state_.phase) {
    case Phase::Idle:
      if (in.start) enter(Phase::Check);
      break;
    case Phase::Check:
      if (state_.step == 0) {
        state_.frequency = state_.length = 0;
        state_.axis = 0;
        state_.bad_value = false;
        state_.bad_mask = in.mask == 0 || in.mask >> axes_ != 0;
      }
      state_.out.mask = in.mask;
      if (state_.step == kOtherClocks - 1) {
        enter(state_.bad_mask || state_.closed || state_.busy ? Phase::Decide : Phase::Axis);
      } else {
        state_.busy = in.busy;
        state_.closed = in.closed;
      }
      break;
    case Phase::Axis: {
      const bool masked = (in.mask >> state_.axis & 1) != 0;
      if (masked) taken = read_axis(in);
      if (masked && state_.step != kAxisClocks - 1) break;
      state_.step = -1;
      if (state_.axis == card_map::kMaxAxes - 1) enter(Phase::Length);
      ++state_.axis;
      break;
    }
    case Phase::Length:
      taken = read_length(in);
      if (state_.step == kOtherClocks - 1) enter(Phase::Decide);
      break;
    case Phase::Decide:
      if (state_.step != kOtherClocks - 1) break;
      decide(in);
      enter(Phase::Idle);
      break;
  }
  if (state_.phase != Phase::Idle) ++state_.step;
  state_.moving = taken.valid || state_.taken.valid;
  state_.taken = taken;
  if (in.reset) {
    state_.phase = Phase::Idle;
    state_.moving = false;
    state_.taken = LoadWord{};
    state_.out = Outputs{};
  }
}

}  // namespace trammel::model
