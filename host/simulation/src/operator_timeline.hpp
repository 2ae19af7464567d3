// Applies the operator's events to a simulated card and records when. Not thread-safe.
#pragma once

#include <cstdint>
#include <vector>

#include "trammel/sim/timed_bus.hpp"
#include "trammel/simulation/operation.hpp"

namespace trammel::simulation {

class OperatorTimeline {
 public:
  OperatorTimeline(const Operation& operation, double max_percent) : operation_(operation), max_percent_(max_percent) {}

  // Call before the first access, so that the card has its overrides before anything else writes to it. Motions with a
  // feed have one override, rapids another; fixed pieces run at 100 %. On a card without classes of pieces, the
  // override of feeds holds for all motions. `bus` calls this object as long as the bus exists.
  void schedule(sim::TimedBus& bus, std::uint32_t clock_hz);
  // The events whose time has come, in order.
  const std::vector<MadeEvent>& made() const { return made_; }

 private:
  void make(const OperatorEvent& event, sim::Engine& engine);

  const Operation& operation_;
  double max_percent_;
  std::vector<MadeEvent> made_;
};

}  // namespace trammel::simulation
