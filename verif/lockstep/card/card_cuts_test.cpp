// The whole card, RTL beside golden model, with events at every clock of a program: cuts, a probe's edge, late
// periods, counts at the limits of their counters, steps that wait.
#include <gtest/gtest.h>

#include "card_programs.hpp"
#include "card_under_test.hpp"
#include "traffic.hpp"

namespace {

using namespace trammel;
using test::AxiHost;
using test::expect_all_compared;
using test::feed;
using test::line;
using test::short_program;
using test::Traffic;
namespace reg = card_map::reg;
namespace field = card_map::field;

enum class Cut { kAbort, kResetOfOneClock, kResetOfTwoClocks, kHold, kStart };

// Cuts the program once at each of its clocks, and starts a new one at once.
void cut_at_every_clock(Cut cut, std::uint64_t seed) {
  constexpr unsigned kAxes = 4;
  sim::LockstepCard card = test::card_under_test(kAxes, seed, 0);
  AxiHost host(card, seed);
  Traffic traffic(host, kAxes);
  host.wait(300);
  for (std::uint64_t at = 0; at < 900; at += 1 + host.below(3)) {
    short_program(traffic, kAxes, host);
    host.wait(at);
    switch (cut) {
      case Cut::kAbort:
        traffic.abort();
        break;
      case Cut::kResetOfOneClock:
        traffic.reset(1);
        break;
      case Cut::kResetOfTwoClocks:
        traffic.reset(2);
        break;
      case Cut::kHold:
        host.write(reg::kHold, 1);
        host.wait(host.below(200));
        host.write(reg::kHold, 0);
        break;
      case Cut::kStart:
        traffic.start();
        break;
    }
    if (host.below(2) == 0) continue;
    // A direct move may take long, but nothing lasts longer than a recovery.
    const bool idle = traffic.wait_idle(4000);
    EXPECT_TRUE(idle || cut == Cut::kStart) << at;
    if (!idle || (traffic.status() & (field::kStatusFaulted | field::kStatusRefused)) != 0) {
      traffic.recover();
      EXPECT_TRUE(traffic.wait_idle(2000)) << at;
    }
  }
  expect_all_compared(card, kAxes, 10'000);
}

class CardCut : public testing::TestWithParam<Cut> {};

TEST_P(CardCut, AtEveryClock) {
  const std::uint64_t seed = lockstep::seed_from_environment(7);
  EXPECT_EQ(lockstep::judge([&] { cut_at_every_clock(GetParam(), seed); }), "");
}

INSTANTIATE_TEST_SUITE_P(Program, CardCut,
                         testing::Values(Cut::kAbort, Cut::kResetOfOneClock, Cut::kResetOfTwoClocks, Cut::kHold,
                                         Cut::kStart),
                         [](const auto& cut) -> std::string {
                           switch (cut.param) {
                             case Cut::kAbort:
                               return "Abort";
                             case Cut::kResetOfOneClock:
                               return "ResetOfOneClock";
                             case Cut::kResetOfTwoClocks:
                               return "ResetOfTwoClocks";
                             case Cut::kHold:
                               return "Hold";
                             default:
                               return "Start";
                           }
                         });

// A probe's edge at every clock of a program of lines, an arc, outputs, a dwell and a second PROBE. The commands
// after PROBE_END run when the edge is cleared.
void edge_at_every_clock(std::uint32_t slew, std::uint64_t seed) {
  constexpr unsigned kAxes = 4;
  sim::LockstepCard card = test::card_under_test(kAxes, seed, 0);
  AxiHost host(card, seed);
  Traffic traffic(host, kAxes);
  host.wait(300);
  host.write(reg::kSlew, slew);
  unsigned probed = 0;
  unsigned missed = 0;
  for (std::uint64_t at = 0; at < 1300; ++at) {
    host.set_pins(0);
    host.write(reg::kHold, 1);
    traffic.send(driver::ProbeCommand{2, true});
    traffic.send(feed(70, 1.5));
    traffic.send(line(40, {7, -7, 0, 3}));
    traffic.send(driver::OutputCommand{1, 2});
    traffic.send(line(30, {-3, 2, 9, 0}));
    traffic.send(driver::DwellCommand{20});
    traffic.send(driver::ProbeCommand{static_cast<std::uint8_t>(at % 2 == 0 ? 2 : 1), true});
    const driver::ArcCommand arc = test::random_arc([&host](std::uint64_t count) { return host.below(count); }, kAxes);
    const std::uint64_t ticks = 2 * arc.path_ticks;
    traffic.send(driver::with_ticks(arc, ticks));
    traffic.send(feed(ticks, 2));
    traffic.send(driver::MarkCommand{});
    traffic.send(driver::ProbeEndCommand{});
    if (at % 3 == 0) traffic.send(driver::WaitInputCommand{3, true, 10});
    traffic.send(line(20, {1, 2, 3, 4}));
    traffic.send(feed(20, 2));
    host.write(reg::kHold, 0);
    host.wait(at % 400);
    host.set_pins(at % 5 == 0 ? 0b0110 : 0b0100);
    host.wait(at / 2);
    if ((traffic.status() & field::kStatusProbed) == 0) host.wait(2000);
    probed += (traffic.status() & field::kStatusProbed) != 0 ? 1U : 0U;
    missed += (traffic.status() & field::kStatusProbeMissed) != 0 ? 1U : 0U;
    host.write(reg::kControl, field::kControlProbeClear);
    EXPECT_TRUE(traffic.wait_idle(100'000)) << at;
    EXPECT_EQ(traffic.status() & (field::kStatusFaulted | field::kStatusProbed), 0U) << at;
  }
  EXPECT_GT(probed, 300U);
  EXPECT_GT(missed, 100U);
  expect_all_compared(card, kAxes, 100'000);
}

TEST(CardProbe, AnEdgeAtEveryClock) {
  EXPECT_EQ(lockstep::judge([] { edge_at_every_clock(0xFFFFFFF, 13); }), "");
}
TEST(CardProbe, AnEdgeAtEveryClockOnARamp) {
  EXPECT_EQ(lockstep::judge([] { edge_at_every_clock(0x400000, 17); }), "");
}

// A silent piece on a card in a hold, followed by the rest of its path. At every clock the hold ends, or an abort
// comes, or nothing happens until the program is over.
void held_silence(std::uint64_t seed) {
  constexpr unsigned kAxes = 4;
  sim::LockstepCard card = test::card_under_test(kAxes, seed, 0);
  AxiHost host(card, seed);
  Traffic traffic(host, kAxes);
  host.wait(300);
  host.write(reg::kSlew, 0x400000);
  unsigned held = 0;
  for (std::uint64_t at = 0; at < 400; ++at) {
    host.write(reg::kHold, 1);
    host.wait(300);
    std::uint64_t ticks = 60;
    std::vector<std::uint32_t> path;
    if (at % 3 == 0) {
      driver::encode(line(ticks, {30, -21, 0, 3}), 0, path);
    } else if (at % 3 == 1) {
      const auto random = [&host](std::uint64_t count) { return host.below(count); };
      const driver::ArcCommand arc = test::random_arc(random, kAxes);
      ticks = 2 * arc.path_ticks;
      driver::encode(driver::Command(driver::with_ticks(arc, ticks)), 0, path);
    } else {
      path = test::random_chords([&host](std::uint64_t count) { return host.below(count); }, kAxes, ticks = 0);
    }
    driver::FeedCommand silent = feed(ticks / 2 + 1, 1);
    silent.silent = true;
    traffic.send(silent);
    traffic.send_words(path, false);
    if (ticks > silent.ticks) traffic.send(feed(ticks - silent.ticks, 2));
    traffic.send(driver::EndCommand{});
    host.wait(at % 4 == 3 ? 30 * ticks : at);
    held += (traffic.status() & field::kStatusHeld) != 0 ? 1U : 0U;
    if (at % 4 == 1) traffic.abort();
    host.write(reg::kHold, 0);
    EXPECT_TRUE(traffic.wait_idle(100'000)) << at;
    if ((traffic.status() & (field::kStatusFaulted | field::kStatusRefused)) != 0) traffic.recover();
    host.write(reg::kSlew, 0x400000);
  }
  EXPECT_GT(held, 390U);
  expect_all_compared(card, kAxes, 100'000);
}

TEST(CardHold, ASilentPieceRunsInIt) {
  EXPECT_EQ(lockstep::judge([] { held_silence(19); }), "");
}

// Counts at the limits of the counters' parts: 4, 20 and more bits of ticks, 16 bits of a halfword; dwells too.
void counts_around(std::uint64_t count, std::uint64_t seed) {
  constexpr unsigned kAxes = 4;
  sim::LockstepCard card = test::card_under_test(kAxes, seed, 0);
  AxiHost host(card, seed);
  Traffic traffic(host, kAxes);
  host.wait(300);
  for (std::uint64_t n = count - 1; n <= count + 1; ++n) {
    traffic.send(line(n, {2, -1, 1, 0}));
    traffic.send(feed(n + 40, 1.01));
    traffic.send(line(40, {1, 1, 1, 1}));
    traffic.send(driver::DwellCommand{n});
    traffic.send(driver::EndCommand{});
    traffic.send(driver::DwellCommand{2});
  }
  host.wait(7 * count);
  EXPECT_TRUE(traffic.wait_idle(20'000));
  EXPECT_EQ(traffic.status() & field::kStatusFaulted, 0U);
  expect_all_compared(card, kAxes, 3 * count);
}

class CardCounts : public testing::TestWithParam<unsigned> {};

TEST_P(CardCounts, Around) {
  EXPECT_EQ(lockstep::judge([] { counts_around(std::uint64_t{1} << GetParam(), 3); }), "");
}

INSTANTIATE_TEST_SUITE_P(Bits, CardCounts, testing::Values(4U, 16U, 20U),
                         [](const auto& bits) { return std::to_string(bits.param); });

// Position streaming: the second of three periods is late, by a number of clocks before each of its words. Runs at
// the full ratio, in a hold, at a ratio of 0 and at half ratio. Either the card continues without a fault, or the
// period is missing.
struct Lateness {
  std::uint64_t late = 0;
  std::uint64_t missing = 0;
};

void late_period(AxiHost& host, Traffic& traffic, std::size_t word, std::uint64_t clocks, unsigned way,
                 Lateness& seen) {
  constexpr std::uint64_t kTicks = 110;  // of two clocks: a line's words take 130 clocks or so
  if (way == 3) host.write(reg::kRatioFeed, 0x8000);
  traffic.send(feed(kTicks, 2));
  traffic.send(line(kTicks, {20, -11, 3, 0}));
  std::vector<std::uint32_t> words;
  driver::encode(line(kTicks, {-7, 30, 0, 1}), 2, words);
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i == word) host.wait(clocks);
    if (i == word && way == 1) host.write(reg::kHold, 1);
    if (i == word && way == 2) host.write(reg::kRatioFeed, 0);
    host.write(reg::kStream, words[i]);
  }
  if (way == 1 || way == 2) host.wait(50);
  if (way == 1) host.write(reg::kHold, 0);
  if (way == 2) host.write(reg::kRatioFeed, 0x10000);
  driver::encode(line(kTicks, {1, 1, 1, 1}), 3, words = {});
  for (const std::uint32_t w : words) host.write(reg::kStream, w);
  driver::encode(driver::Command(driver::EndCommand{}), 4, words = {});
  for (const std::uint32_t w : words) host.write(reg::kStream, w);
  EXPECT_TRUE(traffic.wait_idle(20'000));
  const bool missing = host.read(reg::kFault) == field::kFaultMissingPeriod;
  EXPECT_TRUE(missing || (traffic.status() & field::kStatusEnded) != 0);
  ++(missing ? seen.missing : seen.late);
  traffic.recover();
  EXPECT_TRUE(traffic.wait_idle(2000));
}

void late_periods(unsigned way, std::uint64_t seed) {
  constexpr unsigned kAxes = 4;
  sim::LockstepCard card = test::card_under_test(kAxes, seed, 0);
  AxiHost host(card, seed);
  Traffic traffic(host, kAxes);
  traffic.streams = false;  // the mode stays on
  Lateness seen;
  host.wait(300);
  for (std::uint32_t stale_periods = 0; stale_periods < 3; ++stale_periods) {
    host.write(reg::kStreaming, field::kStreamingOn | stale_periods << field::kStreamingStalePeriodsShift);
    host.write(reg::kStopReaction, stale_periods == 2 ? 0 : field::kStopReactionMissingPeriod);
    for (std::size_t word = 0; word < 9; ++word) {
      for (std::uint64_t clocks = 0; clocks < (way == 3 ? 440 : 220) * (stale_periods + 2);
           clocks += 1 + host.below(30))
        late_period(host, traffic, word, clocks, way, seen);
    }
  }
  EXPECT_GT(seen.late, 50U);
  EXPECT_GT(seen.missing, 50U);
  expect_all_compared(card, kAxes, 100'000);
}

class CardStreaming : public testing::TestWithParam<unsigned> {};

TEST_P(CardStreaming, LateBeforeEveryWord) {
  EXPECT_EQ(lockstep::judge([] { late_periods(GetParam(), lockstep::seed_from_environment(13)); }), "");
}

std::string way_name(const testing::TestParamInfo<unsigned>& way) {
  constexpr const char* kNames[] = {"Plain", "Hold", "NoRatio", "HalfRatio"};
  return kNames[way.param];
}
INSTANTIATE_TEST_SUITE_P(Way, CardStreaming, testing::Range(0U, 4U), way_name);

// The watchdog expires during a line, with a ramp and without: the card stops, keeps the cause until WATCHDOG is
// written, and does not move when the cause is cleared.
void silent_host(std::uint64_t seed) {
  constexpr unsigned kAxes = 4;
  constexpr std::uint64_t kUnit = model::Watchdog::kUnitClocks;
  sim::LockstepCard card = test::card_under_test(kAxes, seed, 0);
  AxiHost host(card, seed);
  Traffic traffic(host, kAxes);
  host.wait(300);
  host.write(reg::kSlew, 0x40000);  // 4,096 clocks from full ratio to rest
  for (unsigned round = 0; round < 12; ++round) {
    const bool ramp = round % 2 == 0;
    host.write(reg::kStopReaction, ramp ? field::kStopReactionWatchdog : 0);
    host.write(reg::kSetPlace, 0xF0003);
    host.write(reg::kKeepsPlace, round % 4 == 3 ? 1 : 0);
    traffic.send(feed(200'000, 2));
    traffic.send(line(200'000, {9'000, -7'001, 3, 0}));
    traffic.send(driver::EndCommand{});
    host.write(reg::kWatchdog, 1);
    host.wait(round % 3 == 0 ? kUnit / 2 : 0);
    host.write(reg::kWatchdog, 1);
    host.wait(kUnit - 200 + host.below(100));
    EXPECT_EQ(host.read(reg::kFault), 0U) << round;
    host.wait(400);
    EXPECT_EQ(host.read(reg::kFault), field::kFaultWatchdog) << round;
    EXPECT_EQ((traffic.status() & field::kStatusStopping) != 0, ramp) << round;
    host.wait(ramp ? 5'000 : 500);
    EXPECT_EQ(traffic.status() & (field::kStatusBusy | field::kStatusFaulted), field::kStatusFaulted) << round;
    EXPECT_EQ(host.read(reg::kStopFault), field::kFaultWatchdog) << round;
    const std::uint32_t kept = ramp ? 0xB0B : round % 4 == 3 ? 0x909 : 0x808;
    EXPECT_EQ(host.read(reg::kPlace).value_or(0) & 0xB0B, kept) << round << ": the axes that moved, and one that stood";
    host.write(reg::kFault, field::kFaultWatchdog);
    EXPECT_EQ(host.read(reg::kFault), field::kFaultWatchdog) << "cleared before the host is back";
    host.write(reg::kWatchdog, round % 4 == 0 ? 3 : 0);
    const std::uint32_t position = card.model().position(0);
    host.write(reg::kFault, field::kFaultWatchdog);
    host.wait(6'000);
    EXPECT_EQ(host.read(reg::kFault), 0U) << round;
    EXPECT_EQ(card.model().position(0), position) << "clearing moves nothing";
    traffic.recover();
    host.write(reg::kSlew, 0x40000);
  }
  expect_all_compared(card, kAxes, 12 * kUnit);
}

TEST(CardWatchdog, StopsForASilentHost) {
  EXPECT_EQ(lockstep::judge([] { silent_host(lockstep::seed_from_environment(29)); }), "");
}

// Steps that wait for their shaper, with limits from 1 clock on: some are faults, others are not.
void waiting_steps(std::uint64_t seed) {
  constexpr unsigned kAxes = 4;
  sim::LockstepCard card = test::card_under_test(kAxes, seed, 0);
  AxiHost host(card, seed);
  Traffic traffic(host, kAxes);
  host.wait(300);
  unsigned faults = 0;
  for (std::uint32_t limit = 1; limit <= 300; limit += 1 + static_cast<std::uint32_t>(host.below(4))) {
    host.write(reg::kHoldLimit, limit);
    for (unsigned n = 0; n < kAxes; ++n) {
      host.write(reg::step_length(n), static_cast<std::uint32_t>(host.below(limit)));
      host.write(reg::step_space(n), static_cast<std::uint32_t>(host.below(20)));
      host.write(reg::dir_setup(n), static_cast<std::uint32_t>(host.below(limit)));
    }
    for (int i = 0; i < 3; ++i) {
      const std::uint64_t ticks = 30 + host.below(60);
      traffic.send(line(ticks, {4, host.below(2) == 0 ? 5 : -5, -4, 6}));
      traffic.send(feed(ticks, 1.2 + static_cast<double>(host.below(40)) / 4));
    }
    host.wait(500 + 12 * limit);
    if ((traffic.status() & field::kStatusFaulted) == 0) continue;
    ++faults;
    traffic.recover();
  }
  EXPECT_GT(faults, 3U);
  expect_all_compared(card, kAxes, 50'000);
}

TEST(CardLockstep, WaitingSteps) {
  EXPECT_EQ(lockstep::judge([] { waiting_steps(lockstep::seed_from_environment(11)); }), "");
}

}  // namespace
