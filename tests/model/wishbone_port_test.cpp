// The model of the Wishbone port: the documented clocks, answers, and masters that give up.
#include "trammel/model/wishbone_port.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace {

using trammel::model::WishbonePort;

// A core that answers a given number of clocks after its request.
struct Core {
  explicit Core(unsigned clocks, bool refuses = false) : after(clocks), error(refuses) {}
  unsigned after;
  bool error;
  unsigned wait = 0;
  std::vector<std::uint32_t> addresses{};
  void see(const WishbonePort::Outputs& out, WishbonePort::Inputs& in) {
    if (out.request) {
      wait = after + 1;
      addresses.push_back(out.address);
    }
    in.ack = wait == 1;
    in.error = error;
    in.data = 0x1000 + static_cast<std::uint32_t>(addresses.size());
    if (wait != 0) --wait;
  }
};

TEST(WishbonePort, AClassicReadAndItsClocks) {
  WishbonePort port;
  Core core(5);
  WishbonePort::Inputs in;
  in.cyc = in.stb = true;
  in.adr = 0x40;
  for (unsigned clock = 0; clock < 20; ++clock) {
    const WishbonePort::Outputs& out = port.outputs();
    EXPECT_EQ(out.request, clock % 8 == 1) << clock;  // STB stays high: the next access
    EXPECT_EQ(out.ack, clock == 7 || clock == 15) << clock;
    if (out.ack) {
      EXPECT_EQ(out.dat, 0x1000 + core.addresses.size());
    }
    EXPECT_FALSE(out.err || out.stall);
    core.see(out, in);
    port.clock(in);
  }
}

TEST(WishbonePort, APipelinedMasterIsStalled) {
  WishbonePort port(true);
  EXPECT_TRUE(port.outputs().stall) << "in the first clock after a reset";
  port.clock({});
  Core core(4);
  WishbonePort::Inputs in;
  in.cyc = in.stb = true;
  for (unsigned clock = 0; clock < 20; ++clock) {
    const WishbonePort::Outputs& out = port.outputs();
    EXPECT_EQ(out.stall, clock % 6 != 0) << clock;
    EXPECT_EQ(out.request, clock % 6 == 1) << clock;
    EXPECT_EQ(out.ack, clock != 0 && clock % 6 == 0) << clock;
    core.see(out, in);
    port.clock(in);
  }
}

TEST(WishbonePort, ARefusalIsAnError) {
  for (const bool pipelined : {false, true}) {
    WishbonePort port(pipelined);
    port.clock({});
    Core core(4, true);
    WishbonePort::Inputs in;
    in.cyc = in.stb = in.we = true;
    in.sel = 7;
    unsigned errors = 0;
    for (unsigned clock = 0; clock < 8; ++clock) {
      EXPECT_EQ(port.outputs().partial, port.outputs().request || clock > 0);
      core.see(port.outputs(), in);
      port.clock(in);
      EXPECT_FALSE(port.outputs().ack);
      errors += port.outputs().err ? 1U : 0U;
    }
    EXPECT_EQ(errors, 1U);
  }
}

// The master gives up in each clock of an access in turn; its next access gets its own answer and no other.
TEST(WishbonePort, GivenUpIsNotAnswered) {
  for (const bool pipelined : {false, true}) {
    for (unsigned when = 1; when < 6; ++when) {
      WishbonePort port(pipelined);
      port.clock({});
      Core core(4);
      WishbonePort::Inputs in;
      unsigned answers = 0;
      for (unsigned clock = 0; clock < 30; ++clock) {
        in.cyc = clock < when || (clock > when && answers == 0);
        in.stb = in.cyc && !(pipelined && clock > 0 && clock < when) && (clock <= when || core.addresses.size() < 2);
        if (!pipelined) in.stb = in.cyc;
        in.adr = clock > when ? 8 : 4;
        core.see(port.outputs(), in);
        port.clock(in);
        if (port.outputs().ack) {
          ++answers;
          EXPECT_EQ(core.addresses.back(), 8U) << when;
        }
      }
      EXPECT_EQ(answers, 1U) << when;
      EXPECT_EQ(core.addresses.size(), 2U) << when;
    }
  }
}

}  // namespace
