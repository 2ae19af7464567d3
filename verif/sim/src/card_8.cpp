#include "Vcard8.h"
#include "card_variant.hpp"

namespace trammel::sim {

std::unique_ptr<VerilatedCard> make_card_8(std::uint32_t clock_hz) {
  return std::make_unique<CardVariant<Vcard8, 8>>(clock_hz);
}

}  // namespace trammel::sim
