// The increment of a pulse generator. This is the only conversion of pulses over ticks to 2^-40 pulses per tick.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"

namespace trammel::driver {

// round(pulses * 2^40 / ticks), half up, for 0 <= pulses <= ticks, 0 < ticks < 2^40. Also computes a prescaler's
// round(L * 2^40 / N) and direct mode's FREQUENCY. Exact; two divisions of 64 bits.
constexpr std::uint64_t rounded_share(std::uint64_t pulses, std::uint64_t ticks) {
  constexpr unsigned kFirst = 24;  // quotient bits of the first division; the remainder has 40 bits
  constexpr unsigned kSecond = card_map::constant::kFractionBits - kFirst;
  const std::uint64_t first = pulses << kFirst;
  const std::uint64_t second = first % ticks << kSecond;
  const std::uint64_t quotient = (first / ticks << kSecond) + second / ticks;
  return 2 * (second % ticks) >= ticks ? quotient + 1 : quotient;
}

// The increment of a line's axis: the same for -ticks <= pulses <= ticks, half away from zero.
constexpr std::int64_t rounded_increment(std::int64_t pulses, std::uint64_t ticks) {
  const auto share = [ticks](std::int64_t magnitude) {
    return static_cast<std::int64_t>(rounded_share(static_cast<std::uint64_t>(magnitude), ticks));
  };
  return pulses < 0 ? -share(-pulses) : share(pulses);
}

}  // namespace trammel::driver
