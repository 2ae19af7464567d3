// The Verilated card behind one small interface: Verilator's headers stay in the files that build a variant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "card_record.hpp"
#include "trammel/model/card_model.hpp"

namespace trammel::sim {

class VerilatedCard {
 public:
  virtual ~VerilatedCard() = default;
  // `clocks` rising edges with the same inputs; what the ports show behind each goes to records[0 .. clocks - 1].
  virtual void run(const model::CardModel::Inputs& in, std::size_t clocks, CardRecord* records) = 0;
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
