// The card built with other engines than by default, RTL beside golden model: random traffic, of which what needs a
// missing engine is refused, and each refusal by its name.
#include <Vdut.h>
#include <gtest/gtest.h>

#include <array>

#include "card_variant.hpp"
#include "lockstep_card.hpp"
#include "traffic.hpp"

namespace {

using namespace trammel;
using card_map::Reason;
using test::AxiHost;
using test::Traffic;
namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr unsigned kAxes = 4;
constexpr std::uint32_t kEngines = TRAMMEL_ENGINES;
constexpr bool kArcs = card_map::has_engine(kEngines, card_map::engine::kAccumulator);
constexpr bool kChords = card_map::has_engine(kEngines, card_map::engine::kArcGenerator);
constexpr bool kCommands = card_map::has_engine(kEngines, card_map::engine::kPathCommands);
constexpr bool kClasses = card_map::has_engine(kEngines, card_map::engine::kClasses);
constexpr bool kWatermarks = card_map::has_engine(kEngines, card_map::engine::kWatermarks);
constexpr bool kDirectMode = card_map::has_engine(kEngines, card_map::engine::kDirectMode);
// Where they are refused, since each refusal closes the stream, only now and then.
constexpr unsigned kArcEvery = kArcs ? 4 : 40;

sim::LockstepCard card_with_engines(std::uint64_t seed) {
  model::CardModel::Config config;
  config.axes = kAxes;
  config.engines = kEngines;
  config.idle_level = static_cast<std::uint32_t>(seed * 0x9E37 & 0xFF);
  config.output_idle = static_cast<std::uint16_t>(seed & 0xF);
  const sim::CardStraps straps{config.clock_hz, config.idle_level, config.output_idle};
  return {std::make_unique<sim::CardVariant<Vdut, kAxes>>(straps), config, seed};
}

void expect_all_compared(sim::LockstepCard& card, std::uint64_t at_least) {
  card.settle();
  EXPECT_GE(card.cycles(), at_least);
  EXPECT_EQ(card.comparisons(), card.cycles() * sim::signals_compared(kAxes));
}

void random_traffic(std::uint64_t seed, std::uint64_t clocks) {
  sim::LockstepCard card = card_with_engines(seed);
  AxiHost host(card, seed);
  Traffic traffic(host, kAxes, kArcEvery);
  traffic.classes = kClasses;
  traffic.chords_every = kChords ? 3 : 60;
  traffic.commands_every = kCommands ? 3 : 60;
  host.wait(300);
  traffic.settings();
  while (host.clocks() < clocks) traffic.run(10, 4);
  traffic.recover();
  traffic.wait_idle(100'000);
  if (kChords) {
    EXPECT_GT(traffic.chords_taken, clocks / 5000);
  }
  expect_all_compared(card, clocks);
}

TEST(CardEngines, RandomTraffic) {
  const std::uint64_t seed = lockstep::seed_from_environment(kEngines);
  EXPECT_EQ(lockstep::judge([&] { random_traffic(seed, lockstep::scaled(1'000'000)); }), "");
}

// The reason of the refusal that stands, which is then cleared.
Reason refusal(AxiHost& host) {
  const auto reason = static_cast<Reason>(host.read(reg::kRefusal).value_or(0) & field::kRefusalReason);
  host.write(reg::kRefusal, 1);
  return reason;
}

void refusals(std::uint64_t seed) {
  sim::LockstepCard card = card_with_engines(seed);
  AxiHost host(card, seed);
  Traffic traffic(host, kAxes);
  EXPECT_EQ(host.read(reg::kEngines), kEngines);
  const auto random = [&host](std::uint64_t count) { return host.below(count); };
  const driver::ArcCommand arc = test::random_arc(random, kAxes);
  EXPECT_EQ(traffic.send(driver::with_ticks(arc, 3 * arc.path_ticks)), kArcs);
  EXPECT_EQ(refusal(host), kArcs ? Reason::None : Reason::UnknownOpcode);
  traffic.abort();
  EXPECT_EQ(traffic.send(driver::OutputCommand{3, 0}), kCommands);
  EXPECT_EQ(refusal(host), kCommands ? Reason::None : Reason::UnknownOpcode);
  host.wait(30);
  EXPECT_EQ(host.read(reg::kOutputs).has_value(), kCommands);
  EXPECT_EQ(refusal(host), kCommands ? Reason::None : Reason::UnknownAddress);
  traffic.abort();
  // From the last axis's FREQUENCY_LO to START.
  for (std::uint32_t address = reg::frequency_lo(kAxes - 1); address <= reg::kStart; address += 4) {
    const bool reads = host.read(address).has_value();
    EXPECT_EQ(reads, kDirectMode && address != reg::kStart) << address;
    if (!reads) {
      EXPECT_EQ(refusal(host), kDirectMode ? Reason::WriteOnly : Reason::UnknownAddress) << address;
    }
    // No axis: START has nothing to move.
    const bool writes = host.write(address, 0);
    EXPECT_EQ(writes, kDirectMode && address != reg::kStart) << address;
    if (!writes) {
      EXPECT_EQ(refusal(host), kDirectMode ? Reason::BadValue : Reason::UnknownAddress) << address;
    }
  }
  for (const auto& [address, there] :
       {std::pair{reg::kRatioRapid, kClasses}, std::pair{reg::kRatioFixed, kClasses},
        std::pair{reg::kGeometryWatermark, kWatermarks}, std::pair{reg::kFeedWatermark, kWatermarks}}) {
    EXPECT_EQ(host.write(address, 0x1234), there) << address;
    EXPECT_EQ(refusal(host), there ? Reason::None : Reason::UnknownAddress) << address;
    EXPECT_EQ(host.read(address), there ? std::optional<std::uint32_t>(0x1234) : std::nullopt) << address;
    EXPECT_EQ(refusal(host), there ? Reason::None : Reason::UnknownAddress) << address;
  }
  driver::FeedCommand fixed = test::feed(60, 12);
  fixed.piece_class = driver::PieceClass::kFixed;
  EXPECT_EQ(traffic.send(fixed), kClasses);
  EXPECT_EQ(refusal(host), kClasses ? Reason::None : Reason::BadMask);
  traffic.abort();
  host.write(reg::kRatioFixed, 0x10000);
  host.write(reg::kRefusal, 1);
  // Lines are on every card.
  EXPECT_TRUE(traffic.send(test::line(60, {5, -6, 7, 8})));
  EXPECT_TRUE(traffic.send(test::feed(60, 12)));
  EXPECT_TRUE(traffic.wait_idle(5000));
  for (const unsigned axis : {0U, 1U, 2U, 3U})
    EXPECT_EQ(static_cast<std::int32_t>(card.model().position(axis)), (std::array{5, -6, 7, 8}[axis])) << axis;
  expect_all_compared(card, 1000);
}

TEST(CardEngines, WhatIsMissingIsRefusedByName) {
  EXPECT_EQ(lockstep::judge([] { refusals(lockstep::seed_from_environment(5)); }), "");
}

}  // namespace
