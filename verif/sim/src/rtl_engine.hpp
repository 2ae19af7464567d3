// The lockstep engine over a given Verilated card: what the tests put a card with a seeded bug into.
#pragma once

#include <memory>

#include "trammel/sim/engine.hpp"
#include "verilated_card.hpp"

namespace trammel::sim {

// `card` has options.axes axes; kind and trace are not looked at.
std::unique_ptr<Engine> make_rtl_engine(std::unique_ptr<VerilatedCard> card, const EngineOptions& options);

}  // namespace trammel::sim
