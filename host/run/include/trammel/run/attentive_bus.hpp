// A bus whose sleeps are short and call a function after each: so one thread serves others while a run waits for the
// card. Not thread-safe.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>

#include "trammel/driver/bus.hpp"

namespace trammel::run {

class AttentiveBus final : public driver::Bus {
 public:
  // `bus` must outlive it. `longest`: of a sleep before the function is called, above 0.
  AttentiveBus(driver::Bus& bus, std::chrono::nanoseconds longest) : bus_(bus), longest_(longest) {}
  // Called after each sleep, never from within itself. What it throws passes through sleep().
  void set_meanwhile(std::function<void()> meanwhile) { meanwhile_ = std::move(meanwhile); }

  std::size_t transfer(driver::Access* accesses, std::size_t count) override { return bus_.transfer(accesses, count); }
  void sleep(std::chrono::nanoseconds time) override;
  bool reports_refusals() const override { return bus_.reports_refusals(); }
  std::string hold_origin() const override { return bus_.hold_origin(); }

 private:
  driver::Bus& bus_;
  std::chrono::nanoseconds longest_;
  std::function<void()> meanwhile_;
  bool inside_ = false;  // of `meanwhile_`
};

}  // namespace trammel::run
