#include "verilated_card.hpp"

#include <stdexcept>

namespace trammel::sim {

std::unique_ptr<VerilatedCard> make_verilated_card(unsigned axes, const CardStraps& straps,
                                                   const std::optional<TraceFile>& trace) {
  if (trace) {
    if (axes == 4) return make_traced_card<4>(straps, *trace);
    if (axes == 8) return make_traced_card<8>(straps, *trace);
    throw std::invalid_argument("the traced card is built with 4 and with 8 axes");
  }
  constexpr std::unique_ptr<VerilatedCard> (*kMake[])(const CardStraps&) = {
      make_card<1>, make_card<2>, make_card<3>, make_card<4>, make_card<5>, make_card<6>, make_card<7>, make_card<8>};
  if (axes < 1 || axes > std::size(kMake)) throw std::invalid_argument("a card has 1 to 8 axes");
  return kMake[axes - 1](straps);
}

}  // namespace trammel::sim
