#include "Vtraced8.h"
#include "traced_variant.hpp"

namespace trammel::sim {

std::unique_ptr<VerilatedCard> make_traced_card_8(std::uint32_t clock_hz, const std::string& trace) {
  return std::make_unique<TracedVariant<Vtraced8, 8>>(clock_hz, trace);
}

}  // namespace trammel::sim
