#include "trammel/model/direct_loader.hpp"

#include "trammel/card_map.hpp"

namespace trammel::model {

namespace {

using card_map::Reason;
namespace reg = card_map::reg;

constexpr std::uint64_t kOnePulse = std::uint64_t{1} << card_map::constant::kFractionBits;
constexpr int kAxisClocks = 17;
constexpr int kOtherClocks = 8;  // of every other phase

LoadWord halfword(unsigned target, std::uint64_t value, int index) {
  return {true, static_cast<std::uint16_t>(target), static_cast<std::uint16_t>(value >> (16 * index))};
}

}  // namespace

void DirectLoader::enter(Phase phase) {
  phase_ = phase;
  step_ = -1;
}

// Halfwords go out lowest first; a frequency to the negative side as its two's complement.
LoadWord DirectLoader::frequency_halfword(int index) const {
  return halfword(load_target::increment(axis_), negative_ ? 0 - frequency_ : frequency_, index);
}

LoadWord DirectLoader::read_axis(const Inputs& in) {
  const std::uint32_t addresses[] = {reg::direction(axis_), reg::frequency_lo(axis_), reg::frequency_hi(axis_),
                                     reg::count(axis_)};
  out_.address = word_address(addresses[step_ / 4 % 4]);
  switch (step_) {
    case 3:
      negative_ = (in.data & 1) != 0;
      break;
    case 7:
      frequency_ = in.data;
      return frequency_halfword(0);
    case 8:
      return frequency_halfword(1);
    case 11:
      frequency_ |= std::uint64_t{in.data} << 32;
      if (frequency_ > kOnePulse) bad_value_ = true;
      return frequency_halfword(2);
    case 15:
    case 16:
      if (in.data != 0 && frequency_ == 0) bad_value_ = true;
      return halfword(load_target::count(axis_), in.data, step_ - 15);
    default:
      break;
  }
  return {};
}

LoadWord DirectLoader::read_length(const Inputs& in) {
  out_.address = word_address(step_ < 4 ? reg::kLengthLo : reg::kLengthHi);
  if (step_ == 3 || step_ == 4) {
    length_ |= in.data;
    return halfword(load_target::kTicks, in.data, step_ - 3);
  }
  if (step_ != 7) return {};
  length_ |= std::uint64_t{in.data} << 32;
  return halfword(load_target::kTicks, in.data, 0);
}

void DirectLoader::decide(const Inputs& in) {
  Reason reason = Reason::None;
  if (bad_value_ || length_ == 0) reason = Reason::BadValue;
  if (busy_) reason = Reason::Busy;
  if (closed_ || in.closed) reason = Reason::Faulted;
  if (bad_mask_) reason = Reason::BadValue;
  out_.done = true;
  out_.error = reason != Reason::None;
  out_.go = !out_.error;
  out_.reason = static_cast<std::uint8_t>(reason);
}

void DirectLoader::go_on(const Inputs& in) {
  out_.load = taken_;
  out_.done = false;
  out_.go = false;
  LoadWord taken;
  switch (phase_) {
    case Phase::Idle:
      if (in.start) enter(Phase::Check);
      break;
    case Phase::Check:
      if (step_ == 0) {
        frequency_ = length_ = 0;
        axis_ = 0;
        bad_value_ = false;
        bad_mask_ = in.mask == 0 || in.mask >> axes_ != 0;
      }
      out_.mask = in.mask;
      if (step_ == kOtherClocks - 1) {
        enter(bad_mask_ || closed_ || busy_ ? Phase::Decide : Phase::Axis);
      } else {
        busy_ = in.busy;
        closed_ = in.closed;
      }
      break;
    case Phase::Axis: {
      const bool masked = (in.mask >> axis_ & 1) != 0;
      if (masked) taken = read_axis(in);
      if (masked && step_ != kAxisClocks - 1) break;
      step_ = -1;
      if (axis_ == card_map::kMaxAxes - 1) enter(Phase::Length);
      ++axis_;
      break;
    }
    case Phase::Length:
      taken = read_length(in);
      if (step_ == kOtherClocks - 1) enter(Phase::Decide);
      break;
    case Phase::Decide:
      if (step_ != kOtherClocks - 1) break;
      decide(in);
      enter(Phase::Idle);
      break;
  }
  ++step_;
  moving_ = taken.valid || taken_.valid;
  taken_ = taken;
  if (in.reset) {
    phase_ = Phase::Idle;
    moving_ = false;
    taken_ = LoadWord{};
    out_ = Outputs{};
  }
}

}  // namespace trammel::model
