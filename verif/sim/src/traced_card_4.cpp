#include "Vtraced4.h"
#include "traced_variant.hpp"

namespace trammel::sim {

std::unique_ptr<VerilatedCard> make_traced_card_4(std::uint32_t clock_hz, const std::string& trace) {
  return std::make_unique<TracedVariant<Vtraced4, 4>>(clock_hz, trace);
}

}  // namespace trammel::sim
