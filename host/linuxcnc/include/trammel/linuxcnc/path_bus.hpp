// A bus whose sleeps are short and call a function after each: so one thread serves LinuxCNC's memory while a run of
// the planner waits for the card. Not thread-safe.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>

#include "trammel/driver/bus.hpp"

namespace trammel::linuxcnc {

class PathBus final : public driver::Bus {
 public:
  // `bus` must outlive it.
  explicit PathBus(driver::Bus& bus) : bus_(bus) {}
  // Called after each sleep of at most a millisecond, never from within itself. What it throws passes through sleep().
  void set_meanwhile(std::function<void()> meanwhile) { meanwhile_ = std::move(meanwhile); }

  std::size_t transfer(driver::Access* accesses, std::size_t count) override { return bus_.transfer(accesses, count); }
  void sleep(std::chrono::nanoseconds time) override;
  bool reports_refusals() const override { return bus_.reports_refusals(); }
  std::string hold_origin() const override { return bus_.hold_origin(); }

 private:
  driver::Bus& bus_;
  std::function<void()> meanwhile_;
  bool inside_ = false;  // of `meanwhile_`
};

}  // namespace trammel::linuxcnc
