// The whole card, RTL beside golden model, from the AXI4-Lite pins to the STEP pins: random traffic, and programs that
// are cut short at every clock.
#include <gtest/gtest.h>

#include <iostream>

#include "card_under_test.hpp"
#include "traffic.hpp"

namespace {

using namespace trammel;
using test::AxiHost;
using test::feed;
using test::line;
using test::Traffic;
namespace reg = card_map::reg;
namespace field = card_map::field;

// Any access is answered within this many clocks (docs/developer/architecture.md).
std::uint64_t answer_bound(unsigned axes) { return axes <= 4 ? 400 : 600; }

// Clocks compared, and whether every one of them was compared in every signal.
void expect_all_compared(sim::LockstepCard& card, unsigned axes, std::uint64_t at_least) {
  card.settle();
  EXPECT_GE(card.cycles(), at_least);
  EXPECT_EQ(card.comparisons(), card.cycles() * sim::signals_compared(axes));
}

// One run of random traffic; together 10^8 clocks, which scripts/test adds up. Several runs instead of a longer one:
// ctest spreads them over the cores.
struct TrafficRun {
  unsigned axes;
  unsigned index;
  std::uint64_t clocks;
};

std::vector<TrafficRun> runs() {
  std::vector<TrafficRun> result;
  for (unsigned axes = 1; axes <= 8; ++axes) {
    const unsigned count = axes == 4 ? 6 : 1;
    const std::uint64_t clocks = axes == 2 ? 12'900'000 : axes % 4 == 0 ? 11'600'000 : 1'300'000;
    for (unsigned i = 0; i < count; ++i) result.push_back({axes, i, clocks});
  }
  return result;
}

void random_traffic(unsigned axes, std::uint64_t seed, std::uint64_t clocks) {
  sim::LockstepCard card = test::card_under_test(axes, seed, static_cast<std::uint32_t>(seed * 0x9E37 & 0xFFFF));
  AxiHost host(card, seed);
  Traffic traffic(host, axes);
  traffic.commands_every = 6;
  host.wait(300);
  // The constants; the random reads seldom meet one.
  for (std::uint32_t address = 0; address < 0x40; address += 4) host.read(address);
  // A direct move that nothing refuses; the random ones are often refused.
  host.write(reg::frequency_lo(0), 1U << 31);
  host.write(reg::count(0), 3);
  host.write(reg::kLengthLo, 100);
  host.write(reg::kStart, 1);
  traffic.settings();
  // From hosts that leave the card in peace to hosts that do not.
  const std::uint64_t calm = 2 + 2 * (seed % 3);
  while (host.clocks() < clocks) traffic.run(10, calm);
  traffic.recover();
  traffic.wait_idle(100'000);
  EXPECT_LE(host.slowest_answer(), answer_bound(axes));
  EXPECT_GT(traffic.underruns, clocks / 500'000);
  EXPECT_GT(traffic.missing, clocks / 1'000'000);
  EXPECT_GT(traffic.stale, clocks / 500'000);
  EXPECT_GT(traffic.probed, clocks / 100'000);
  EXPECT_GT(traffic.missed, clocks / 1'000'000);
  EXPECT_GT(traffic.holds, clocks / 100'000);
  EXPECT_GT(traffic.overrides, clocks / 100'000);
  expect_all_compared(card, axes, clocks);
  std::cout << card.cycles() << " clocks of random traffic compared, " << traffic.holds << " holds, "
            << traffic.overrides << " overrides, " << traffic.underruns << " under-runs, " << traffic.probed
            << " probes tripped, " << traffic.missed << " missed\n";
}

class CardLockstep : public testing::TestWithParam<TrafficRun> {};

TEST_P(CardLockstep, RandomTraffic) {
  const TrafficRun run = GetParam();
  const std::uint64_t seed = lockstep::seed_from_environment(10 * run.axes + run.index);
  EXPECT_EQ(lockstep::judge([&] { random_traffic(run.axes, seed, lockstep::scaled(run.clocks)); }), "");
}

INSTANTIATE_TEST_SUITE_P(Axes, CardLockstep, testing::ValuesIn(runs()), [](const auto& run) {
  return std::to_string(run.param.axes) + "_" + std::to_string(run.param.index);
});

// Lines without a gap, an arc, a dwell, a line; about 800 clocks.
void short_program(Traffic& traffic, unsigned axes, AxiHost& host) {
  const auto random = [&host](std::uint64_t count) { return host.below(count); };
  std::uint64_t ticks = 0;
  for (const std::uint64_t n : {25U, 40U}) {
    traffic.send(line(n, std::vector<std::int64_t>(axes, 3)));
    ticks += n;
  }
  if (axes > 1) {
    const driver::ArcCommand arc = test::random_arc(random, axes);
    traffic.send(driver::with_ticks(arc, 2 * arc.path_ticks));
    ticks += 2 * arc.path_ticks;
  }
  traffic.send(feed(ticks, 1.5));
  traffic.send(driver::DwellCommand{30});
  traffic.send(line(20, std::vector<std::int64_t>(axes, -2)));
  traffic.send(feed(20, 2));
  traffic.send(driver::EndCommand{});
}

// What only the card joins, each of it once: constants, strobes, a flush, full queues, counters, a reset between
// accesses.
void joins(unsigned axes) {
  sim::LockstepCard card = test::card_under_test(axes, 5, 0x3A5C);
  AxiHost host(card, 5);
  Traffic traffic(host, axes);
  const auto read_live = [&host] {
    for (std::uint32_t address = reg::kStatus; address <= reg::kStaleTicks; address += 4) host.read(address);
  };
  host.wait(300);
  for (std::uint32_t address = 0; address < 0x40; address += 4) host.read(address);
  EXPECT_FALSE(host.write(reg::kHoldLimit, 7, 0x3));
  read_live();
  host.write(reg::kRefusal, 1);
  // A flush in mid command.
  std::vector<std::uint32_t> words;
  driver::encode(line(10, {1}), 0, words);
  host.write(reg::kStream, words.front());
  host.write(reg::kControl, field::kControlFlush);
  read_live();
  traffic.recover();
  // Queues that fill up while nothing moves.
  unsigned lines = 0;
  unsigned pieces = 0;
  host.write(reg::kRatioFeed, 0);
  while (traffic.send(line(5, std::vector<std::int64_t>(axes, 1)))) ++lines;
  read_live();
  traffic.recover();
  host.write(reg::kRatioFeed, 0);
  while (traffic.send(feed(5, 2))) ++pieces;
  read_live();
  EXPECT_GT(lines, 100U);
  EXPECT_GT(pieces, 50U);
  traffic.recover();
  traffic.send(driver::OutputCommand{1, 0});
  short_program(traffic, axes, host);
  for (int i = 0; i < 20; ++i) {
    read_live();
    host.write(reg::kControl, field::kControlSnapshot);
    host.read(reg::kSnapTimeLo);
  }
  // After a reset a write comes before a read that waits beside it, whatever came last.
  host.write(reg::kHold, 1);
  host.reset(1);
  host.write_beside_read({reg::kHold, 1}, reg::kHold);
  EXPECT_TRUE(traffic.wait_idle(2000));
  expect_all_compared(card, axes, 10'000);
}

// Pieces that want more ticks queued than the queues hold: the card stands until one of them is full, and goes on then.
void full_queues(unsigned axes) {
  sim::LockstepCard card = test::card_under_test(axes, 7, 0);
  AxiHost host(card, 7);
  Traffic traffic(host, axes);
  constexpr std::uint64_t kLook = 150;  // clocks; the guard looks at its rule in fewer
  const auto send = [&](bool geometry, std::uint64_t ticks) {
    driver::FeedCommand piece = feed(ticks, 2);
    piece.stop_distance = 0xFFFFFFFF;
    return geometry ? traffic.send(line(ticks, std::vector<std::int64_t>(axes, 1))) : traffic.send(piece);
  };
  host.wait(300);
  for (const bool geometry : {true, false}) {
    traffic.recover();
    // Clocks of a direct move are no ticks of a piece: more of them than all lines together have ticks.
    host.write(reg::frequency_hi(0), 0x80);
    host.write(reg::count(0), 3);
    host.write(reg::kLengthLo, 2000);
    host.write(reg::kStart, 1);
    EXPECT_TRUE(traffic.wait_idle(5000));
    EXPECT_TRUE(send(!geometry, 1'000'000));
    unsigned sent = 0;
    unsigned moving = 0;
    while (moving < 3 && sent < 1000 && send(geometry, geometry ? 4 : 10)) {
      ++sent;
      host.wait(kLook);
      moving += host.read(geometry ? reg::kGeometryBegun : reg::kFeedBegun).value_or(0) > 3 ? 1U : 0U;
    }
    EXPECT_GT(sent, 50U);
    EXPECT_GT(moving, 0U);
    traffic.abort();
  }
  expect_all_compared(card, axes, 10'000);
}

// What a probe drops the under-run guard does not count off: it has no rule until the card rests, and then has one
// again.
void guard_behind_a_probe(unsigned axes) {
  sim::LockstepCard card = test::card_under_test(axes, 9, 0);
  AxiHost host(card, 9);
  Traffic traffic(host, axes);
  host.wait(300);
  traffic.send(driver::ProbeCommand{2, true});
  traffic.send(feed(1000, 2));
  traffic.send(line(1000, std::vector<std::int64_t>(axes, 1)));
  traffic.send(driver::ProbeEndCommand{});
  host.wait(200);
  host.set_pins(0b100);
  host.wait(500);
  EXPECT_NE(traffic.status() & field::kStatusProbed, 0U);
  host.write(reg::kControl, field::kControlProbeClear);
  EXPECT_TRUE(traffic.wait_idle(2000));
  const std::uint32_t begun = host.read(reg::kFeedBegun).value_or(0);
  driver::FeedCommand piece = feed(100, 2);
  piece.stop_distance = 1'000'000;
  traffic.send(piece);
  traffic.send(line(100, std::vector<std::int64_t>(axes, 1)));
  host.wait(300);
  EXPECT_EQ(host.read(reg::kFeedBegun).value_or(0), begun);
  traffic.abort();
  expect_all_compared(card, axes, 1000);
}

// A reset of one clock in each clock of a write and a read whose answers nobody takes.
void resets_in_accesses(unsigned axes) {
  sim::LockstepCard card = test::card_under_test(axes, 11, 0);
  model::CardModel::Inputs ask;
  ask.awvalid = ask.wvalid = ask.arvalid = true;
  ask.wstrb = model::Axi4LitePort::kAllStrobes;
  ask.awaddr = reg::kHoldLimit;
  ask.wdata = 7;
  ask.araddr = reg::kAxes;
  model::CardModel::Inputs reset;
  reset.rst = true;
  for (unsigned at = 0; at < 24; ++at) {
    card.run({}, 300);
    card.run(ask, at);
    card.run(reset, 1);
    card.run(ask, 300);
    // The answers to what the first clocks after it asked for stand.
    EXPECT_TRUE(card.model().bus().bvalid && card.model().bus().rvalid) << at;
    card.run(reset, 1);
  }
  expect_all_compared(card, axes, 14'000);
}

class CardJoins : public testing::TestWithParam<unsigned> {};

TEST_P(CardJoins, AFullQueueMoves) {
  EXPECT_EQ(lockstep::judge([] { full_queues(GetParam()); }), "");
}

TEST_P(CardJoins, Once) {
  EXPECT_EQ(lockstep::judge([] { joins(GetParam()); }), "");
}

TEST_P(CardJoins, ResetsInAccesses) {
  EXPECT_EQ(lockstep::judge([] { resets_in_accesses(GetParam()); }), "");
}

TEST_P(CardJoins, AProbeAndTheGuard) {
  EXPECT_EQ(lockstep::judge([] { guard_behind_a_probe(GetParam()); }), "");
}

INSTANTIATE_TEST_SUITE_P(Axes, CardJoins, testing::Values(3U, 4U),
                         [](const auto& axes) { return std::to_string(axes.param); });

enum class Cut { kAbort, kResetOfOneClock, kResetOfTwoClocks, kHold, kStart };

// The program, cut at a clock of its own each time, and a new one at once.
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
    // A direct move may last; nothing outlasts a recovery.
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

// A probe's edge at every clock of a program of lines, an arc, outputs, a dwell and a second PROBE; what stands behind
// PROBE_END runs when the edge is cleared.
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

// Counts at the borders of the counters' parts: 4, 20 and more bits of ticks, 16 bits of a halfword, dwells alike.
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

// Position streaming: the second of three periods late by so many clocks before each of its words; under the full
// ratio, in a hold, at a ratio of 0 and at half of it. Either the card goes on without a fault, or the period was
// missing.
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

// Steps that wait for their shaper, under limits from 1 clock on: some are faults, some are not.
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
