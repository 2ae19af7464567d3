#include "clocks.hpp"

#include <fmt/format.h>

#include "trammel/driver/errors.hpp"
#include "wide_arithmetic.hpp"

namespace trammel::driver {

std::uint64_t clocks_of(std::chrono::nanoseconds time, std::uint32_t clock_hz, const char* what) {
  if (time.count() < 0) {
    throw ArgumentError(fmt::format("{}: {} ns is negative", what, time.count()));
  }
  constexpr std::uint64_t kNanosecondsPerSecond = 1'000'000'000;
  const auto product = wide::uint128{static_cast<std::uint64_t>(time.count())} * clock_hz;
  const auto clocks = wide::ceil_div(product, kNanosecondsPerSecond);
  if (clocks >> 63 != 0) {
    throw ArgumentError(fmt::format("{}: {} ns are 2^63 clocks or more at {} Hz", what, time.count(), clock_hz));
  }
  return static_cast<std::uint64_t>(clocks);
}

}  // namespace trammel::driver
