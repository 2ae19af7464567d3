// The model of the arbiter with hosts that follow the rules of the port: no access is lost, mixed up or starved.
#include "trammel/model/port_arbiter.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <vector>

namespace {

using trammel::model::PortArbiter;

TEST(PortArbiter, HasOneToFourPorts) {
  EXPECT_THROW(PortArbiter(0), std::invalid_argument);
  EXPECT_THROW(PortArbiter(5), std::invalid_argument);
}

TEST(PortArbiter, OnePortIsWires) {
  PortArbiter arbiter(1);
  PortArbiter::Accesses now{};
  now[0] = {true, true, false, 0x184, 1};
  EXPECT_TRUE(arbiter.inner(now).access.request);
  EXPECT_EQ(arbiter.inner(now).access.address, 0x184U);
  EXPECT_EQ(arbiter.inner(now).port, 0);
  arbiter.clock(now, false);
  now[0].request = false;
  EXPECT_FALSE(arbiter.inner(now).access.request);
  EXPECT_EQ(arbiter.served(), 0U);
}

TEST(PortArbiter, PassesARequestOnTwoClocksLater) {
  for (std::size_t port = 0; port < 3; ++port) {
    PortArbiter arbiter(3);
    PortArbiter::Accesses now{};
    now[port] = {true, false, true, 0x040 + 4 * static_cast<std::uint32_t>(port), 7};
    for (int clock = 0; clock < 6; ++clock) {
      EXPECT_EQ(arbiter.inner(now).access.request, clock == 2) << clock;
      if (clock == 2) {
        EXPECT_EQ(arbiter.inner(now).port, port);
        EXPECT_EQ(arbiter.inner(now).access.address, now[port].address);
        EXPECT_TRUE(arbiter.inner(now).access.partial);
      }
      arbiter.clock(now, false);
      now[port].request = false;
    }
  }
}

// All ports ask at once, and ask again after each answer. They are served in turn; a waiting request goes out in the
// clock after the previous answer.
TEST(PortArbiter, ServesInTurn) {
  for (std::size_t ports = 2; ports <= 4; ++ports) {
    PortArbiter arbiter(ports);
    PortArbiter::Accesses now{};
    for (std::size_t port = 0; port < ports; ++port) now[port].request = true;
    std::vector<std::size_t> order;
    bool ack = false;
    for (int clock = 0; clock < 60; ++clock) {
      const PortArbiter::Inner inner = arbiter.inner(now);
      if (inner.access.request) order.push_back(inner.port);
      // The core answers in the same clock, so requests can follow in consecutive clocks.
      ack = inner.access.request;
      const std::size_t served = arbiter.served();
      arbiter.clock(now, ack);
      for (PortArbiter::Access& access : now) access.request = false;
      if (ack) now[served].request = true;
    }
    // A port asks again in the clock after its answer, and the arbiter sees this one clock later; with two ports this
    // leaves a gap.
    ASSERT_EQ(order.size(), ports == 2 ? 39U : 58U);
    for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i % ports) << i;
  }
}

// Random hosts and answer times: one access at a time; each access passes once and complete, and waits for at most one
// access of each other port.
TEST(PortArbiter, LosesAndMixesNothing) {
  for (std::size_t ports = 2; ports <= 4; ++ports) {
    std::mt19937_64 random(ports);
    PortArbiter arbiter(ports);
    PortArbiter::Accesses now{};
    std::array<bool, 4> waits{};
    std::array<unsigned, 4> overtaken{};
    bool core_busy = false;
    std::size_t served = 0;
    for (int clock = 0; clock < 100000; ++clock) {
      for (std::size_t port = 0; port < ports; ++port) {
        now[port].request = !waits[port] && random() % 4 == 0;
        if (!now[port].request) continue;
        now[port].write = random() % 2 == 0;
        now[port].address = static_cast<std::uint32_t>(random() & 0xFFF);
        now[port].data = static_cast<std::uint32_t>(random());
        waits[port] = true;
        overtaken[port] = 0;
      }
      const PortArbiter::Inner inner = arbiter.inner(now);
      const bool ack = core_busy && random() % 3 == 0;
      if (inner.access.request) {
        ASSERT_FALSE(core_busy);
        ASSERT_TRUE(waits[inner.port]);
        EXPECT_EQ(inner.access.write, now[inner.port].write);
        EXPECT_EQ(inner.access.address, now[inner.port].address);
        EXPECT_EQ(inner.access.data, now[inner.port].data);
        core_busy = true;
        for (std::size_t port = 0; port < ports; ++port) {
          const bool passed_over = port != inner.port && waits[port] && !now[port].request;
          overtaken[port] += passed_over ? 1 : 0;
          ASSERT_LT(overtaken[port], ports);
        }
      }
      if (ack) {
        ++served;
        core_busy = false;
        waits[arbiter.served()] = false;
      }
      arbiter.clock(now, ack);
    }
    EXPECT_GT(served, 10000U);
  }
}

}  // namespace
