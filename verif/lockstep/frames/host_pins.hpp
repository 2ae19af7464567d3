// The pins of a card's host ports, which have the same names in host_ports and card_with_ports.
#pragma once

#include <cstdint>

#include "trammel/model/host_ports.hpp"
#include "wires.hpp"

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
  dut.wishbone_i = wishbone_wire(in.wishbone);
  dut.rx_i = in.rx;
  dut.sck_i = in.spi.sck;
  dut.cs_n_i = in.spi.cs_n;
  dut.mosi_i = in.spi.mosi;
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

// The same for Wishbone: acknowledgement, error, stall.
inline std::uint64_t wishbone_shown(std::uint64_t answer) {
  return answer & ~in_place(bus::wishbone_answer::kDat, ~0U);
}
inline std::uint64_t wishbone_shown(const model::WishbonePort::Outputs& w) {
  using namespace bus::wishbone_answer;
  return in_place(kAck, w.ack) | in_place(kErr, w.err) | in_place(kStall, w.stall);
}

}  // namespace trammel::lockstep
