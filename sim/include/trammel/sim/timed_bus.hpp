// The bus of a simulated card on which things happen at times of the card's own: what is scheduled for a clock, and a
// limit of bytes a second. Both engines make the same of it, clock by clock. Not thread-safe.
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
  static constexpr unsigned kBytesOfAccess = 4;  // read or written, addresses not counted

  // `engine` must outlive the bus, and has `clock_hz` clocks a second. `bytes_per_second`: what the bus carries in card
  // time; infinite: as fast as the card answers. Throws std::invalid_argument unless it is greater than 0.
  TimedBus(Engine& engine, std::uint32_t clock_hz, double bytes_per_second);

  // `event` is called when clock `cycle` since reset has come: in a wait in that clock, beside an access of the host in
  // the clock in which that has been answered, some 20 clocks later at most. It has the card for itself, and its
  // accesses do not count for the limit. Of several at one clock the first scheduled comes first; one whose clock has
  // gone comes at the next access or wait. May be called from an event.
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
  double clocks_of_access_;  // at least
  double free_ = 0;          // clock from which on the bus takes the next access
  std::multimap<std::uint64_t, std::function<void(Engine&)>> events_;
};

}  // namespace trammel::sim
