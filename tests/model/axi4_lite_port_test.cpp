// The model of the AXI4-Lite port against the clocks in architecture.md, with a master that may wait at any point.
#include "trammel/model/axi4_lite_port.hpp"

#include <gtest/gtest.h>

#include <random>

namespace {

using trammel::model::Axi4LitePort;

TEST(Axi4LitePort, AnswersAreDefinedFromReset) {
  const Axi4LitePort port;
  EXPECT_EQ(port.outputs().bresp, Axi4LitePort::kOkay);
  EXPECT_EQ(port.outputs().rresp, Axi4LitePort::kOkay);
  EXPECT_EQ(port.outputs().rdata, 0U);
  EXPECT_FALSE(port.outputs().bvalid || port.outputs().rvalid);
}

TEST(Axi4LitePort, AWriteNeedsAddressAndData) {
  Axi4LitePort port;
  Axi4LitePort::Inputs in;
  in.awvalid = true;
  in.awaddr = 0x184;
  for (int i = 0; i < 5; ++i) {
    port.clock(in);
    EXPECT_FALSE(port.outputs().awready || port.outputs().wready || port.outputs().request);
  }
  in.wvalid = true;
  in.wdata = 1;
  in.wstrb = 0x7;
  port.clock(in);
  EXPECT_TRUE(port.outputs().awready && port.outputs().wready && port.outputs().request);
  EXPECT_TRUE(port.outputs().write && port.outputs().partial);
  EXPECT_EQ(port.outputs().address, 0x184U);
  EXPECT_EQ(port.outputs().data, 1U);
  in.awvalid = in.wvalid = false;
  port.clock(in);
  EXPECT_FALSE(port.outputs().awready || port.outputs().wready || port.outputs().request);
  in.ack = in.error = true;
  port.clock(in);
  in.ack = in.error = false;
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(port.outputs().bvalid);
    EXPECT_EQ(port.outputs().bresp, Axi4LitePort::kSlaveError);
    port.clock(in);
  }
  in.bready = true;
  port.clock(in);
  EXPECT_FALSE(port.outputs().bvalid);
  EXPECT_EQ(port.outputs().bresp, Axi4LitePort::kSlaveError) << "holds";
}

// While the master does not accept an answer, the next access of the same kind waits; the other kind goes on.
TEST(Axi4LitePort, AnswersThatWaitHoldTheirKindBack) {
  for (const bool write : {false, true}) {
    Axi4LitePort port;
    Axi4LitePort::Inputs in;
    in.awvalid = in.wvalid = write;
    in.arvalid = !write;
    port.clock(in);
    in.ack = true;
    port.clock(in);
    in.ack = false;
    for (int i = 0; i < 5; ++i) {
      port.clock(in);
      EXPECT_FALSE(port.outputs().request);
      EXPECT_TRUE(write ? port.outputs().bvalid : port.outputs().rvalid);
    }
    in.awvalid = in.wvalid = in.arvalid = true;
    port.clock(in);
    EXPECT_TRUE(port.outputs().request);
    EXPECT_EQ(port.outputs().write, !write);
  }
}

// A read and a write arrive in the same clock, long after the last access: the kind that was not served last goes
// first.
TEST(Axi4LitePort, OfTwoInOneClockTheOtherKindGoesFirst) {
  for (const bool write_before : {false, true}) {
    Axi4LitePort port;
    Axi4LitePort::Inputs in;
    in.bready = in.rready = true;
    in.awvalid = in.wvalid = write_before;
    in.arvalid = !write_before;
    port.clock(in);
    in.awvalid = in.wvalid = in.arvalid = false;
    in.ack = true;
    port.clock(in);
    in.ack = false;
    for (int i = 0; i < 5; ++i) port.clock(in);
    in.awvalid = in.wvalid = in.arvalid = true;
    port.clock(in);
    EXPECT_TRUE(port.outputs().request);
    EXPECT_EQ(port.outputs().write, !write_before);
  }
}

// Waiting reads and writes take turns, one access at a time. Each is answered once, with its own data.
TEST(Axi4LitePort, ReadsAndWritesTakeTurns) {
  std::mt19937_64 random(3);
  Axi4LitePort port;
  Axi4LitePort::Inputs in;
  unsigned writes = 0;
  unsigned reads = 0;
  bool under_way = false;
  bool last_write = false;
  for (int clock = 0; clock < 20000; ++clock) {
    // A read and a write are always waiting and answers are accepted at once, so the two must alternate.
    in.awvalid = in.wvalid = in.arvalid = in.bready = in.rready = true;
    in.wstrb = Axi4LitePort::kAllStrobes;
    in.awaddr = 0x200;
    in.araddr = 0x040;
    in.ack = under_way && random() % 3 == 0;
    in.data = static_cast<std::uint32_t>(clock);
    const bool was_write = last_write;
    port.clock(in);
    if (in.ack) {
      under_way = false;
      EXPECT_EQ(port.outputs().bvalid, was_write);
      EXPECT_EQ(port.outputs().rvalid, !was_write);
      if (!was_write) {
        EXPECT_EQ(port.outputs().rdata, static_cast<std::uint32_t>(clock));
      }
      ++(was_write ? writes : reads);
    }
    if (port.outputs().request) {
      ASSERT_FALSE(under_way);
      under_way = true;
      if (writes + reads != 0) {
        EXPECT_NE(port.outputs().write, last_write);
      }
      last_write = port.outputs().write;
      EXPECT_EQ(port.outputs().address, last_write ? 0x200U : 0x040U);
    }
  }
  EXPECT_GT(writes, 2000U);
  EXPECT_LE(writes > reads ? writes - reads : reads - writes, 1U);
}

}  // namespace
