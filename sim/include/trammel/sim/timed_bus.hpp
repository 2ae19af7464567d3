// A bus to a simulated card that adds two features in card time: events scheduled for a clock, and a limit of bytes per
// second. Both engines behave identically, clock by clock. Not thread-safe.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>

#include "trammel/sim/engine.hpp"

namespace trammel::sim {

class TimedBus final : public driver::Bus {
 public:
  static constexpr unsigned kBytesOfAccess = 4;  // data bytes per access; addresses are not counted

  // `engine` must outlive the bus; it runs `clock_hz` clocks per second. `bytes_per_second`: the capacity of the bus in
  // card time; infinite: no limit. Throws std::invalid_argument unless it is greater than 0.
  TimedBus(Engine& engine, std::uint32_t clock_hz, double bytes_per_second);

  // Schedules `event` for clock `cycle` since reset. During a wait it is called in that clock. During an access of the
  // host it is called in the clock in which the access has been answered, at most some 20 clocks later. The event has
  // exclusive use of the card, and its accesses do not count for the limit. Events of one clock are called in the order
  // of their scheduling; an event whose clock has passed is called at the next access or wait. An event may call at().
  void at(std::uint64_t cycle, std::function<void(Engine&)> event) { events_.emplace(cycle, std::move(event)); }

  std::size_t transfer(driver::Access* accesses, std::size_t count) override;
  void sleep(std::chrono::nanoseconds time) override;
  bool reports_refusals() const override { return engine_.reports_refusals(); }
  bool has_interrupt() const override { return engine_.has_interrupt(); }
  bool wait_for_interrupt(std::chrono::nanoseconds longest) override;

 private:
  void run_due_events();
  void run_until(std::uint64_t cycle);

  Engine& engine_;
  std::uint32_t clock_hz_;
  double clocks_of_access_;  // smallest number of clocks per access
  double free_ = 0;          // clock from which the bus accepts the next access
  std::multimap<std::uint64_t, std::function<void(Engine&)>> events_;
};

}  // namespace trammel::sim
