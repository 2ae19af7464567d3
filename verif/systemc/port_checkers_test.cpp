// Every rule of the checkers (checkers/*.sv) is broken and detected; correct traffic breaks none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "pin_models.hpp"

namespace trammel::platform {
namespace {

constexpr std::uint32_t kPeriod = 80;  // clocks per 8 bits
constexpr unsigned kBit = kPeriod / 8;
constexpr unsigned kBreak = 1U << kBreakBits;

// The pins, clock by clock.
class Bench {
 public:
  CardInputs in;
  CardOutputs out;

  Bench() : checkers_(make_port_checkers()) {
    checkers_->set_serial_period(kPeriod);
    in.rst = true;
    clock(2);
    in.rst = false;
    clock(8);
  }
  void clock(unsigned clocks = 1) {
    for (unsigned i = 0; i < clocks; ++i) checkers_->clock(in, out);
  }
  void classic() { checkers_->set_pipelined(false); }
  std::set<std::string> broken() const { return {checkers_->broken().begin(), checkers_->broken().end()}; }

  // Accesses with a handshake each: accepted in the clock after the request.
  void axi_write_taken() {
    in.axi.awvalid = in.axi.wvalid = true;
    clock();
    out.axi.awready = out.axi.wready = true;
    clock();
    in.axi.awvalid = in.axi.wvalid = out.axi.awready = out.axi.wready = false;
  }
  void axi_read_taken() {
    in.axi.arvalid = true;
    clock();
    out.axi.arready = true;
    clock();
    in.axi.arvalid = out.axi.arready = false;
  }
  void wishbone_asks() { in.wishbone.cyc = in.wishbone.stb = true; }
  void wishbone_taken() {
    wishbone_asks();
    clock();
    in.wishbone.stb = false;
  }
  void selected() {
    in.spi.cs_n = false;
    clock(3);
    out.spi.enable = true;
    clock(5);
  }
  // `bits` periods of SCK, 4 clocks each.
  void spi_bits(unsigned bits) {
    for (unsigned i = 0; i < bits; ++i) {
      in.spi.sck = false;
      in.spi.mosi = i % 2 == 0;
      clock(2);
      in.spi.sck = true;
      clock(2);
    }
  }
  // A byte on a line: its bits including start and stop bit, lowest first.
  void line(bool& level, unsigned bits, unsigned count = 10, unsigned clocks = kBit) {
    for (unsigned i = 0; i < count; ++i) {
      level = (bits >> i & 1) != 0;
      clock(clocks);
    }
    level = true;
    clock(2 * kBit);
  }
  void break_line() {
    in.rx = false;
    clock(kBreak + 4);
    in.rx = true;
    clock(3 * kBit);
  }

 private:
  std::unique_ptr<PortCheckers> checkers_;
};

using Breaks = std::function<void(Bench&)>;

// For each rule, traffic that breaks it and no other rule.
const std::map<std::string, Breaks>& breaks_axi() {
  static const std::map<std::string, Breaks> all = {
      {"AXI4-Lite: the master asks in reset",
       [](Bench& b) {
         b.in.rst = b.in.axi.arvalid = true;
         b.clock();
         b.in.axi.arvalid = false;
         b.clock();
       }},
      {"AXI4-Lite: AWVALID falls before AWREADY",
       [](Bench& b) {
         b.in.axi.awvalid = true;
         b.clock(2);
         b.in.axi.awvalid = false;
         b.clock(2);
       }},
      {"AXI4-Lite: AWADDR changes before AWREADY",
       [](Bench& b) {
         b.in.axi.awvalid = true;
         b.clock(2);
         b.in.axi.awaddr = 4;
         b.clock(2);
       }},
      {"AXI4-Lite: WVALID falls before WREADY",
       [](Bench& b) {
         b.in.axi.wvalid = true;
         b.clock(2);
         b.in.axi.wvalid = false;
         b.clock(2);
       }},
      {"AXI4-Lite: WDATA or WSTRB changes before WREADY",
       [](Bench& b) {
         b.in.axi.wvalid = true;
         b.clock(2);
         b.in.axi.wstrb = 3;
         b.clock(2);
       }},
      {"AXI4-Lite: ARVALID falls before ARREADY",
       [](Bench& b) {
         b.in.axi.arvalid = true;
         b.clock(2);
         b.in.axi.arvalid = false;
         b.clock(2);
       }},
      {"AXI4-Lite: ARADDR changes before ARREADY",
       [](Bench& b) {
         b.in.axi.arvalid = true;
         b.clock(2);
         b.in.axi.araddr = 4;
         b.clock(2);
       }},
  };
  return all;
}

// Over a screen: a table with an entry per rule.
const std::map<std::string, Breaks>& breaks_axi_card() {
  static const std::map<std::string, Breaks> all = {
      {"AXI4-Lite: BVALID falls before BREADY",
       [](Bench& b) {
         b.axi_write_taken();
         b.out.axi.bvalid = true;
         b.clock(2);
         b.out.axi.bvalid = false;
         b.clock(2);
       }},
      {"AXI4-Lite: BRESP changes before BREADY",
       [](Bench& b) {
         b.axi_write_taken();
         b.out.axi.bvalid = true;
         b.clock(2);
         b.out.axi.bresp = 2;
         b.clock(2);
       }},
      {"AXI4-Lite: RVALID falls before RREADY",
       [](Bench& b) {
         b.axi_read_taken();
         b.out.axi.rvalid = true;
         b.clock(2);
         b.out.axi.rvalid = false;
         b.clock(2);
       }},
      {"AXI4-Lite: RDATA or RRESP changes before RREADY",
       [](Bench& b) {
         b.axi_read_taken();
         b.out.axi.rvalid = true;
         b.clock(2);
         b.out.axi.rdata = 1;
         b.clock(2);
       }},
      {"AXI4-Lite: BVALID without a write",
       [](Bench& b) {
         b.axi_read_taken();
         b.out.axi.bvalid = true;
         b.clock(2);
       }},
      {"AXI4-Lite: RVALID without a read",
       [](Bench& b) {
         b.axi_write_taken();
         b.out.axi.rvalid = true;
         b.clock(2);
       }},
      {"AXI4-Lite: BRESP is neither OKAY nor SLVERR",
       [](Bench& b) {
         b.axi_write_taken();
         b.out.axi.bvalid = true;
         b.out.axi.bresp = 3;
         b.clock(2);
       }},
      {"AXI4-Lite: RRESP is neither OKAY nor SLVERR",
       [](Bench& b) {
         b.axi_read_taken();
         b.out.axi.rvalid = true;
         b.out.axi.rresp = 1;
         b.clock(2);
       }},
      {"AXI4-Lite: a write is not answered in time",
       [](Bench& b) {
         b.axi_write_taken();
         b.clock(600);
       }},
      {"AXI4-Lite: a read is not answered in time",
       [](Bench& b) {
         b.axi_read_taken();
         b.clock(600);
       }},
  };
  return all;
}

const std::map<std::string, Breaks>& breaks_wishbone() {
  static const std::map<std::string, Breaks> all = {
      {"Wishbone: the master asks in reset",
       [](Bench& b) {
         b.in.rst = b.in.wishbone.cyc = true;
         b.clock(2);
       }},
      {"Wishbone: STB without CYC",
       [](Bench& b) {
         b.in.wishbone.stb = true;
         b.clock(2);
       }},
      {"Wishbone: a request changes while STALL is high",
       [](Bench& b) {
         b.wishbone_asks();
         b.out.wishbone.stall = true;
         b.clock(2);
         b.in.wishbone.adr = 4;
         b.clock(2);
       }},
      {"Wishbone: a request changes before its answer",
       [](Bench& b) {
         b.classic();
         b.wishbone_asks();
         b.clock(2);
         b.in.wishbone.we = true;
         b.clock(2);
       }},
      {"Wishbone: ACK and ERR together",
       [](Bench& b) {
         b.wishbone_taken();
         b.clock(2);
         b.out.wishbone.ack = b.out.wishbone.err = true;
         b.clock();
         b.out.wishbone.ack = b.out.wishbone.err = false;
         b.clock(2);
       }},
      {"Wishbone: an answer to nothing",
       [](Bench& b) {
         b.out.wishbone.err = true;
         b.clock();
         b.out.wishbone.err = false;
         b.clock(2);
       }},
      {"Wishbone: STALL on a classic bus",
       [](Bench& b) {
         b.classic();
         b.out.wishbone.stall = true;
         b.clock(2);
       }},
      {"Wishbone: an access is not answered in time",
       [](Bench& b) {
         b.wishbone_taken();
         b.clock(600);
       }},
  };
  return all;
}

const std::map<std::string, Breaks>& breaks_spi() {
  static const std::map<std::string, Breaks> all = {
      {"SPI: SCK is faster than a quarter of the clock",
       [](Bench& b) {
         b.selected();
         for (unsigned i = 0; i < 16; ++i) {
           b.in.spi.sck = i % 2 != 0;
           b.clock(1 + i % 2);
         }
       }},
      {"SPI: MOSI changes with SCK's rising edge",
       [](Bench& b) {
         b.selected();
         b.in.spi.sck = false;
         b.clock(2);
         b.in.spi.sck = b.in.spi.mosi = true;
         b.clock(2);
       }},
      {"SPI: SCK rises less than 4 clocks after CS has fallen",
       [](Bench& b) {
         b.in.spi.sck = false;
         b.in.spi.cs_n = false;
         b.clock(2);
         b.in.spi.sck = true;
         b.clock();
         b.out.spi.enable = true;
         b.clock(4);
       }},
      {"SPI: CS turns again within 4 clocks",
       [](Bench& b) {
         b.in.spi.cs_n = false;
         b.clock(2);
         b.in.spi.cs_n = true;
         b.clock(6);
       }},
      {"SPI: CS rises within a byte",
       [](Bench& b) {
         b.selected();
         b.spi_bits(11);
         b.in.spi.cs_n = true;
         b.clock(3);
         b.out.spi.enable = false;
         b.clock(4);
       }},
      {"SPI: MISO changes more than 3 clocks after SCK's rising edge",
       [](Bench& b) {
         b.selected();
         b.spi_bits(2);
         b.clock(4);
         b.out.spi.miso = !b.out.spi.miso;
         b.clock(2);
       }},
      {"SPI: MISO's enable does not follow CS",
       [](Bench& b) {
         b.in.spi.cs_n = false;
         b.clock(8);
       }},
  };
  return all;
}

const std::map<std::string, Breaks>& breaks_uart() {
  static const std::map<std::string, Breaks> all = {
      {"UART: a bit from the host is too short", [](Bench& b) { b.line(b.in.rx, 0x2AA, 10, kBit - 3); }},
      {"UART: a byte from the host has no stop bit", [](Bench& b) { b.line(b.in.rx, 0x054, 11); }},
      {"UART: a break is too short",
       [](Bench& b) {
         b.in.rx = false;
         b.clock(kBreak - 4);
         b.in.rx = true;
         b.clock(4);
       }},
      {"UART: the card speaks before a break", [](Bench& b) { b.line(b.out.tx, 0x2AA); }},
      {"UART: a bit from the card is too short",
       [](Bench& b) {
         b.break_line();
         b.line(b.out.tx, 0x2AA, 10, kBit - 3);
       }},
      {"UART: a byte from the card has no stop bit",
       [](Bench& b) {
         b.break_line();
         b.line(b.out.tx, 0x0AA, 11);
       }},
  };
  return all;
}

std::map<std::string, Breaks> all_breaks() {
  std::map<std::string, Breaks> all;
  for (const auto* some : {&breaks_axi(), &breaks_axi_card(), &breaks_wishbone(), &breaks_spi(), &breaks_uart()})
    all.insert(some->begin(), some->end());
  return all;
}

TEST(PortCheckers, EachRuleIsFoundBroken) {
  for (const auto& [rule, breaks] : all_breaks()) {
    Bench bench;
    EXPECT_EQ(bench.broken(), std::set<std::string>{}) << "before " << rule;
    breaks(bench);
    EXPECT_EQ(bench.broken(), std::set<std::string>{rule});
  }
}

// Checks that the tables above contain every rule of the sources.
TEST(PortCheckers, NoRuleIsLeftOut) {
  std::set<std::string> written;
  const std::string call = "port_rule_broken(\"";
  for (const auto& entry : std::filesystem::directory_iterator(TRAMMEL_CHECKERS_DIR)) {
    std::ifstream file(entry.path());
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    for (std::size_t at = text.find(call); at != std::string::npos; at = text.find(call, at + 1)) {
      const std::size_t begin = at + call.size();
      written.insert(text.substr(begin, text.find('"', begin) - begin));
    }
  }
  std::set<std::string> broken;
  for (const auto& [name, breaks] : all_breaks()) broken.insert(name);
  EXPECT_EQ(written, broken);
}

TEST(PortCheckers, GoodTrafficBreaksNone) {
  Bench b;
  b.axi_write_taken();
  b.clock(3);
  b.out.axi.bvalid = b.in.axi.bready = true;
  b.clock();
  b.out.axi.bvalid = b.in.axi.bready = false;
  b.axi_read_taken();
  b.clock(300);
  b.out.axi.rvalid = true;
  b.clock(5);
  b.in.axi.rready = true;
  b.clock();
  b.out.axi.rvalid = b.in.axi.rready = false;
  for (unsigned i = 0; i < 3; ++i) {
    b.wishbone_taken();
    b.out.wishbone.stall = true;
    b.clock(9);
    b.out.wishbone.stall = false;
    b.out.wishbone.ack = true;
    b.clock();
    b.out.wishbone.ack = false;
  }
  b.in.wishbone.cyc = false;
  b.selected();
  b.spi_bits(16);
  b.in.spi.cs_n = true;
  b.clock(3);
  b.out.spi.enable = false;
  b.clock(5);
  b.break_line();
  b.line(b.in.rx, 0x2AA);
  b.line(b.out.tx, 0x2AA);
  b.line(b.in.rx, 0x200);
  b.line(b.in.rx, 0x3FE);
  EXPECT_EQ(b.broken(), std::set<std::string>{});
}

}  // namespace
}  // namespace trammel::platform
