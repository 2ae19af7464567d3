// The inputs of the Verilated card, whatever its class.
#pragma once

#include <cstdint>

#include "trammel/model/card_model.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::sim {

template <class Dut>
void set_inputs(Dut& dut, const model::CardModel::Inputs& in) {
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
  dut.input_i = static_cast<std::uint8_t>(in.pins & ((1U << kPins) - 1));
}

}  // namespace trammel::sim
