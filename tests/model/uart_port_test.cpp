// The model of the serial port: measured rates, and the times of sent and received bits in closed form.
#include "trammel/model/uart_port.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace {

using trammel::model::UartPort;

class UartBench {
 public:
  void clock(bool rx, bool valid = false, std::uint8_t byte = 0) {
    UartPort::Inputs in;
    in.rx = rx;
    in.valid = valid;
    in.byte = byte;
    port.clock(in);
    ++now;
    if (port.outputs().byte_valid) received.push_back(port.outputs().byte);
  }
  void hold(bool rx, unsigned clocks) {
    for (unsigned i = 0; i < clocks; ++i) clock(rx);
  }
  // Sends a byte; its k-th edge is at k/8 periods, rounded with `rounding`.
  void send(std::uint8_t byte, unsigned period, unsigned rounding = 4) {
    const unsigned bits = 0x200U | unsigned{byte} << 1;
    unsigned edge = 0;
    for (unsigned k = 0; k < 10; ++k) {
      const unsigned end = ((k + 1) * period + rounding) / 8;
      hold((bits >> k & 1) != 0, end - edge);
      edge = end;
    }
  }
  void connect(unsigned period) {
    hold(false, 1 << 10);
    hold(true, 20);
    send(0x55, period);
    hold(true, 20);
  }

  UartPort port{10};
  std::uint64_t now = 0;
  std::vector<std::uint8_t> received;
};

TEST(UartPort, MeasuresAfterABreakAlone) {
  UartBench bench;
  bench.send(0x55, 100);
  EXPECT_EQ(bench.port.period(), 0U);
  EXPECT_FALSE(bench.port.outputs().ready);
  for (unsigned period = 64; period < 900; period += 7) {
    bench.connect(period);
    EXPECT_EQ(bench.port.period(), period);
    for (unsigned byte = 0; byte < 256; byte += 5) bench.send(static_cast<std::uint8_t>(byte), period);
    bench.hold(true, 4);
    ASSERT_EQ(bench.received.size(), 52U);
    for (unsigned i = 0; i < 52; ++i) ASSERT_EQ(bench.received[i], 5 * i);
    bench.received.clear();
    // Bytes at another rate do not change the measured rate.
    bench.send(0x55, 2 * period);
    EXPECT_EQ(bench.port.period(), period);
    bench.hold(true, 2000);
    bench.received.clear();
  }
}

TEST(UartPort, ARateTooHighIsNotTaken) {
  UartBench bench;
  bench.connect(63);
  EXPECT_EQ(bench.port.period(), 0U);
  bench.connect(64);
  EXPECT_EQ(bench.port.period(), 64U);
}

// The clock of the host may be off by 4 % (4 Mbaud at 100 MHz: 25 clocks per bit).
TEST(UartPort, ToleratesARateThatIsOff) {
  for (const unsigned period : {192U, 208U}) {
    UartBench bench;
    bench.connect(200);
    for (unsigned byte = 0; byte < 256; ++byte) bench.send(static_cast<std::uint8_t>(byte), period);
    bench.hold(true, 40);
    ASSERT_EQ(bench.received.size(), 256U);
    for (unsigned byte = 0; byte < 256; ++byte) ASSERT_EQ(bench.received[byte], byte);
  }
}

// The k-th bit begins floor(k/8 periods) after the start bit.
TEST(UartPort, BitsLeaveAtTheirTimes) {
  for (const unsigned period : {64U, 87U, 201U, 333U}) {
    UartBench bench;
    bench.connect(period);
    EXPECT_TRUE(bench.port.outputs().ready);
    bench.clock(true, true, 0xA6);
    const std::uint64_t start = bench.now;
    const unsigned bits = 0x200U | 0xA6U << 1;
    for (unsigned k = 0; k < 10; ++k) {
      while (bench.now < start + (k + 1) * period / 8) {
        ASSERT_EQ(bench.port.outputs().tx, (bits >> k & 1) != 0) << period << ' ' << k;
        ASSERT_FALSE(bench.port.outputs().ready);
        bench.clock(true);
      }
    }
    EXPECT_TRUE(bench.port.outputs().ready);
    EXPECT_TRUE(bench.port.outputs().tx);
  }
}

TEST(UartPort, ABreakIsTold) {
  UartBench bench;
  unsigned breaks = 0;
  for (unsigned i = 0; i < 3000; ++i) {
    bench.clock(i >= 1023 && i < 1030);
    breaks += bench.port.outputs().restart ? 1U : 0U;
  }
  EXPECT_EQ(breaks, 1U);  // the first low phase is one clock too short; the second one is one break, however long
}

}  // namespace
