// How long the Verilated card will take for a program, said before it starts.
#pragma once

#include <optional>
#include <string>

#include "trammel/sim/engines.hpp"

namespace trammel::app {

// A note for people when a run of so many seconds of card time would take the RTL engine minutes on this machine, by
// the speed of such a card measured now (0.3 s of work); nothing for shorter runs and for the model engine.
std::optional<std::string> long_run_note(const sim::SimulationOptions& options, double card_seconds);

}  // namespace trammel::app
