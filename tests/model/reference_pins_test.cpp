// Tests of the statements about inputs, marks, barriers, counters and several ports in the reference pages, on the
// golden model.
#include <cstdlib>

#include "core_bench.hpp"
#include "reference_page.hpp"
#include "trammel/skip/card.hpp"

namespace trammel::reference_page {
namespace {

using trammel::testing::CoreBench;

constexpr unsigned kHigh = 1U << 5;  // bit of a condition: a high level

// Without a filter, a level that is sampled at one rising clock edge ends a wait and trips a probe.
TEST(ReferencePage, AnInputIsTakenAfterOneClock) {
  for (const bool probes : {false, true}) {
    CoreBench card;
    card.idle(300);
    if (probes) {
      ASSERT_TRUE(card.probe(kHigh | 3) && card.line(1'000'000, {kOnePulse / 100}) && card.feed(1'000'000, ~0ULL));
    } else {
      ASSERT_TRUE(card.wait_input(kHigh | 3, 0));
    }
    card.idle(1000);
    const std::uint32_t before = probes ? field::kStatusPathActive : field::kStatusWaiting;
    ASSERT_EQ(card.core.outputs().status & (before | field::kStatusProbed), before);
    card.pins = 1U << 3;
    card.idle(1);
    card.pins = 0;
    card.idle(50);
    EXPECT_EQ(card.core.outputs().status & before, 0U);
    EXPECT_EQ((card.core.outputs().status & field::kStatusProbed) != 0, probes);
  }
}

// Faults of units that the card lacks are never raised, by any input, any silence or any STOP_REACTION.
TEST(ReferencePage, NothingRaisesTheFaultsThatAreNotBuilt) {
  model::CardConfig config;
  config.inputs = 16;
  CoreBench card(config);
  card.idle(300);
  ASSERT_TRUE(card.write(reg::kStopReaction, 0xFCFF));
  ASSERT_TRUE(card.line(2'000'000, {kOnePulse / 1000}) && card.feed(2'000'000, ~0ULL));
  for (unsigned clocks = 0; clocks < 1000; ++clocks) {
    card.pins = static_cast<std::uint16_t>(clocks * 0x9E37U);
    card.idle(10);
  }
  skip::run(card.core, 1'000'000, 0xFFFF);
  EXPECT_EQ(card.read(reg::kFault), 0U);
  EXPECT_NE(card.core.outputs().status & field::kStatusPathActive, 0U);
}

// The host sends a barrier once, and both queues get it.
TEST(ReferencePage, ABarrierIsSentOnce) {
  CoreBench card;
  card.idle(300);
  std::uint32_t sent = 0;
  const auto expect_one_more = [&] {
    card.idle(200);
    ++sent;
    EXPECT_EQ(card.read(reg::kGeometryBegun), sent);
    EXPECT_EQ(card.read(reg::kFeedBegun), sent);
    EXPECT_EQ(card.core.outputs().status & field::kStatusBusy, 0U);
  };
  ASSERT_TRUE(card.dwell(10));
  expect_one_more();
  ASSERT_TRUE(card.end());
  expect_one_more();
  ASSERT_TRUE(card.wait_input(0, 0));
  expect_one_more();
  ASSERT_TRUE(card.probe_end());
  expect_one_more();
}

// Longest time in clocks until a waiting pulse of an axis is made, in either direction.
constexpr std::uint64_t longest_pulse(std::uint32_t length, std::uint32_t space, std::uint32_t hold,
                                      std::uint32_t setup) {
  return std::max(1U, length) + std::uint64_t{space} + hold + setup + 12;
}

struct AtMark {
  std::int32_t missing;  // pulses that the area lacks
  std::uint64_t clocks;  // from the time of the area to the last leading edge
};

// A line of |steps| steps (backwards if negative) with a step per `gap` clocks, then `dwell` clocks and a MARK. All
// times of the axis are `time`.
AtMark at_mark(int steps, unsigned gap, std::uint32_t time, std::uint64_t dwell) {
  Host host(1);
  for (const std::uint32_t address : {reg::step_length(0), reg::step_space(0), reg::dir_setup(0), reg::dir_hold(0)})
    host.write(address, time);
  host.write(reg::kHold, 1);
  host.clocks(50);
  const auto ticks = static_cast<std::uint64_t>(std::abs(steps));
  host.send(line(ticks, steps < 0 ? -kOnePulse : kOnePulse));
  host.send(feed(ticks, gap));
  if (dwell != 0) host.send(driver::DwellCommand{dwell});
  host.send(driver::MarkCommand{});
  host.send(driver::EndCommand{});
  host.write(reg::kHold, 0);
  host.idle();
  EXPECT_EQ(host.read(reg::kFault), 0U) << steps << " steps, a step in " << gap << " clocks, times of " << time;
  const auto latched = static_cast<std::int32_t>(host.read(reg::position(Area::Mark, 0)));
  const std::uint64_t mark = host.read(reg::time_lo(Area::Mark));
  const std::uint64_t last = host.pins.back().tick;
  return {std::abs(host.position(0) - latched), last > mark ? last - mark : 0};
}

// The MARK area always lacks the step of the last tick, and up to four other steps that wait. After a dwell that is
// long enough it lacks none.
TEST(ReferencePage, AMarkBehindALineLacksUpToFivePulses) {
  std::int32_t most = 0;
  for (const std::uint32_t time : {0U, 1U, 4U, 50U, 1000U}) {
    const std::uint64_t longest = longest_pulse(time, time, time, time);
    for (const int steps : {-4, -1, 1, 2, 5}) {
      for (const unsigned gap : {1U, 2U, 4U, 16U}) {
        const AtMark at = at_mark(steps, gap, time, 0);
        EXPECT_GE(at.missing, 1);
        EXPECT_LE(at.missing, 5);
        EXPECT_LE(at.clocks, 5 * longest);
        most = std::max(most, at.missing);
        EXPECT_EQ(at_mark(steps, gap, time, 5 * longest).missing, 0);
      }
    }
    const AtMark alone = at_mark(2, 20'000, time, 0);
    EXPECT_EQ(alone.missing, 1) << "steps that do not wait";
    EXPECT_EQ(alone.clocks, 5U);
  }
  EXPECT_EQ(most, 5);
}

// POSITION is a counter of 32 bits: below 0 it continues at 2^32 - 1.
TEST(ReferencePage, PositionsCountModulo2To32) {
  Host host(1);
  const auto move = [&host](std::int64_t by) {
    host.send(line(2, by));
    host.send(feed(2, 100));
    host.send(driver::EndCommand{});
    host.idle();
    host.write(reg::kControl, field::kControlSnapshot);
    return host.read(reg::position(Area::Snap, 0));
  };
  EXPECT_EQ(move(-kOnePulse), 0xFFFF'FFFEU);
  EXPECT_EQ(move(kOnePulse), 0U);
}

// Two hosts on two ports of one card.
class TwoPorts {
 public:
  TwoPorts() : card_(config()) { card_.idle(300); }

  bool write(std::uint8_t port, std::uint32_t address, std::uint32_t data) { return access(port, true, address, data); }
  bool send(std::uint8_t port, const std::vector<std::uint32_t>& words) {
    return std::all_of(words.begin(), words.end(), [&](std::uint32_t word) { return write(port, reg::kStream, word); });
  }
  std::uint32_t read(std::uint8_t port, std::uint32_t address) {
    access(port, false, address, 0);
    return card_.core.answer().data;
  }
  std::uint32_t refusal(std::uint8_t port) { return read(port, reg::kRefusal); }

 private:
  static model::CardConfig config() {
    model::CardConfig config;
    config.ports = 2;
    return config;
  }
  bool access(std::uint8_t port, bool write, std::uint32_t address, std::uint32_t data) {
    model::CoreModel::Inputs in;
    in.request = true;
    in.port = port;
    in.write = write;
    in.address = address;
    in.data = data;
    card_.clock(in);
    while (!card_.core.answer().ack) card_.clock({});
    return !card_.core.answer().error;
  }

  CoreBench card_;
};

constexpr std::uint32_t refusal(Reason reason, std::uint32_t number, std::uint32_t address) {
  return static_cast<std::uint32_t>(reason) | number << 8 | address << 16;
}

std::vector<std::uint32_t> dwell_words(std::uint8_t number) {
  return trammel::testing::command_words(card_map::Opcode::Dwell, 0, number, 0, {});
}

// A flush by one port ends the command of the other port. The port that flushed gets the refusal in its register; the
// other port is told by the refusal of its next word.
TEST(ReferencePage, AFlushByAnotherPort) {
  TwoPorts card;
  ASSERT_TRUE(card.send(0, dwell_words(0)));
  const std::vector<std::uint32_t> words = dwell_words(1);
  ASSERT_TRUE(card.write(0, reg::kStream, words[0]));
  EXPECT_FALSE(card.write(1, reg::kStream, words[0])) << "the stream is port 0's";
  EXPECT_EQ(card.refusal(1), refusal(Reason::Busy, 0, reg::kStream));
  ASSERT_TRUE(card.write(1, reg::kRefusal, 1));
  EXPECT_TRUE(card.write(1, reg::kControl, field::kControlFlush));
  EXPECT_EQ(card.refusal(1), refusal(Reason::Truncated, 1, reg::kControl));
  EXPECT_EQ(card.refusal(0), 0U);
  EXPECT_FALSE(card.write(0, reg::kStream, words[1]));
  EXPECT_EQ(card.refusal(0), refusal(Reason::StreamClosed, 1, reg::kStream));
}

// An abort by one port drops the command of the other port without a refusal in either register. The next word of the
// other port is read as the first word of a command.
TEST(ReferencePage, AnAbortByAnotherPort) {
  TwoPorts card;
  ASSERT_TRUE(card.send(0, dwell_words(0)));
  const std::vector<std::uint32_t> words = dwell_words(1);
  ASSERT_TRUE(card.write(0, reg::kStream, words[0]));
  EXPECT_NE(card.read(0, reg::kStatus) & field::kStatusIncomplete, 0U);
  EXPECT_TRUE(card.write(1, reg::kControl, field::kControlAbort));
  EXPECT_EQ(card.refusal(0), 0U);
  EXPECT_EQ(card.refusal(1), 0U);
  EXPECT_EQ(card.read(0, reg::kStatus) & (field::kStatusIncomplete | field::kStatusBusy), 0U);
  EXPECT_FALSE(card.write(0, reg::kStream, words[1]));
  EXPECT_EQ(card.refusal(0) & field::kRefusalReason, static_cast<std::uint32_t>(Reason::UnknownOpcode));
}

}  // namespace
}  // namespace trammel::reference_page
