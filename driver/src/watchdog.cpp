#include "trammel/driver/low_level/watchdog.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "trammel/card_map.hpp"
#include "trammel/driver/card_timing.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/watchdog_scope.hpp"

namespace trammel::driver {

namespace {

constexpr std::uint64_t kUnitClocks = 65'536;
constexpr std::uint64_t kMaxUnits = 0xFFFF;
constexpr unsigned kMapMinorOfLinkTimeout = 5;  // LINK_TIMEOUT came with map 3.5

}  // namespace

void Watchdog::set(std::chrono::nanoseconds time) {
  const std::uint64_t clocks = clocks_of(time, card_.clock_hz, "watchdog");
  const std::uint64_t units = clocks / kUnitClocks + (clocks % kUnitClocks != 0 ? 1 : 0);
  if (units > kMaxUnits) {
    const auto most =
        std::chrono::duration_cast<std::chrono::milliseconds>(time_of(kMaxUnits * kUnitClocks, card_.clock_hz));
    throw ArgumentError(fmt::format("watchdog: {} ms: this card takes up to {} ms",
                                    std::chrono::duration_cast<std::chrono::milliseconds>(time).count(), most.count()));
  }
  units_ = static_cast<std::uint32_t>(units);
  pace_ = time / 4;
  write();
}

void Watchdog::look() {
  if (units_ == 0) return;
  if (++looks_ < kLooks && std::chrono::steady_clock::now() - written_ < pace_) return;
  write();
}

void Watchdog::write() {
  looks_ = 0;
  written_ = std::chrono::steady_clock::now();
  std::array<Access, kRestarts + 1> accesses{};
  const auto times = restart();
  std::copy(times.begin(), times.end(), accesses.begin());
  registers_.transfer(accesses.data(), restarts(), "watchdog");
}

// LINK_TIMEOUT is written each time: after a new connection the write tells the card that this session is the writing
// one.
std::array<Access, Watchdog::kRestarts> Watchdog::restart() const {
  return {write_of(card_map::reg::kWatchdog, units_), write_of(card_map::reg::kLinkTimeout, units_)};
}

std::size_t Watchdog::restarts() const { return card_.map_minor >= kMapMinorOfLinkTimeout ? 2 : 1; }

WatchdogScope::~WatchdogScope() {
  // If the link fails, the card is left to its watchdog.
  try {
    if (!card_.busy()) card_.set_watchdog(std::chrono::nanoseconds(0));
  } catch (...) {
  }
}

}  // namespace trammel::driver
