#include "Vcard4.h"
#include "card_variant.hpp"

namespace trammel::sim {

std::unique_ptr<VerilatedCard> make_card_4(std::uint32_t clock_hz) {
  return std::make_unique<CardVariant<Vcard4, 4>>(clock_hz);
}

}  // namespace trammel::sim
