#include "trammel/model/direct_loader.hpp"

namespace trammel::model {

namespace {

namespace reg = card_map::reg;

constexpr std::uint64_t kOnePulse = std::uint64_t{1} << 40;
constexpr int kAxisClocks = 17;
constexpr int kOtherClocks = 8;  // of every other phase

std::uint16_t half(std::uint64_t value, int index) { return static_cast<std::uint16_t>(value >> (16 * index)); }

}  // namespace

void DirectLoader::enter(Phase phase) {
  phase_ = phase;
  step_ = -1;
}

// Halfwords go out lowest first; a frequency to the negative side as its two's complement.
DirectLoader::Halfword DirectLoader::frequency_halfword(int index) const {
  Halfword result;
  result.word = half(negative_ ? 0 - frequency_ : frequency_, index);
  result.axis = static_cast<std::uint8_t>(axis_);
  result.increment = true;
  return result;
}

void DirectLoader::read_axis(const Inputs& in, Halfword& taken) {
  switch (step_) {
    case 3:
      negative_ = (in.data & 1) != 0;
      break;
    case 7:
      frequency_ = in.data;
      taken = frequency_halfword(0);
      break;
    case 8:
      taken = frequency_halfword(1);
      break;
    case 11:
      frequency_ |= std::uint64_t{in.data} << 32;
      taken = frequency_halfword(2);
      if (frequency_ > kOnePulse) bad_ = true;
      break;
    case 15:
    case 16:
      taken.word = half(in.data, step_ - 15);
      taken.axis = static_cast<std::uint8_t>(axis_);
      taken.steps = true;
      if (in.data != 0 && frequency_ == 0) bad_ = true;
      break;
    default:
      break;
  }
  const std::uint32_t addresses[] = {reg::direction(axis_), reg::frequency_lo(axis_), reg::frequency_hi(axis_),
                                     reg::count(axis_)};
  out_.address = word_address(addresses[step_ / 4 % 4]);
}

void DirectLoader::read_length(const Inputs& in, Halfword& taken) {
  if (step_ == 3 || step_ == 4) {
    taken.word = half(in.data, step_ - 3);
    taken.length = true;
    length_ |= in.data;
  } else if (step_ == 7) {
    taken.word = half(in.data, 0);
    taken.length = true;
    length_ |= std::uint64_t{in.data} << 32;
  }
  out_.address = word_address(step_ < 4 ? reg::kLengthLo : reg::kLengthHi);
}

void DirectLoader::work(const Inputs& in) {
  out_.word = taken_.word;
  out_.axis = taken_.axis;
  out_.increment = taken_.increment;
  out_.steps = taken_.steps;
  out_.length = taken_.length;
  out_.done = false;
  out_.go = false;
  Halfword taken;
  switch (phase_) {
    case Phase::Idle:
      if (in.start) enter(Phase::Check);
      break;
    case Phase::Check:
      if (step_ == 0) {
        frequency_ = length_ = 0;
        axis_ = 0;
        bad_ = in.mask == 0 || in.mask >> axes_ != 0;
      }
      if (step_ == kOtherClocks - 1) enter(busy_ || bad_ ? Phase::Decide : Phase::Axis);
      busy_ = in.busy;
      out_.mask = in.mask;
      break;
    case Phase::Axis: {
      const bool masked = (in.mask >> axis_ & 1) != 0;
      if (masked) read_axis(in, taken);
      if (masked && step_ != kAxisClocks - 1) break;
      step_ = -1;
      if (axis_ == 7) enter(Phase::Length);
      ++axis_;
      break;
    }
    case Phase::Length:
      read_length(in, taken);
      if (step_ == kOtherClocks - 1) enter(Phase::Decide);
      break;
    case Phase::Decide:
      if (step_ != kOtherClocks - 1) break;
      out_.done = true;
      out_.error = busy_ || bad_ || length_ == 0;
      out_.go = !out_.error;
      out_.reason = static_cast<std::uint8_t>(busy_ ? card_map::Reason::Busy : card_map::Reason::BadValue);
      enter(Phase::Idle);
      break;
  }
  ++step_;
  moving_ = taken.increment || taken.steps || taken.length || taken_.increment || taken_.steps || taken_.length;
  taken_ = taken;
  if (in.reset) {
    phase_ = Phase::Idle;
    moving_ = false;
    taken_ = Halfword{};
    out_ = Outputs{};
  }
}

}  // namespace trammel::model
