// Sets the inputs of the Verilated card, for any of its classes.
#pragma once

#include <cstdint>
#include <type_traits>

#include "trammel/model/card_model.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::sim {

// `inputs`: number of the card's inputs.
template <class Dut>
void set_inputs(Dut& dut, const model::CardModel::Inputs& in, unsigned inputs = kInputs) {
  dut.rst_i = in.rst;
  dut.awvalid_i = in.awvalid;
  dut.awaddr_i = static_cast<std::uint16_t>(in.awaddr);
  dut.wvalid_i = in.wvalid;
  dut.wdata_i = in.wdata;
  dut.wstrb_i = in.wstrb;
  dut.bready_i = in.bready;
  dut.arvalid_i = in.arvalid;
  dut.araddr_i = static_cast<std::uint16_t>(in.araddr);
  dut.rready_i = in.rready;
  dut.emergency_stop_i = in.emergency_stop;
  dut.input_i = static_cast<std::remove_reference_t<decltype(dut.input_i)>>(in.pins & ((1U << inputs) - 1));
}

}  // namespace trammel::sim
