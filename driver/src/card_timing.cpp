#include "trammel/driver/card_timing.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "nanoseconds.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/wide.hpp"

namespace trammel::driver {

std::uint64_t poll_interval(std::uint32_t clock_hz) {
  constexpr std::uint32_t kPollsPerSecond = 20'000;
  constexpr std::uint32_t kMinClocks = 64;
  return std::max(clock_hz / kPollsPerSecond, kMinClocks);
}

std::uint64_t clocks_of(std::chrono::nanoseconds time, std::uint32_t clock_hz, const char* what) {
  if (time.count() < 0) {
    throw ArgumentError(fmt::format("{}: {} ns is negative", what, time.count()));
  }
  const auto nanoseconds = static_cast<std::uint64_t>(time.count());
  const Uint128 clocks = ceil_div(Uint128::product(nanoseconds, clock_hz), kNanosecondsPerSecond);
  if (clocks >> 63 != 0) {
    throw ArgumentError(fmt::format("{}: {} ns are 2^63 clocks or more at {} Hz", what, time.count(), clock_hz));
  }
  return clocks.low();
}

std::chrono::nanoseconds time_of(std::uint64_t clocks, std::uint32_t clock_hz) {
  const Uint128 time = ceil_div(Uint128::product(clocks, kNanosecondsPerSecond), clock_hz);
  const auto longest = std::chrono::nanoseconds::max();
  return time >= static_cast<std::uint64_t>(longest.count())
             ? longest
             : std::chrono::nanoseconds(static_cast<std::int64_t>(time.low()));
}

std::uint32_t step_time_clocks(std::chrono::nanoseconds time, std::uint32_t clock_hz, const char* what) {
  constexpr std::uint32_t kMax = card_map::find_register(card_map::reg::step_length(0)).entry->mask;
  const std::uint64_t clocks = clocks_of(time, clock_hz, what);
  if (clocks > kMax) {
    throw ArgumentError(fmt::format("{}: {} ns, {} clocks at {} Hz, is outside 0 .. {} clocks", what, time.count(),
                                    clocks, clock_hz, kMax));
  }
  return static_cast<std::uint32_t>(clocks);
}

}  // namespace trammel::driver
