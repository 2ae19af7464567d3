// The pins of a card's host ports, which host_ports and card_with_ports name alike.
#pragma once

#include <cstdint>

#include "trammel/model/host_ports.hpp"

namespace trammel::lockstep {

template <class Dut>
void drive_hosts(Dut& dut, const model::HostPorts::Inputs& in) {
  dut.awvalid_i = in.axi.awvalid;
  dut.awaddr_i = static_cast<std::uint16_t>(in.axi.awaddr);
  dut.wvalid_i = in.axi.wvalid;
  dut.wdata_i = in.axi.wdata;
  dut.wstrb_i = in.axi.wstrb;
  dut.bready_i = in.axi.bready;
  dut.arvalid_i = in.axi.arvalid;
  dut.araddr_i = static_cast<std::uint16_t>(in.axi.araddr);
  dut.rready_i = in.axi.rready;
  const model::WishbonePort::Inputs& w = in.wishbone;
  dut.wishbone_i = std::uint64_t{w.cyc} << 50 | std::uint64_t{w.stb} << 49 | std::uint64_t{w.we} << 48 |
                   std::uint64_t{w.sel} << 44 | std::uint64_t{w.adr} << 32 | w.dat;
  dut.rx_i = in.rx;
  dut.spi_i = static_cast<std::uint8_t>(unsigned{in.spi.mosi} << 2 | unsigned{in.spi.cs_n} << 1 | unsigned{in.spi.sck});
}

// Handshakes and responses of AXI4-Lite: {rresp, bresp, rvalid, arready, bvalid, wready, awready}.
template <class Dut>
std::uint32_t axi_shown(const Dut& dut) {
  return std::uint32_t{dut.awready_o} | std::uint32_t{dut.wready_o} << 1 | std::uint32_t{dut.bvalid_o} << 2 |
         std::uint32_t{dut.arready_o} << 3 | std::uint32_t{dut.rvalid_o} << 4 | std::uint32_t{dut.bresp_o} << 5 |
         std::uint32_t{dut.rresp_o} << 7;
}
inline std::uint32_t axi_shown(const model::Axi4LitePort::Outputs& axi) {
  return std::uint32_t{axi.awready} | std::uint32_t{axi.wready} << 1 | std::uint32_t{axi.bvalid} << 2 |
         std::uint32_t{axi.arready} << 3 | std::uint32_t{axi.rvalid} << 4 | std::uint32_t{axi.bresp} << 5 |
         std::uint32_t{axi.rresp} << 7;
}

}  // namespace trammel::lockstep
