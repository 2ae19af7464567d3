// Each impossible configuration of a card is refused with its own message; and two states of the pins are equal only if
// all pins are equal.
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>

#include "core_bench.hpp"

namespace trammel::testing {
namespace {

using model::CardConfig;
using model::CoreModel;
namespace engines = card_map::engines;
namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr std::uint32_t kLeast = model::RegisterFile::kMinEngines;
constexpr std::uint32_t kPlain = kLeast | engines::kPathCommands;

std::string config_error(const std::function<void(CardConfig&)>& change) {
  CardConfig config;
  change(config);
  try {
    const CoreModel core(config);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(CardConfig, NumbersOutOfRange) {
  for (const unsigned axes : {0U, 9U})
    EXPECT_EQ(config_error([&](CardConfig& config) { config.axes = axes; }), "a card has 1 to 8 axes");
  for (const unsigned ports : {0U, 5U})
    EXPECT_EQ(config_error([&](CardConfig& config) { config.ports = ports; }), "a card has 1 to 4 ports");
  for (const unsigned inputs : {0U, 33U})
    EXPECT_EQ(config_error([&](CardConfig& config) { config.inputs = inputs; }), "a card has 1 to 32 inputs");
  for (const unsigned outputs : {0U, 17U})
    EXPECT_EQ(config_error([&](CardConfig& config) { config.outputs = outputs; }), "a card has 1 to 16 outputs");
  const auto with_units = [](unsigned units) {
    return config_error([&](CardConfig& config) {
      config.engines = kPlain | engines::kMachineInputs | engines::kCaptures;
      config.captures = units;
    });
  };
  EXPECT_EQ(with_units(0), "captures need machine inputs, and are 1 to 4");
  EXPECT_EQ(with_units(5), "captures need machine inputs, and are 1 to 4");
  EXPECT_EQ(with_units(1), "");
  EXPECT_EQ(with_units(4), "");
}

TEST(CardConfig, EnginesThatNeedOthers) {
  const auto with = [](std::uint32_t mask) {
    return config_error([mask](CardConfig& config) { config.engines = mask; });
  };
  EXPECT_EQ(with(engines::kLines), "no card has these engines") << "feed pieces have a jerk";
  EXPECT_EQ(with(engines::kJerk), "no card has these engines");
  EXPECT_EQ(with(kLeast | 1U << 31), "no card has these engines");
  EXPECT_EQ(with(kLeast), "");
  EXPECT_EQ(with(kLeast | engines::kMachineInputs), "machine inputs need path commands");
  EXPECT_EQ(with(kPlain | engines::kMachineInputs), "");
  EXPECT_EQ(with(kPlain | engines::kCaptures), "captures need machine inputs, and are 1 to 4");
  EXPECT_EQ(with(kPlain | engines::kMachineInputs | engines::kCaptureFifo), "the queue of captures needs captures");
  EXPECT_EQ(with(kPlain | engines::kMachineInputs | engines::kCaptures | engines::kCaptureFifo), "");
  EXPECT_EQ(with(kLeast | engines::kEnables), "enables need path commands");
  EXPECT_EQ(with(kPlain | engines::kEnables), "");
  EXPECT_EQ(with(kLeast | engines::kPwm), "PWM needs path commands");
  EXPECT_EQ(with(kPlain | engines::kPwm), "");
}

TEST(CardConfig, WhatItWasMadeOfIsRead) {
  CardConfig config;
  config.build_id = 0x1234;
  config.board_id = 7;
  for (const bool dirty : {false, true}) {
    config.build_dirty = dirty;
    CoreBench bench(config);
    EXPECT_EQ(bench.read(reg::kBuildId), 0x1234U);
    EXPECT_EQ(bench.read(reg::kBuildFlags), dirty ? field::kBuildFlagsDirty : 0U);
    EXPECT_EQ(bench.read(reg::kBoardId), 7U);
  }
}

// Locksteps compare cards with this operator, so a difference in any one output must show.
TEST(CoreOutputs, DifferWhereOneOfThemDoes) {
  using Outputs = CoreModel::Outputs;
  const std::function<void(Outputs&)> changes[] = {
      [](Outputs& o) { o.step = 1; },           [](Outputs& o) { o.dir = 1; },
      [](Outputs& o) { o.output = 1; },         [](Outputs& o) { o.irq = true; },
      [](Outputs& o) { o.tick = true; },        [](Outputs& o) { o.path_tick = true; },
      [](Outputs& o) { o.path_swap = true; },   [](Outputs& o) { o.feed_swap = true; },
      [](Outputs& o) { o.path_step = 1; },      [](Outputs& o) { o.path_dir = 1; },
      [](Outputs& o) { o.geometry_room = 1; },  [](Outputs& o) { o.feed_room = 1; },
      [](Outputs& o) { o.status = 1; },         [](Outputs& o) { o.fault = 1; },
      [](Outputs& o) { o.geometry_begun = 1; }, [](Outputs& o) { o.feed_begun = 1; },
      [](Outputs& o) { o.ratio = 1; },          [](Outputs& o) { o.rate = 1; }};
  EXPECT_TRUE(Outputs{} == Outputs{});
  for (std::size_t i = 0; i < std::size(changes); ++i) {
    Outputs changed;
    changes[i](changed);
    EXPECT_FALSE(Outputs{} == changed) << i;
    EXPECT_FALSE(changed == Outputs{}) << i;
  }
}

// Writes beyond the limits of a register, and partial writes.
TEST(CoreRefusals, OfValuesAndOfParts) {
  CoreBench bench;
  const auto refused = [&](std::uint32_t address, std::uint32_t value) {
    EXPECT_FALSE(bench.write(address, value));
    const std::uint32_t refusal = bench.read(reg::kRefusal);
    EXPECT_TRUE(bench.write(reg::kRefusal, 0));
    EXPECT_EQ(bench.read(reg::kRefusal), refusal) << "no bit of it was named";
    EXPECT_TRUE(bench.write(reg::kRefusal, 1));
    EXPECT_EQ(bench.read(reg::kRefusal), 0U);
    EXPECT_EQ(refusal >> field::kRefusalAddressShift, address);
    return static_cast<card_map::Reason>(refusal & 0xFF);
  };
  EXPECT_EQ(refused(reg::kRatioFeed, 0x10001), card_map::Reason::BadValue);
  EXPECT_TRUE(bench.write(reg::kRatioFeed, 0x10000));
  EXPECT_EQ(refused(reg::kHoldLimit, 0), card_map::Reason::BadValue);
  EXPECT_TRUE(bench.write(reg::kHoldLimit, 1));
  EXPECT_EQ(refused(reg::kHoldLimit, 0x10000), card_map::Reason::BadValue) << "a bit without meaning";
  EXPECT_EQ(refused(reg::mode(0), 3), card_map::Reason::BadValue);
  EXPECT_EQ(refused(reg::kMagic, 1), card_map::Reason::ReadOnly);
  EXPECT_EQ(refused(0xFFC, 1), card_map::Reason::UnknownAddress);
  EXPECT_EQ(bench.read(reg::kHoldLimit), 1U);
  // A write of less than a word, from a bus that can do this.
  model::CoreModel::Inputs part;
  part.request = part.write = part.partial = true;
  part.address = reg::kHoldLimit;
  part.data = 5;
  bench.clock(part);
  for (int clocks = 0; !bench.core.answer().ack && clocks < 20; ++clocks) bench.clock({});
  EXPECT_TRUE(bench.core.answer().ack && bench.core.answer().error);
  EXPECT_EQ(bench.read(reg::kRefusal) & 0xFF, static_cast<std::uint32_t>(card_map::Reason::PartialWrite));
  EXPECT_EQ(bench.read(reg::kHoldLimit), 1U);
}

}  // namespace
}  // namespace trammel::testing
