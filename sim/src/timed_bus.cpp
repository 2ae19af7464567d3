#include "trammel/sim/timed_bus.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "trammel/driver/card_timing.hpp"

namespace trammel::sim {

TimedBus::TimedBus(Engine& engine, std::uint32_t clock_hz, double bytes_per_second)
    : engine_(engine),
      clock_hz_(clock_hz),
      clocks_of_access_(kBytesOfAccess * static_cast<double>(clock_hz) / bytes_per_second) {
  if (!(bytes_per_second > 0)) throw std::invalid_argument("a bus that carries nothing");
}

std::size_t TimedBus::transfer(driver::Access* accesses, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    run_due_events();
    // If the bus became free in this clock, the next access follows without a gap, also for fractions of a clock.
    const auto now = static_cast<double>(engine_.cycles());
    if (now - free_ >= 1) free_ = now;
    free_ += clocks_of_access_;
    const bool made = engine_.transfer(accesses + i, 1) == 1;
    run_until(static_cast<std::uint64_t>(std::ceil(free_)));
    if (!made) return i;
  }
  return count;
}

void TimedBus::sleep(std::chrono::nanoseconds time) {
  run_until(engine_.cycles() + driver::clocks_of(time, clock_hz_, "sleep"));
}

bool TimedBus::wait_for_interrupt(std::chrono::nanoseconds longest) {
  const std::uint64_t end = engine_.cycles() + driver::clocks_of(longest, clock_hz_, "wait");
  for (;;) {
    run_due_events();
    const std::uint64_t now = engine_.cycles();
    const std::uint64_t next = events_.empty() ? end : std::min(end, events_.begin()->first);
    const std::uint64_t clocks = next > now ? next - now : 0;
    if (engine_.wait_for_interrupt(driver::time_of(clocks, clock_hz_))) return true;
    if (engine_.cycles() >= end) return false;
  }
}

void TimedBus::run_due_events() {
  while (!events_.empty() && events_.begin()->first <= engine_.cycles()) {
    const auto event = std::move(events_.begin()->second);
    events_.erase(events_.begin());
    event(engine_);
  }
}

// An event that takes longer than the rest of the wait prolongs the wait.
void TimedBus::run_until(std::uint64_t cycle) {
  for (;;) {
    run_due_events();
    const std::uint64_t now = engine_.cycles();
    if (now >= cycle) return;
    engine_.wait((events_.empty() ? cycle : std::min(cycle, events_.begin()->first)) - now);
  }
}

}  // namespace trammel::sim
