#include "trammel/machine/machine.hpp"

#include <fmt/format.h>

#include <algorithm>
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
  // 1 ns at 4 GHz is 4 clocks: the slack of 1e-6 clock takes the rounding of the product, never a clock.
  const double clocks = std::ceil(nanoseconds * clock_hz / 1e9 - 1e-6);
  if (clocks > std::numeric_limits<std::uint16_t>::max()) {
    throw std::out_of_range(fmt::format("{} ns at {} Hz are more than the card's 65535 clocks", nanoseconds, clock_hz));
  }
  const double least = nanoseconds > 0 ? 1 : 0;
  return static_cast<std::uint16_t>(std::max(clocks, least));
}

Machine default_machine() { return parse_machine(default_machine_text(), "default machine"); }

}  // namespace trammel::machine
