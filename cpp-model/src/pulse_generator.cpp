#include "trammel/model/pulse_generator.hpp"

namespace trammel::model {

std::int64_t PulseGenerator::leap(std::uint64_t ticks) {
  // |increment| <= 2^40 and ticks < 2^63: 104 bits.
  __extension__ using Wide = __int128;
  const Wide sum = phase_ + static_cast<Wide>(increment_) * static_cast<Wide>(ticks);
  phase_ = static_cast<std::int64_t>(sum & kMask);
  const auto steps = open_ ? static_cast<std::int64_t>(sum >> kFractionBits) : 0;
  if (steps != 0) out_.dir = steps < 0;
  return steps;
}

}  // namespace trammel::model
