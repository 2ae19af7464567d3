// The operator's events on a simulated card, and what became of them. Not thread-safe.
#pragma once

#include <cstdint>
#include <vector>

#include "motion_options.hpp"
#include "trammel/sim/timed_bus.hpp"

namespace trammel::app {

struct MadeEvent {
  OperatorEvent event;
  // Clock of the card in which the write was answered, and had taken effect; of an input, in which it changed.
  std::uint64_t cycle = 0;
};

class OperatorTimeline {
 public:
  OperatorTimeline(const Operation& operation, double most_percent) : operation_(operation), most_(most_percent) {}

  // Before the first access: the card has its overrides before anybody else writes to it. What is overridden are
  // motions with a feed (all motions where the card has no classes of pieces), by another share rapids; fixed pieces
  // run at 100 %. `bus` calls this object until it is gone.
  void schedule(sim::TimedBus& bus, std::uint32_t clock_hz);
  // Those whose time has come, in order.
  const std::vector<MadeEvent>& made() const { return made_; }

 private:
  void make(const OperatorEvent& event, sim::Engine& engine);

  const Operation& operation_;
  double most_;
  std::vector<MadeEvent> made_;
  std::uint16_t inputs_ = 0;  // levels at the card's pins
};

}  // namespace trammel::app
