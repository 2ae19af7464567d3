// A card's bus that fails after a given clock.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "trammel/driver/bus.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::run {

class DyingBus final : public driver::Bus {
 public:
  DyingBus(sim::Engine& engine, std::uint64_t last_cycle) : engine_(engine), last_cycle_(last_cycle) {}
  std::size_t transfer(driver::Access* accesses, std::size_t count) override {
    if (engine_.cycles() > last_cycle_) throw driver::LinkError("the cable is out");
    return engine_.transfer(accesses, count);
  }
  void sleep(std::chrono::nanoseconds time) override { engine_.sleep(time); }
  bool reports_refusals() const override { return engine_.reports_refusals(); }

 private:
  sim::Engine& engine_;
  std::uint64_t last_cycle_;
};

}  // namespace trammel::run
