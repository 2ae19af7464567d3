// From a cause to the last pulse on the golden model of the whole card. The test makes the rows of the latency table in
// docs/reference/behaviour.md; the page must contain exactly these rows.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include "core_bench.hpp"
#include "trammel/skip/card.hpp"

namespace trammel::testing::stop_latency {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr unsigned kStepEvery = 17;         // clocks; 64 consecutive steps cover all phases of a scan of 64 clocks
constexpr std::uint32_t kSlew = 0x40'0000;  // 256 clocks from full ratio to rest
constexpr std::uint64_t kRamp = (std::uint64_t{1} << 30) / kSlew;
constexpr std::uint32_t kPin = 1U << 5;
constexpr std::int32_t kEnd = 30;  // soft limit, pulses

// A card with its first axis on a long forward line and without a condition that stops it.
CoreBench moving_card(std::uint64_t later = 0) {
  model::CardConfig config;
  config.axes = 2;
  config.inputs = 8;
  config.engines = model::RegisterFile::kMaxEngines;
  CoreBench bench(config);
  bench.core.set_steps(nullptr);
  bench.skips = true;
  bench.write(reg::kSlew, kSlew);
  bench.idle(later);
  bench.write(reg::kStopCauses, field::kStopCausesProbe | field::kStopCausesToolSetter);
  bench.write(reg::overtravel(0), 0xFFFF);
  bench.write(reg::soft_minus(0), 0);
  bench.write(reg::soft_plus(0), kEnd);
  const auto send = [&](const std::vector<std::uint32_t>& words) {
    for (const std::uint32_t word : words) EXPECT_TRUE(bench.write(reg::kStream, word));
  };
  constexpr std::uint64_t kTicks = 1'000'000;
  send(command_words(card_map::Opcode::Line, 1, 0, kTicks, {}, {std::int64_t{1} << 40}));
  send(command_words(card_map::Opcode::Feed, 0, 1, kTicks, {{"rate", (int128{1} << 64) / kStepEvery}, {"floor", 1}}));
  return bench;
}

struct Latency {
  std::uint64_t latch = 0;  // longest, in clocks
  std::uint64_t hold = 0;
  std::uint64_t last_pulse = 0;
  std::uint64_t rest = 0;

  void longer(const Latency& other) {
    latch = std::max(latch, other.latch);
    hold = std::max(hold, other.hold);
    last_pulse = std::max(last_pulse, other.last_pulse);
    rest = std::max(rest, other.rest);
  }
};

// Measures from now on, or from `begins` clocks later if the cause comes then.
Latency measured(model::CoreModel core, std::uint32_t pins, std::uint64_t begins = 0) {
  Latency found;
  std::uint32_t position = core.position(0);
  model::CoreModel::Inputs in;
  in.pins = pins;
  const std::uint64_t end = begins + kRamp + 200;
  for (std::uint64_t now = 1; now <= end; ++now) {
    skip::clock(core, in);
    const auto since = now - std::min(now, begins);
    if (core.outputs().fault != 0 && found.latch == 0) found.latch = since;
    if (core.state().motion.stop().hold && found.hold == 0) found.hold = since;
    if (core.position(0) != position) found.last_pulse = since;
    position = core.position(0);
    if (core.outputs().ratio == 0 && found.rest == 0) found.rest = since;
  }
  return found;
}

// At each clock of a scan, in each phase of the steps.
Latency by_pin(std::uint32_t role, std::uint32_t reaction) {
  CoreBench bench = moving_card();
  EXPECT_TRUE(bench.write(reg::kStopReaction, reaction));
  bench.write(reg::role(role), kPin);
  bench.idle(800);
  Latency longest;
  for (unsigned clock = 0; clock < 64 * kStepEvery; ++clock) {
    longest.longer(measured(bench.core, kPin));
    bench.idle(1);
  }
  return longest;
}

// From the pulse beyond the soft limit.
Latency by_soft_limit(std::uint32_t reaction) {
  Latency longest;
  for (unsigned later = 0; later < 8; ++later) {  // each clock of a round
    CoreBench bench = moving_card();
    bench.write(reg::kStopReaction, reaction);
    bench.idle(later);
    bench.write(reg::kSoftLimits, 1);
    while (static_cast<std::int32_t>(bench.core.position(0)) <= kEnd) bench.idle(1);
    longest.longer(measured(bench.core, 0));
  }
  return longest;
}

// From the end of a time of one unit, in each phase of the steps.
Latency by_silence(std::uint32_t address, std::uint32_t reaction) {
  Latency longest;
  for (unsigned later = 0; later < kStepEvery; ++later) {
    CoreBench bench = moving_card(later);
    EXPECT_TRUE(bench.write(reg::kStopReaction, reaction));
    bench.idle(later);
    bench.write(address, 1);
    // The time of the link ends with a unit of the time counter.
    const std::uint64_t now = bench.core.cycles();
    constexpr std::uint64_t kUnit = 65'536;
    const std::uint64_t end = address == reg::kWatchdog ? now + kUnit : (now / kUnit + 2) * kUnit;
    skip::run(bench.core, end - now - 50);
    longest.longer(measured(bench.core, 0, end - bench.core.cycles()));
  }
  return longest;
}

const std::string& page() {
  static const std::string text = [] {
    std::ifstream file(TRAMMEL_BEHAVIOUR_PAGE);
    std::stringstream all;
    all << file.rdbuf();
    return all.str();
  }();
  return text;
}

void expect_row(const std::string& cause, const std::string& from, const Latency& at_once, const Latency& ramp,
                bool faults = true) {
  std::ostringstream row;
  row << "| " << cause << " | " << from << " | ";
  faults ? row << ramp.latch : row << "none";
  row << " | " << ramp.hold << " | ";
  faults ? row << at_once.last_pulse : row << "none";
  row << " | R + " << ramp.rest - kRamp << " |\n";
  EXPECT_NE(page().find("\n" + row.str()), std::string::npos) << row.str();
  EXPECT_LE(ramp.last_pulse, ramp.rest + 20) << cause;
  if (faults) {
    EXPECT_EQ(at_once.latch, ramp.latch) << cause;
  }
}

constexpr std::uint32_t kAllRamps = 0x7FCFF;

TEST(StopLatency, OfPinsIsThatOfThePage) {
  constexpr std::uint32_t kLimitPlus = 8;
  constexpr std::uint32_t kDriveFault = 32;
  const auto row = [](const char* cause, const char* from, std::uint32_t role) {
    expect_row(cause, from, by_pin(role, 0), by_pin(role, kAllRamps));
  };
  row("limit switch", "pin, with the wait for a step of 17 clocks", kLimitPlus);
  row("drive fault", "pin", kDriveFault);
  row("probe outside probing", "pin", 48);
  row("tool setter", "pin", 49);
  expect_row("feed hold button", "pin", {}, by_pin(50, kAllRamps), false);
}

TEST(StopLatency, OfSoftLimitsIsThatOfThePage) {
  expect_row("soft limit", "pulse too far", by_soft_limit(0), by_soft_limit(kAllRamps));
}

TEST(StopLatency, OfSilenceIsThatOfThePage) {
  expect_row("watchdog", "end of its time", by_silence(reg::kWatchdog, 0), by_silence(reg::kWatchdog, kAllRamps));
  expect_row("link loss", "end of its last unit", by_silence(reg::kLinkTimeout, 0),
             by_silence(reg::kLinkTimeout, kAllRamps));
}

}  // namespace
}  // namespace trammel::testing::stop_latency
