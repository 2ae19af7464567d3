// The whole card, RTL beside golden model, from the AXI4-Lite pins to the STEP pins: random traffic, and the features
// that only the whole card has.
#include <gtest/gtest.h>

#include <iostream>

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

// Bound in clocks of the answer to any access (docs/developer/architecture.md).
std::uint64_t answer_bound(unsigned axes) { return axes <= 4 ? 500 : 700; }

// One run of random traffic. All runs together have 10^8 clocks; scripts/test adds them up. There are several runs
// instead of one long one, so that ctest can use all cores.
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

void expect_all_happened(const Traffic& traffic, std::uint64_t clocks) {
  EXPECT_GT(traffic.underruns, clocks / 500'000);
  EXPECT_GT(traffic.missing, clocks / 1'000'000);
  EXPECT_GT(traffic.stale, clocks / 500'000);
  EXPECT_GT(traffic.probed, clocks / 100'000);
  EXPECT_GT(traffic.missed, clocks / 1'000'000);
  EXPECT_GT(traffic.holds, clocks / 100'000);
  EXPECT_GT(traffic.overrides, clocks / 100'000);
  if (!traffic.roles) return;
  // Each cause that an input can be.
  for (const std::uint32_t cause :
       {field::kFaultLimit, field::kFaultDriveFault, field::kFaultProbe, field::kFaultToolSetter})
    EXPECT_GT(traffic.causes_of(cause), clocks / 200'000) << "FAULT " << cause;
  EXPECT_GT(traffic.button_holds, clocks / 200'000);
  EXPECT_GT(traffic.captured, clocks / 200'000);
  EXPECT_GT(traffic.queued, clocks / 200'000);
  EXPECT_GT(traffic.lost, clocks / 2'000'000);
  // It comes once in some millions of clocks: too rare for a short run.
  if (clocks >= 5'000'000) {
    EXPECT_GT(traffic.causes_of(field::kFaultEmergencyStop), clocks / 5'000'000);
  }
}

void random_traffic(unsigned axes, std::uint64_t seed, std::uint64_t clocks) {
  sim::LockstepCard card = test::card_under_test(axes, seed, static_cast<std::uint32_t>(seed * 0x9E37 & 0xFFFF));
  AxiHost host(card, seed);
  Traffic traffic(host, axes);
  traffic.commands_every = 6;
  traffic.pwm = true;
  // In two of three runs inputs change by themselves.
  test::Switches switches(4, 15, seed);
  traffic.roles = seed % 3 != 0;
  if (traffic.roles) host.set_switches(&switches);
  traffic.emergency = traffic.enables = traffic.roles;
  host.wait(300);
  // Reads the constants, because random reads rarely meet one.
  for (std::uint32_t address = 0; address < 0x40; address += 4) host.read(address);
  // A direct move that is accepted; the random ones are often refused.
  host.write(reg::frequency_lo(0), 1U << 31);
  host.write(reg::count(0), 3);
  host.write(reg::kLengthLo, 100);
  host.write(reg::kStart, 1);
  traffic.settings();
  // From rare to frequent disturbances by the host.
  const std::uint64_t calm = 2 + 2 * (seed % 3);
  while (host.clocks() < clocks) traffic.run(10, calm);
  traffic.recover();
  traffic.wait_idle(100'000);
  EXPECT_LE(host.slowest_answer(), answer_bound(axes));
  if (clocks >= 1'000'000) expect_all_happened(traffic, clocks);  // a short run against mutants has fewer events
  expect_all_compared(card, axes, clocks);
  std::cout << card.cycles() << " clocks of random traffic compared, " << traffic.holds << " holds, "
            << traffic.overrides << " overrides, " << traffic.underruns << " under-runs, " << traffic.probed
            << " probes tripped, " << traffic.missed << " missed, " << traffic.button_holds << " holds by the button, "
            << traffic.captured << " looks at captures, " << traffic.queued << " at queued ones, " << traffic.lost
            << " at lost ones\n"
            << (traffic.roles ? card.cycles() : 0) << " of them with random inputs; by bit of FAULT:";
  for (const std::uint64_t count : traffic.causes) std::cout << ' ' << count;
  std::cout << '\n';
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

// Features of the whole card, each once: constants, strobes, a flush, full queues, counters, a reset between
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
  // A flush in the middle of a command.
  std::vector<std::uint32_t> words;
  driver::encode(line(10, {1}), 0, words);
  host.write(reg::kStream, words.front());
  host.write(reg::kControl, field::kControlFlush);
  read_live();
  traffic.recover();
  // Queues that become full while nothing moves.
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
  // After a reset a write comes before a read that waits at the same time, independent of the last access before it.
  host.write(reg::kHold, 1);
  host.reset(1);
  host.write_beside_read({reg::kHold, 1}, reg::kHold);
  EXPECT_TRUE(traffic.wait_idle(2000));
  expect_all_compared(card, axes, 10'000);
}

// Pieces that need more queued ticks than the queues can hold: the card waits until one queue is full, and then runs.
void full_queues(unsigned axes) {
  sim::LockstepCard card = test::card_under_test(axes, 7, 0);
  AxiHost host(card, 7);
  Traffic traffic(host, axes);
  constexpr std::uint64_t kLook = 150;  // clocks; the guard decides in fewer
  const auto send = [&](bool geometry, std::uint64_t ticks) {
    driver::FeedCommand piece = feed(ticks, 2);
    piece.stop_distance = 0xFFFFFFFF;
    return geometry ? traffic.send(line(ticks, std::vector<std::int64_t>(axes, 1))) : traffic.send(piece);
  };
  host.wait(300);
  for (const bool geometry : {true, false}) {
    traffic.recover();
    // Clocks of a direct move are not ticks of a piece: it has more clocks than all lines together have ticks.
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

// The under-run guard does not subtract commands that a probe drops: it suspends its rule until the card is at rest,
// and then applies it again.
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

// A reset of one clock in each clock of a write and a read whose answers the master never accepts.
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
  constexpr std::uint64_t kFilled = 1000;  // clocks: longer than the filling of the registers, with any number of axes
  for (unsigned at = 0; at < 24; ++at) {
    card.run({}, kFilled);
    card.run(ask, at);
    card.run(reset, 1);
    card.run(ask, kFilled);
    // The answers to the first requests after the reset are still there.
    EXPECT_TRUE(card.model().bus().bvalid && card.model().bus().rvalid) << at;
    card.run(reset, 1);
  }
  expect_all_compared(card, axes, 24'000);
}

// The emergency stop at times around the end of a reset, while the registers are filled. Reads back all registers,
// including those that a stop changes.
void emergency_stop_after_a_reset(unsigned axes) {
  sim::LockstepCard card = test::card_under_test(axes, 13, 0);
  AxiHost host(card, 13);
  host.wait(1000);
  for (const unsigned at : {0U, 1U, 30U, 100U, 200U, 400U, 440U, 450U, 460U, 590U, 610U, 620U}) {
    host.reset(1);
    host.wait(at);
    host.press_emergency_stop(true);
    host.wait(3);
    host.press_emergency_stop(false);
    host.wait(1000);
    EXPECT_EQ(host.read(reg::kFault), field::kFaultEmergencyStop) << at;
    EXPECT_EQ(host.read(reg::kStopFault), field::kFaultEmergencyStop) << at;
    EXPECT_EQ(host.read(reg::kRestFault), field::kFaultEmergencyStop) << at;
    for (std::uint32_t address = 0; address < card_map::kWindowBytes; address += 4) host.read(address);
  }
  expect_all_compared(card, axes, 50'000);
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

TEST_P(CardJoins, AnEmergencyStopAfterAReset) {
  EXPECT_EQ(lockstep::judge([] { emergency_stop_after_a_reset(GetParam()); }), "");
}

TEST_P(CardJoins, AProbeAndTheGuard) {
  EXPECT_EQ(lockstep::judge([] { guard_behind_a_probe(GetParam()); }), "");
}

INSTANTIATE_TEST_SUITE_P(Axes, CardJoins, testing::Values(3U, 4U, 7U),
                         [](const auto& axes) { return std::to_string(axes.param); });

}  // namespace
