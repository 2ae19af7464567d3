// The lockstep engine for a given Verilated card: for tests of the lockstep itself.
#pragma once

#include <memory>

#include "trammel/sim/engines.hpp"
#include "verilated_card.hpp"

namespace trammel::sim {

// `card` has options.axes axes; options.kind is ignored. With a trace the RTL follows the model clock by clock.
std::unique_ptr<Engine> make_rtl_engine(std::unique_ptr<VerilatedCard> card, const SimulationOptions& options);

}  // namespace trammel::sim
