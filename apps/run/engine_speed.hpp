// Estimates how long the Verilated card will take for a program, before it starts.
#pragma once

#include <optional>
#include <string>

#include "trammel/sim/engines.hpp"

namespace trammel::app {

// A note if a run of `card_seconds` would take the RTL engine minutes on this machine. The speed of such a card is
// measured by this call (0.3 s of work). None for shorter runs and for the model engine.
std::optional<std::string> long_run_note(const sim::SimulationOptions& options, double card_seconds);

}  // namespace trammel::app
