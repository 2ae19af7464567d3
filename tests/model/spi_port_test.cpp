// The model of the SPI port: bytes in both directions in modes 0 and 3, and the delay of MISO, from which the
// documentation derives the fastest SCK.
#include "trammel/model/spi_port.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace {

using trammel::model::SpiPort;

class SpiBench {
 public:
  void clocks(bool sck, bool cs_n, bool mosi, unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
      SpiPort::Inputs in;
      in.pins = {sck, cs_n, mosi};
      in.valid = true;
      in.byte = next;
      if (port.outputs().ready) ++next;
      port.clock(in);
      if (port.outputs().byte_valid) received.push_back(port.outputs().byte);
    }
  }
  // Each half of SCK takes two clocks; the master samples at the rising edge.
  std::vector<std::uint8_t> exchange(bool mode3, const std::vector<std::uint8_t>& bytes, unsigned bits_of_last = 8) {
    std::vector<std::uint8_t> back;
    clocks(mode3, true, false, 6);
    clocks(mode3, false, false, 6);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      unsigned in = 0;
      for (unsigned bit = 0; bit < (i + 1 == bytes.size() ? bits_of_last : 8); ++bit) {
        clocks(false, false, (bytes[i] >> (7 - bit) & 1) != 0, 2);
        in = in << 1 | (port.outputs().miso ? 1U : 0U);
        clocks(true, false, (bytes[i] >> (7 - bit) & 1) != 0, 2);
      }
      back.push_back(static_cast<std::uint8_t>(in));
    }
    clocks(mode3, false, false, 4);
    clocks(mode3, true, false, 6);
    return back;
  }

  SpiPort port;
  std::uint8_t next = 0x80;
  std::vector<std::uint8_t> received;
};

TEST(SpiPort, BytesBothWays) {
  for (const bool mode3 : {false, true}) {
    SpiBench bench;
    EXPECT_EQ(bench.exchange(mode3, {1, 0xA5, 0xFF}), (std::vector<std::uint8_t>{0xC0, 0x80, 0x81}));
    // A byte that was loaded at the end of an exchange comes first in the next exchange.
    EXPECT_EQ(bench.exchange(mode3, {7}), std::vector<std::uint8_t>{0x82});
    EXPECT_EQ(bench.received, (std::vector<std::uint8_t>{1, 0xA5, 0xFF, 7}));
  }
}

TEST(SpiPort, AByteThatIsCutIsNone) {
  SpiBench bench;
  bench.exchange(false, {1, 2}, 5);
  bench.exchange(false, {3, 4});
  EXPECT_EQ(bench.received, (std::vector<std::uint8_t>{1, 3, 4}));
}

TEST(SpiPort, SckForOthersIsNothing) {
  SpiBench bench;
  for (int i = 0; i < 50; ++i) {
    bench.clocks(false, true, true, 2);
    bench.clocks(true, true, true, 2);
  }
  EXPECT_TRUE(bench.received.empty());
  EXPECT_FALSE(bench.port.outputs().miso_enable);
  EXPECT_EQ(bench.exchange(false, {9}), std::vector<std::uint8_t>{0xC0});
}

// An SCK level that is first sampled at clock edge n appears at MISO after edge n + 2: the bit comes 2 to 3 clocks
// after SCK rose.
TEST(SpiPort, MisoIsTwoToThreeClocksLate) {
  SpiBench bench;
  bench.clocks(false, true, false, 6);
  bench.clocks(false, false, false, 6);
  EXPECT_TRUE(bench.port.outputs().miso);  // the first bit of 0xC0
  bench.clocks(true, false, false, 2);
  bench.clocks(false, false, false, 2);
  bench.clocks(true, false, false, 2);  // the first of these clocks samples the second rising edge
  EXPECT_TRUE(bench.port.outputs().miso);
  bench.clocks(true, false, false, 1);
  EXPECT_FALSE(bench.port.outputs().miso);
}

}  // namespace
