// The operator's events on a simulated card, and what became of them. Not thread-safe.
#pragma once

#include <cstdint>
#include <vector>

#include "trammel/sim/timed_bus.hpp"
#include "trammel/simulation/operation.hpp"

namespace trammel::simulation {

class OperatorTimeline {
 public:
  OperatorTimeline(const Operation& operation, double max_percent) : operation_(operation), max_percent_(max_percent) {}

  // Before the first access: the card has its overrides before anybody else writes to it. What is overridden are
  // motions with a feed (all motions where the card has no classes of pieces), by another share rapids; fixed pieces
  // run at 100 %. `bus` calls this object until it is gone.
  void schedule(sim::TimedBus& bus, std::uint32_t clock_hz);
  // Those whose time has come, in order.
  const std::vector<MadeEvent>& made() const { return made_; }

 private:
  void make(const OperatorEvent& event, sim::Engine& engine);

  const Operation& operation_;
  double max_percent_;
  std::vector<MadeEvent> made_;
};

}  // namespace trammel::simulation
