// The Verilated card behind one small interface: Verilator's headers stay in the files that build a variant.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "trammel/model/card_model.hpp"

namespace trammel::sim {

class VerilatedCard {
 public:
  // All that the card's ports show, as the golden model names it.
  struct Ports {
    model::CardModel::Outputs card;
    model::Axi4LitePort::Outputs bus;  // the part at the card's pins
    std::array<std::uint32_t, model::CardModel::kMaxAxes> position{};
  };

  virtual ~VerilatedCard() = default;
  // One rising edge.
  virtual void clock(const model::CardModel::Inputs& in) = 0;
  virtual void read(Ports& ports) = 0;
};

// Axes: 4 or 8, the variants that are built. `trace`: an FST file, written until the card is destroyed.
// Throws std::invalid_argument for other numbers of axes.
std::unique_ptr<VerilatedCard> make_verilated_card(unsigned axes, std::uint32_t clock_hz,
                                                   const std::optional<std::string>& trace);

std::unique_ptr<VerilatedCard> make_card_4(std::uint32_t clock_hz);
std::unique_ptr<VerilatedCard> make_card_8(std::uint32_t clock_hz);
std::unique_ptr<VerilatedCard> make_traced_card_4(std::uint32_t clock_hz, const std::string& trace);
std::unique_ptr<VerilatedCard> make_traced_card_8(std::uint32_t clock_hz, const std::string& trace);

}  // namespace trammel::sim
