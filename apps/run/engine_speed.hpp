// Estimates how long a simulated card will take for a program, before it starts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "trammel/sim/engines.hpp"

namespace trammel::app {

// Card time that a limited bus takes for this many commands, roughly, s; 0 without a limit (infinity).
double bus_seconds(double bytes_per_second, std::uint64_t commands);

// A note if the bus takes longer for the commands than the motion lasts.
std::optional<std::string> slow_bus_note(double bytes_per_second, std::uint64_t commands, double planned_seconds);

// A note if a run of `card_seconds` would take the RTL engine minutes on this machine. The speed of such a card is
// measured by this call (0.3 s of work). None for shorter runs and for the model engine.
std::optional<std::string> long_run_note(const sim::SimulationOptions& options, double card_seconds);

}  // namespace trammel::app
