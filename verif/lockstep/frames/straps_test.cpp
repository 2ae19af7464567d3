// The straps and inputs of the card with ports, and its AXI4-Lite port under a master whose address and data come at
// different times. Pins and read data are compared in every cycle.
#include <gtest/gtest.h>

#include <utility>

#include "../card/axi_host.hpp"
#include "card_behind_ports.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

using Host = test::AxiHostOf<CardBehindPorts>;

constexpr std::uint64_t kSettled = 300;  // clocks: longer than the filling of the registers, and than a scan of inputs

// Pins that idle high, outputs that differ, and an emergency stop that is active low.
CardBehindPorts::Straps straps() { return {0xA6, 0b0101, false}; }

void straps_and_inputs() {
  CardBehindPorts card(straps());
  Host host(card, 1);
  host.press_emergency_stop(true);  // the level at rest
  host.wait(kSettled);
  for (const auto& [axis, mode] : {std::pair{0U, 0U}, std::pair{1U, 12U}, std::pair{2U, 4U}, std::pair{3U, 8U}})
    EXPECT_EQ(host.read(reg::mode(axis)), mode) << "inverted where the pin idles high, axis " << axis;
  for (const std::uint32_t pins : {0U, 0xA5U, 0xFFU}) {
    host.set_pins(pins);
    host.wait(kSettled);
    EXPECT_EQ(host.read(reg::kInputs), pins);
  }
  EXPECT_EQ(host.read(reg::kFault), 0U);
  host.press_emergency_stop(false);
  host.wait(kSettled);
  EXPECT_EQ(host.read(reg::kFault), field::kFaultEmergencyStop);
  EXPECT_EQ(card.check().comparisons(), card.expected());
}

void address_and_data_apart() {
  CardBehindPorts card;
  Host host(card, 2);
  host.wait(kSettled);
  host.set_delays(7);
  for (std::uint32_t value = 1; value <= 40; ++value) {
    EXPECT_TRUE(host.write(reg::kHoldLimit, value));
    EXPECT_EQ(host.read(reg::kHoldLimit), value);
  }
  EXPECT_FALSE(host.write(reg::kHoldLimit, 7, 0x7)) << "three of four bytes";
  EXPECT_EQ(host.read(reg::kHoldLimit), 40U);
  EXPECT_EQ(card.check().comparisons(), card.expected());
}

TEST(CardWithPorts, StrapsAndInputs) { EXPECT_EQ(judge(straps_and_inputs), ""); }
TEST(CardWithPorts, AddressAndDataApart) { EXPECT_EQ(judge(address_and_data_apart), ""); }

}  // namespace
}  // namespace trammel::lockstep
