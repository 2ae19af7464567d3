// Properties and speed of a simulated card, before it is made. Thread-safe.
#pragma once

#include "trammel/planner/card_limits.hpp"
#include "trammel/sim/engines.hpp"

namespace trammel::simulation {

// The limits, for a planner, of the card that sim::make_engine() would make with these options: those that a card on a
// link reports, and the number of outputs. Throws std::invalid_argument for options out of range.
planner::CardLimits limits_of(const sim::EngineOptions& engine);

// Axes of the smallest card that can be traced and has at least `axes` (1 to 8).
unsigned traced_axes(unsigned axes);

// Measures how many clocks of such a card are simulated per second on this host now, without a trace; takes 0.3 s. All
// axes move meanwhile, with a step in some 20 clocks each, as in a typical program. Throws as sim::make_engine() does.
double clocks_per_second(sim::SimulationOptions options);

}  // namespace trammel::simulation
