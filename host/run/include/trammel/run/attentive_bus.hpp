// A bus that divides each sleep into short ones and calls a function after each of them. One thread can thus serve
// other clients while a run waits for the card. Not thread-safe.
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
  // `bus` must outlive this object. `longest`: the longest sleep between two calls of the function, above 0.
  AttentiveBus(driver::Bus& bus, std::chrono::nanoseconds longest) : bus_(bus), longest_(longest) {}
  // `meanwhile` is called after each short sleep, but never from within itself. Its exceptions pass through sleep().
  void set_meanwhile(std::function<void()> meanwhile) { meanwhile_ = std::move(meanwhile); }

  std::size_t transfer(driver::Access* accesses, std::size_t count) override { return bus_.transfer(accesses, count); }
  void sleep(std::chrono::nanoseconds time) override;
  bool reports_refusals() const override { return bus_.reports_refusals(); }
  std::string hold_origin() const override { return bus_.hold_origin(); }

 private:
  driver::Bus& bus_;
  std::chrono::nanoseconds longest_;
  std::function<void()> meanwhile_;
  bool inside_ = false;  // `meanwhile_` is running
};

}  // namespace trammel::run
