#include "verilated_card.hpp"

#include <stdexcept>

namespace trammel::sim {

std::unique_ptr<VerilatedCard> make_verilated_card(unsigned axes, std::uint32_t clock_hz,
                                                   const std::optional<std::string>& trace) {
  if (axes == 4) return trace ? make_traced_card_4(clock_hz, *trace) : make_card_4(clock_hz);
  if (axes == 8) return trace ? make_traced_card_8(clock_hz, *trace) : make_card_8(clock_hz);
  throw std::invalid_argument("the Verilated card is built with 4 and with 8 axes");
}

}  // namespace trammel::sim
