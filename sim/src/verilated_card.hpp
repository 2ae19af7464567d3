// A small interface to the Verilated card, so that only the files that build a variant include Verilator's headers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "card_record.hpp"
#include "trammel/model/card_model.hpp"
#include "trammel/sim/engines.hpp"

namespace trammel::sim {

class VerilatedCard {
 public:
  virtual ~VerilatedCard() = default;
  // Runs `clocks` rising edges with the same inputs. The state of the ports after each goes to records[0 .. clocks -
  // 1].
  virtual void run(const model::CardModel::Inputs& in, std::size_t clocks, CardRecord* records) = 0;
};

// The card's constant inputs.
struct CardStraps {
  std::uint32_t clock_hz = 1'000'000;
  std::uint32_t idle_level = 0;      // idle levels: {second pins, first pins}
  std::uint32_t output_idle = 0;     // idle levels of the outputs
  bool emergency_stop_level = true;  // level of the emergency stop's pin that means stop
};

// Axes: 1 to 8; with a trace 4 or 8. `trace`: an FST file, written until the card is destroyed.
// Throws std::invalid_argument for other numbers of axes.
std::unique_ptr<VerilatedCard> make_verilated_card(unsigned axes, const CardStraps& straps,
                                                   const std::optional<TraceFile>& trace);

// The variants that are built, each in its own file.
template <unsigned kAxes>
std::unique_ptr<VerilatedCard> make_card(const CardStraps& straps);
template <unsigned kAxes>
std::unique_ptr<VerilatedCard> make_traced_card(const CardStraps& straps, const TraceFile& trace);

template <>
std::unique_ptr<VerilatedCard> make_card<1>(const CardStraps& straps);
template <>
std::unique_ptr<VerilatedCard> make_card<2>(const CardStraps& straps);
template <>
std::unique_ptr<VerilatedCard> make_card<3>(const CardStraps& straps);
template <>
std::unique_ptr<VerilatedCard> make_card<4>(const CardStraps& straps);
template <>
std::unique_ptr<VerilatedCard> make_card<5>(const CardStraps& straps);
template <>
std::unique_ptr<VerilatedCard> make_card<6>(const CardStraps& straps);
template <>
std::unique_ptr<VerilatedCard> make_card<7>(const CardStraps& straps);
template <>
std::unique_ptr<VerilatedCard> make_card<8>(const CardStraps& straps);
template <>
std::unique_ptr<VerilatedCard> make_traced_card<4>(const CardStraps& straps, const TraceFile& trace);
template <>
std::unique_ptr<VerilatedCard> make_traced_card<8>(const CardStraps& straps, const TraceFile& trace);

}  // namespace trammel::sim
