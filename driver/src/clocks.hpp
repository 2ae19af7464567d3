// Real time to card clocks.
#pragma once

#include <chrono>
#include <cstdint>

namespace trammel::driver {

// ceil(time * clock_hz / 10^9). Throws ArgumentError, with `what` in front, for a negative time or 2^63 clocks or more.
std::uint64_t clocks_of(std::chrono::nanoseconds time, std::uint32_t clock_hz, const char* what);

}  // namespace trammel::driver
