// The levels of the card's pins in one clock, in bundles, one for each side of a port. Plain data.
#pragma once

#include <cstdint>

namespace trammel::platform {

inline constexpr unsigned kAxes = 4;
inline constexpr unsigned kBreakBits = 10;  // serial line: a break is 2^10 clocks

struct AxiMaster {
  bool awvalid = false;
  bool wvalid = false;
  bool bready = false;
  bool arvalid = false;
  bool rready = false;
  std::uint8_t wstrb = 0;
  std::uint16_t awaddr = 0;
  std::uint16_t araddr = 0;
  std::uint32_t wdata = 0;

  bool operator==(const AxiMaster& o) const {
    return awvalid == o.awvalid && wvalid == o.wvalid && bready == o.bready && arvalid == o.arvalid &&
           rready == o.rready && wstrb == o.wstrb && awaddr == o.awaddr && araddr == o.araddr && wdata == o.wdata;
  }
};
struct AxiCard {
  bool awready = false;
  bool wready = false;
  bool bvalid = false;
  bool arready = false;
  bool rvalid = false;
  std::uint8_t bresp = 0;
  std::uint8_t rresp = 0;
  std::uint32_t rdata = 0;

  bool operator==(const AxiCard& o) const {
    return awready == o.awready && wready == o.wready && bvalid == o.bvalid && arready == o.arready &&
           rvalid == o.rvalid && bresp == o.bresp && rresp == o.rresp && rdata == o.rdata;
  }
};

struct WishboneMaster {
  bool cyc = false;
  bool stb = false;
  bool we = false;
  std::uint8_t sel = 0;
  std::uint16_t adr = 0;
  std::uint32_t dat = 0;

  bool operator==(const WishboneMaster& o) const {
    return cyc == o.cyc && stb == o.stb && we == o.we && sel == o.sel && adr == o.adr && dat == o.dat;
  }
};
struct WishboneCard {
  bool ack = false;
  bool err = false;
  bool stall = false;
  std::uint32_t dat = 0;

  bool operator==(const WishboneCard& o) const {
    return ack == o.ack && err == o.err && stall == o.stall && dat == o.dat;
  }
};

struct SpiMaster {
  bool sck = true;
  bool cs_n = true;
  bool mosi = false;

  bool operator==(const SpiMaster& o) const { return sck == o.sck && cs_n == o.cs_n && mosi == o.mosi; }
};
struct SpiCard {
  bool miso = true;
  bool enable = false;

  bool operator==(const SpiCard& o) const { return miso == o.miso && enable == o.enable; }
};

// The inputs of the card from the host and the machine, and its outputs.
struct CardInputs {
  bool rst = false;
  AxiMaster axi;
  WishboneMaster wishbone;
  bool rx = true;
  SpiMaster spi;
  std::uint16_t inputs = 0;
};
struct CardOutputs {
  AxiCard axi;
  WishboneCard wishbone;
  bool tx = true;
  SpiCard spi;
  std::uint8_t step = 0;  // a bit per axis
  std::uint8_t dir = 0;
  std::uint8_t outputs = 0;
  bool irq = false;
};

}  // namespace trammel::platform
