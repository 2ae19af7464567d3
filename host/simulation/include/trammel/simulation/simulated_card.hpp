// The simulated card before it is made: what it has, and how fast it goes. Any thread.
#pragma once

#include "trammel/planner/card_limits.hpp"
#include "trammel/sim/engines.hpp"

namespace trammel::simulation {

// What a planner has to know of the card that sim::make_engine() would make of these options.
planner::CardLimits limits_of(const sim::EngineOptions& engine);

// Axes of the smallest card that can be traced and has `axes` (1 to 8).
unsigned traced_axes(unsigned axes);

// How many of such a card's clocks are simulated in a second on this machine now, without a trace: takes 0.3 s. All its
// axes move meanwhile, with a step in some 20 clocks: programs are about as busy. Throws as sim::make_engine() does.
double clocks_per_second(sim::SimulationOptions options);

}  // namespace trammel::simulation
