// The card built with engines other than the default, RTL beside golden model: random traffic, in which each command
// that needs a missing engine is refused with the right reason.
#include <Vdut.h>
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "card_variant.hpp"
#include "lockstep_card.hpp"
#include "traffic.hpp"
#include "trammel/driver/unit_table.hpp"

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
constexpr bool kStreaming = card_map::has_engine(kEngines, card_map::engine::kStreaming);
constexpr bool kMachineInputs = card_map::has_engine(kEngines, card_map::engine::kMachineInputs);
constexpr bool kEmergencyStop = card_map::has_engine(kEngines, card_map::engine::kEmergencyStop);
constexpr bool kEnables = card_map::has_engine(kEngines, card_map::engine::kEnables);
constexpr bool kDirectMode = card_map::has_engine(kEngines, card_map::engine::kDirectMode);
// Cards without arcs get few of them, because each refusal closes the stream.
constexpr unsigned kArcEvery = kArcs ? 4 : 40;

sim::LockstepCard card_with_engines(std::uint64_t seed) {
  model::CardModel::Config config;
  config.axes = kAxes;
  config.engines = kEngines;
  config.inputs = kMachineInputs ? 8 : 4;  // as built
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
  traffic.streams = kStreaming;
  traffic.roles = kMachineInputs;
  traffic.emergency = kEmergencyStop;
  traffic.enables = kEnables;
  traffic.chords_every = kChords ? 3 : 60;
  traffic.commands_every = kCommands ? 3 : 60;
  traffic.pwm = card_map::has_engine(kEngines, card_map::engine::kPwm);
  host.wait(300);
  traffic.settings();
  while (host.clocks() < clocks) traffic.run(10, 4);
  traffic.recover();
  traffic.wait_idle(100'000);
  if (kChords) {
    EXPECT_GT(traffic.chords_taken, clocks / 6000);
  }
  if (kEnables) {
    EXPECT_GT(traffic.enabled, clocks / 500'000);
  }
  if (kEmergencyStop) {
    EXPECT_GT(traffic.causes_of(field::kFaultEmergencyStop), clocks / 1'000'000);
  }
  expect_all_compared(card, clocks);
}

TEST(CardEngines, RandomTraffic) {
  const std::uint64_t seed = lockstep::seed_from_environment(kEngines);
  EXPECT_EQ(lockstep::judge([&] { random_traffic(seed, lockstep::scaled(1'000'000)); }), "");
}

// The reason of the present refusal, which is then cleared.
Reason refusal(AxiHost& host) {
  const auto reason = static_cast<Reason>(host.read(reg::kRefusal).value_or(0) & field::kRefusalReason);
  host.write(reg::kRefusal, 1);
  return reason;
}

// Covers the registers from the last axis's FREQUENCY_LO to START.
void direct_mode_refusals(AxiHost& host) {
  for (std::uint32_t address = reg::frequency_lo(kAxes - 1); address <= reg::kStart; address += 4) {
    const bool reads = host.read(address).has_value();
    EXPECT_EQ(reads, kDirectMode && address != reg::kStart) << address;
    if (!reads) {
      EXPECT_EQ(refusal(host), kDirectMode ? Reason::WriteOnly : Reason::UnknownAddress) << address;
    }
    // No axis is selected, so START has nothing to move.
    const bool writes = host.write(address, 0);
    EXPECT_EQ(writes, kDirectMode && address != reg::kStart) << address;
    if (!writes) {
      EXPECT_EQ(refusal(host), kDirectMode ? Reason::BadValue : Reason::UnknownAddress) << address;
    }
  }
}

// The engines that the card's descriptors report.
std::uint32_t engines(AxiHost& host) {
  std::uint32_t mask = 0;
  for (std::uint32_t unit = 0; unit < card_map::kDescriptorSlots; ++unit) {
    const std::uint32_t word_0 = host.read(reg::descriptor(2 * unit)).value_or(0);
    const std::uint32_t word_1 = host.read(reg::descriptor(2 * unit + 1)).value_or(0);
    const card_map::Descriptor descriptor = card_map::descriptor_of(word_0, word_1);
    if (descriptor.tag == 0) break;
    mask |= driver::engines_of(descriptor);
  }
  return mask;
}

void refusals(std::uint64_t seed) {
  sim::LockstepCard card = card_with_engines(seed);
  AxiHost host(card, seed);
  Traffic traffic(host, kAxes);
  EXPECT_EQ(engines(host), kEngines);
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
  for (const driver::Command& command :
       {driver::Command(driver::WaitInputCommand{}), driver::Command(driver::ProbeCommand{}),
        driver::Command(driver::ProbeEndCommand{})}) {
    EXPECT_EQ(traffic.send(command), kCommands) << command.index();
    EXPECT_EQ(refusal(host), kCommands ? Reason::None : Reason::UnknownOpcode) << command.index();
    traffic.abort();
  }
  direct_mode_refusals(host);
  for (const auto& [address, there] :
       {std::pair{reg::kRatioRapid, kClasses}, std::pair{reg::kRatioFixed, kClasses},
        std::pair{reg::kGeometryWatermark, kWatermarks}, std::pair{reg::kFeedWatermark, kWatermarks}}) {
    EXPECT_EQ(host.write(address, 0x1234), there) << address;
    EXPECT_EQ(refusal(host), there ? Reason::None : Reason::UnknownAddress) << address;
    EXPECT_EQ(host.read(address), there ? std::optional<std::uint32_t>(0x1234) : std::nullopt) << address;
    EXPECT_EQ(refusal(host), there ? Reason::None : Reason::UnknownAddress) << address;
  }
  for (const bool writes : {true, false}) {
    const std::uint32_t address = writes ? reg::kStreaming : reg::kStaleTicks;
    EXPECT_EQ(writes ? host.write(address, 0) : host.read(address).has_value(), kStreaming) << address;
    EXPECT_EQ(refusal(host), kStreaming ? Reason::None : Reason::UnknownAddress) << address;
  }
  driver::FeedCommand fixed = test::feed(60, 12);
  fixed.piece_class = driver::PieceClass::kFixed;
  EXPECT_EQ(traffic.send(fixed), kClasses);
  EXPECT_EQ(refusal(host), kClasses ? Reason::None : Reason::BadMask);
  traffic.abort();
  host.write(reg::kRatioFixed, 0x10000);
  host.write(reg::kRefusal, 1);
  // Every card can make lines.
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

// A step of the path, without its time.
struct PathStep {
  std::uint64_t command;
  std::uint64_t tick;
  unsigned axis;
  int direction;
  bool operator==(const PathStep& o) const {
    return command == o.command && tick == o.tick && axis == o.axis && direction == o.direction;
  }
};

class PathRecorder : public model::CardSteps {
 public:
  void pin_step(std::uint64_t, unsigned, int) override {}
  void path_step(std::uint64_t cycle, std::uint64_t command, std::uint64_t tick, unsigned axis, int dir) override {
    path.push_back({command, tick, axis, dir});
    last = cycle;
  }
  std::vector<PathStep> path;
  std::uint64_t last = 0;  // clock
};

using Words = std::vector<std::vector<std::uint32_t>>;

// Lines, and arcs on every engine of the card, in pieces of all classes that continue across path borders; dwells.
// One tick per 20 to 60 clocks at the full ratio, so that no step waits for long.
Words random_program(std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto random = [&engine](std::uint64_t count) { return engine() % count; };
  Words words;
  const auto put = [&words](const driver::Command& command) { driver::encode(command, 0, words.emplace_back()); };
  for (int section = 0; section < 4; ++section) {
    const double pace = 20 + static_cast<double>(random(40));
    std::uint64_t total = 0;
    Words paths;
    for (int path = 0; path < 8; ++path) {
      if (kChords && random(3) == 0) {
        paths.push_back(test::random_chords(random, kAxes, total));
      } else if (kArcs && random(3) == 0) {
        const driver::ArcCommand arc = test::random_arc(random, kAxes);
        const std::uint64_t ticks = arc.path_ticks + random(200);
        driver::encode(driver::with_ticks(arc, ticks), 0, paths.emplace_back());
        total += ticks;
      } else {
        const std::uint64_t ticks = 1 + random(300);
        std::vector<std::int64_t> pulses(kAxes);
        for (std::int64_t& p : pulses) p = static_cast<std::int64_t>(random(2 * ticks + 1) - ticks);
        driver::encode(test::line(ticks, pulses), 0, paths.emplace_back());
        total += ticks;
      }
    }
    while (total != 0) {
      const std::uint64_t ticks = 1 + random(total);
      driver::FeedCommand piece = test::random_piece(random, ticks, pace);
      if (kClasses) piece.piece_class = static_cast<driver::PieceClass>(random(3));
      put(piece);
      total -= ticks;
    }
    words.insert(words.end(), paths.begin(), paths.end());
    put(driver::DwellCommand{random(200)});
  }
  put(driver::EndCommand{});
  return words;
}

// The disturbance of the time base while a program runs.
enum class Doing { kNothing, kSlow, kHolds, kOverrides, kAll, kStarved };

void disturb_time(AxiHost& host, Doing doing) {
  constexpr std::uint32_t kRatios[] = {reg::kRatioFeed, reg::kRatioRapid, reg::kRatioFixed};
  const bool holds = doing == Doing::kHolds || (doing == Doing::kAll && host.below(2) == 0);
  if (doing == Doing::kAll) host.write(reg::kSlew, static_cast<std::uint32_t>(0x1'0000 << host.below(12)));
  if (holds) {
    host.write(reg::kHold, 1);
    host.wait(host.below(20'000));
    host.write(reg::kHold, 0);
  } else {
    const std::uint64_t most = host.below(4) == 0 ? 0x2000 : 0x10000;
    host.write(kRatios[kClasses ? host.below(3) : 0], static_cast<std::uint32_t>(0x800 + host.below(most - 0x7FF)));
  }
}

PathRecorder run_program(const Words& words, std::uint64_t seed, Doing doing) {
  sim::LockstepCard card = card_with_engines(seed);
  PathRecorder recorder;
  card.model().set_steps(&recorder);
  AxiHost host(card, seed + static_cast<std::uint64_t>(doing));
  Traffic traffic(host, kAxes);
  host.wait(300);
  if (doing == Doing::kSlow) host.write(reg::kRatioFeed, 0x5EB8);  // 37 %
  host.write(reg::kHold, doing == Doing::kStarved ? 0 : 1);
  for (const std::vector<std::uint32_t>& command : words) {
    if (doing == Doing::kStarved) host.wait(host.below(4000));
    EXPECT_TRUE(traffic.send_words(command, false));
  }
  host.write(reg::kHold, 0);
  for (int change = 0; change < 10 && doing >= Doing::kHolds && doing <= Doing::kAll; ++change) {
    host.wait(host.below(15'000));
    disturb_time(host, doing);
  }
  EXPECT_TRUE(traffic.wait_idle(20'000'000));
  EXPECT_EQ(traffic.status() & (field::kStatusEnded | field::kStatusFaulted), field::kStatusEnded);
  expect_all_compared(card, 10'000);
  card.model().set_steps(nullptr);
  return recorder;
}

// Command, tick, axis and direction of every step are the same at 100 %, at 37 %, with ten holds or overrides of any
// class, with both at any slew, and if the queues run dry again and again.
void same_paths(std::uint64_t seed) {
  const Words words = random_program(seed);
  const PathRecorder plain = run_program(words, seed, Doing::kNothing);
  EXPECT_GT(plain.path.size(), 1000U);
  for (const Doing doing : {Doing::kSlow, Doing::kHolds, Doing::kOverrides, Doing::kAll, Doing::kStarved}) {
    const PathRecorder other = run_program(words, seed, doing);
    ASSERT_TRUE(other.path == plain.path) << "doing " << static_cast<int>(doing) << " seed " << seed;
    EXPECT_NE(other.last, plain.last) << "its time was another";
  }
  EXPECT_FALSE(run_program(random_program(seed + 1), seed, Doing::kNothing).path == plain.path);
}

TEST(CardEngines, TimeNeverShowsInThePath) {
  const std::uint64_t seed = lockstep::seed_from_environment(37);
  for (std::uint64_t program = 0; program < lockstep::scaled(1); ++program)
    EXPECT_EQ(lockstep::judge([&] { same_paths(seed + program); }), "");
}

}  // namespace
