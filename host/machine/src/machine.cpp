#include "trammel/machine/machine.hpp"

#include <fmt/format.h>

#include <cmath>

namespace trammel::machine {

std::optional<std::size_t> Machine::axis(char letter) const {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (axes[i].letter == letter) {
      return i;
    }
  }
  return std::nullopt;
}

std::uint16_t clocks_from_ns(double nanoseconds, std::uint32_t clock_hz) {
  constexpr std::uint64_t kPerSecond = 1'000'000'000;
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint16_t>::max();
  // What is far too long is refused before the product could overflow.
  if (nanoseconds * clock_hz < 2.0 * kMost * kPerSecond) {
    const auto whole = static_cast<std::uint64_t>(std::ceil(nanoseconds));
    const std::uint64_t clocks = (whole * clock_hz + kPerSecond - 1) / kPerSecond;
    if (clocks <= kMost) {
      return static_cast<std::uint16_t>(clocks);
    }
  }
  throw std::out_of_range(fmt::format("{} ns at {} Hz are more than the card's 65535 clocks", nanoseconds, clock_hz));
}

}  // namespace trammel::machine
