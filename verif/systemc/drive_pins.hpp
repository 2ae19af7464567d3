// Puts the host's side on the pins of a Verilated top. The card and the checkers of its ports take the same pins.
#pragma once

#include <cstdint>

#include "pins.hpp"

namespace trammel::platform {

// The bus as rtl/host/wishbone has it: {cyc, stb, we, sel, adr, dat}.
inline std::uint64_t bits_of(const WishboneMaster& m) {
  return std::uint64_t{m.cyc} << 50 | std::uint64_t{m.stb} << 49 | std::uint64_t{m.we} << 48 |
         std::uint64_t{m.sel} << 44 | std::uint64_t{m.adr} << 32 | m.dat;
}

// {mosi, cs_n, sck}
inline std::uint8_t bits_of(const SpiMaster& m) {
  return static_cast<std::uint8_t>(unsigned{m.mosi} << 2 | unsigned{m.cs_n} << 1 | unsigned{m.sck});
}

// The pins with the same names in both tops: reset, AXI4-Lite and the serial line.
template <class Dut>
void drive_shared(Dut& dut, const CardInputs& in) {
  dut.rst_i = in.rst;
  dut.awvalid_i = in.axi.awvalid;
  dut.awaddr_i = in.axi.awaddr;
  dut.wvalid_i = in.axi.wvalid;
  dut.wdata_i = in.axi.wdata;
  dut.wstrb_i = in.axi.wstrb;
  dut.bready_i = in.axi.bready;
  dut.arvalid_i = in.axi.arvalid;
  dut.araddr_i = in.axi.araddr;
  dut.rready_i = in.axi.rready;
  dut.rx_i = in.rx;
}

}  // namespace trammel::platform
