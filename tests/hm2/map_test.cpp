// The data that a driver reads before it moves anything: names, IDROM, modules, pins, and the Ethernet side's spaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "bench.hpp"

namespace trammel::hm2 {
namespace {

std::string text_at(Bench& bench, Space space, std::uint16_t address, unsigned units, unsigned unit) {
  Bytes datagram;
  append_read(datagram, space, unit, address, units);
  const Bytes answer = bench.send(datagram);
  return std::string(answer.begin(), std::find(answer.begin(), answer.end(), 0));
}

TEST(Hm2Map, ItIsHostmot2AndNoBoardOfMesas) {
  Bench bench;
  EXPECT_EQ(bench.read(0x100), 0x55AACAFEU);
  EXPECT_EQ(text_at(bench, Space::kHostmot2, 0x104, 2, 4), "HOSTMOT2");
  const std::string name = text_at(bench, Space::kInfo, 0, 8, 2);
  EXPECT_EQ(name, "trammel");
  EXPECT_TRUE(std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::islower(c) != 0; }));
}

TEST(Hm2Map, TheIdromIsConsistent) {
  for (const unsigned axes : {1U, 4U, 8U}) {
    Bench bench(axes);
    const std::uint32_t idrom = bench.read(0x10C);
    const auto word = [&](std::uint32_t n) { return bench.read(static_cast<std::uint16_t>(idrom + 4 * n)); };
    EXPECT_EQ(word(0), 3U);
    EXPECT_EQ(word(8), word(7) * word(9)) << "pins: ports times pins a port";
    EXPECT_EQ(word(10), kClock);
    EXPECT_EQ(word(12), 4U);
    EXPECT_EQ(word(14), 0x100U);
    // Modules: tag, version, low clock, instances; base and registers; mask of the registers that each instance has.
    const std::uint32_t stepgen = word(1) / 4 + 6;
    EXPECT_EQ(word(stepgen), 5U | 2U << 8 | 1U << 16 | axes << 24);
    EXPECT_EQ(word(stepgen + 1), 0x2000U | 10U << 16);
    EXPECT_EQ(word(stepgen + 2), 0x1FFU);
    EXPECT_EQ(word(stepgen + 3), 0U) << "the end of the modules";
    unsigned step_pins = 0;
    for (unsigned pin = 0; pin < 24; ++pin) {
      const std::uint32_t use = word(word(2) / 4 + pin);
      EXPECT_EQ(use >> 24, 3U) << "a pin of the I/O port";
      step_pins += (use >> 8 & 0xFF) == 5 ? 1 : 0;
    }
    EXPECT_EQ(step_pins, 2 * axes);
  }
}

TEST(Hm2Map, TheHardwareAddressStandsLastByteFirst) {
  Bench bench;
  Bytes datagram;
  append_read(datagram, Space::kEeprom, 2, 2, 3);
  EXPECT_EQ(bench.send(datagram), (Bytes{1, 0, 0x54, 0x41, 0x52, 2}));
}

// By these values hm2_eth recognises which of its datagrams arrived.
TEST(Hm2Map, WhatTheDriverWritesIntoTheTimerSpaceStandsThere) {
  Bench bench;
  Bytes datagram;
  append_write(datagram, Space::kTimer, 2, 0x10, {1, 2, 3, 4});
  append_write(datagram, Space::kTimer, 2, 0x14, {5, 6, 7, 8});
  append_read(datagram, Space::kTimer, 2, 0x10, 4);
  append_read(datagram, Space::kControl, 2, 8, 1);
  EXPECT_EQ(bench.send(datagram), (Bytes{1, 2, 3, 4, 5, 6, 7, 8, 1, 0}));
}

TEST(Hm2Map, WhereThereIsNothingReadsAreZeroAndWritesHaveNoEffect) {
  Bench bench;
  bench.write(0x0000, {0xFFFFFFFF});
  bench.write(0x8000, {0xFFFFFFFF});
  bench.write(map_at::kIdrom, {0xFFFFFFFF});
  EXPECT_EQ(bench.read(0x0000), 0U);
  EXPECT_EQ(bench.read(0x8000), 0U);
  EXPECT_EQ(bench.read(map_at::kIdrom), 3U);
  EXPECT_EQ(bench.board.counts().all_refused(), 0U);
}

TEST(Hm2Map, InputsStandBehindThePinsOfTheStepGenerators) {
  Bench bench;
  bench.engine->set_input(0, true);
  bench.engine->set_input(3, true);
  bench.run(0.001);
  EXPECT_EQ(bench.read(map_at::kPortData), 0b1001U << 8);
  Bench eight(8);
  eight.engine->set_inputs(0xFFFF);
  eight.run(0.001);
  EXPECT_EQ(eight.read(map_at::kPortData), 0xFFU << 16);
}

TEST(Hm2Map, StepTimesAreTheCardsInClocks) {
  Bench bench;
  bench.write(map_at::kStepLength, {25, 26, 27, 0x3FFF});
  bench.write(map_at::kStepSpace, {1, 2, 3, 4});
  bench.write(map_at::kDirectionSetup, {5, 6, 7, 8});
  bench.write(map_at::kDirectionHold, {9, 10, 11, 12});
  for (unsigned n = 0; n < 4; ++n) {
    const auto at = [&](std::uint32_t address) { return bench.engine->read(address); };
    EXPECT_EQ(at(card_map::reg::step_length(n)), n == 3 ? 0x3FFFU : 25 + n);
    EXPECT_EQ(at(card_map::reg::step_space(n)), 1 + n);
    EXPECT_EQ(at(card_map::reg::dir_setup(n)), 5 + n);
    EXPECT_EQ(at(card_map::reg::dir_hold(n)), 9 + n);
  }
}

TEST(Hm2Map, ModesAndInvertedPinsAreTheCards) {
  Bench bench;
  bench.write(map_at::kMode, {0, 1, 2, 7});
  bench.write(map_at::kPortInvert, {0b1001});
  const std::uint32_t expected_modes[] = {0, 1, 2, 0};
  for (unsigned n = 0; n < 4; ++n) {
    const std::uint32_t mode = bench.engine->read(card_map::reg::mode(n));
    EXPECT_EQ((mode & card_map::field::kModeMode) >> card_map::field::kModeModeShift, expected_modes[n]);
    EXPECT_EQ((mode & card_map::field::kModeInvertFirst) != 0, n == 0);
    EXPECT_EQ((mode & card_map::field::kModeInvertSecond) != 0, n == 1);
  }
}

}  // namespace
}  // namespace trammel::hm2
