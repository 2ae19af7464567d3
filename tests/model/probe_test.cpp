// Probing and waiting for an input on the golden core, against their documentation.
#include "trammel/model/probe.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core_bench.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;
using card_map::Area;

constexpr std::uint64_t kFullRate = ~std::uint64_t{0};  // a tick nearly every clock
constexpr unsigned kHigh = 0x20;                        // bit of a condition: a high level trips

// A card that probes along +X at one pulse per `ticks_a_pulse` ticks and one tick per four clocks; input 2 trips when
// it is high.
class Probing : public CoreBench {
 public:
  static constexpr std::uint64_t kClocksATick = 4;

  explicit Probing(std::uint32_t slew = 0xFFFFFFF) {
    idle(300);
    write(reg::kSlew, slew);
  }
  void start(std::uint64_t ticks, unsigned ticks_a_pulse) {
    EXPECT_TRUE(probe(kHigh | 2));
    EXPECT_TRUE(line(ticks, {kOnePulse / ticks_a_pulse}));
    EXPECT_TRUE(feed(ticks, kFullRate / kClocksATick));
    EXPECT_TRUE(probe_end());
  }
  bool has(std::uint32_t bit) { return (core.outputs().status & bit) != 0; }
  bool clear() { return write(reg::kControl, field::kControlProbeClear); }
  // Number of pulses at the pins up to this cycle.
  std::int64_t pulses_until(std::uint64_t cycle) const {
    return std::count_if(steps.pins.begin(), steps.pins.end(),
                         [cycle](const auto& pin) { return std::get<0>(pin) <= cycle; });
  }
  // Clocks until `bit` of STATUS is set, at most `limit`.
  std::uint64_t until(std::uint32_t bit, std::uint64_t limit) {
    std::uint64_t clocks = 0;
    for (; clocks < limit && !has(bit); ++clocks) idle(1);
    return clocks;
  }
};

TEST(Probe, TheEdgeLatchesPositionsTwoClocksAfterItShows) {
  for (std::uint64_t at = 0; at < 40; ++at) {
    Probing card;
    card.start(4000, 3);
    card.idle(400 + at);
    card.pins = 0b0100;
    card.idle(1);
    // INPUTS shows the level after two flip-flops; the strobe comes two clocks later.
    const std::uint64_t strobe = card.core.cycles() + 3;
    card.idle(400);
    EXPECT_TRUE(card.has(field::kStatusProbed));
    EXPECT_EQ(card.read(reg::time_lo(Area::Probe)), strobe);
    EXPECT_EQ(card.read(reg::position(Area::Probe, 0)), card.pulses_until(strobe)) << at;
    EXPECT_GT(card.pulses_until(strobe), 10);
    EXPECT_EQ(card.read(reg::geometry_begun(Area::Probe)), 1U);
  }
}

// The ratio goes from 1 to 0 in 2^28 / SLEW updates of 4 clocks; this makes the ticks of half that time.
TEST(Probe, TheStopIsARampAlongThePath) {
  for (const std::uint32_t slew : {0x100000U, 0x20000U, 0x8000U}) {
    const std::uint64_t ramp = 4 * (std::uint64_t{1} << 28) / slew;
    Probing card(slew);
    card.start(10 * ramp, 2);
    card.idle(2000);
    const std::uint64_t before = card.core.cycles();
    card.pins = 0b0100;
    card.until(field::kStatusHeld, 2 * ramp);
    EXPECT_NEAR(static_cast<double>(card.core.cycles() - before), static_cast<double>(ramp), 16);
    card.idle(100);
    EXPECT_FALSE(card.has(field::kStatusPathActive | field::kStatusFeedActive));
    const auto pulses = static_cast<double>(card.pulses_until(card.core.cycles()) - card.pulses_until(before));
    // Plus the pulses of about 16 clocks: those on their way to the pins, and those before the ratio first falls.
    EXPECT_NEAR(pulses, static_cast<double>(ramp / 2 + 16) / 2 / Probing::kClocksATick, 2);
    // No pulse follows, and the position equals the count of pulses.
    card.idle(5000);
    EXPECT_EQ(card.core.position(0), card.pulses_until(card.core.cycles()));
    EXPECT_EQ(card.core.position(0), card.pulses_until(before) + static_cast<std::int64_t>(pulses));
    EXPECT_EQ(card.read(reg::kFault), 0U);
  }
}

TEST(Probe, WhatIsQueuedUpToProbeEndIsDroppedAndCounted) {
  Probing card;
  EXPECT_TRUE(card.probe(kHigh | 2));
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(card.feed(280, kFullRate / 64));
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(card.line(300, {kOnePulse / 2}));
    EXPECT_TRUE(card.output(1, 0));
    EXPECT_TRUE(card.mark());
  }
  EXPECT_TRUE(card.circle(500, 4));
  EXPECT_TRUE(card.dwell(10'000));
  EXPECT_TRUE(card.probe(2));
  EXPECT_TRUE(card.wait_input(kHigh | 3, 0));
  EXPECT_TRUE(card.feed(10, kFullRate));  // ticks without a path are no fault when they are dropped
  EXPECT_TRUE(card.probe_end());
  EXPECT_TRUE(card.line(100, {0, kOnePulse / 2}));
  EXPECT_TRUE(card.feed(100, kFullRate / 16));
  EXPECT_TRUE(card.has(field::kStatusPathActive));
  card.pins = 0b0100;
  card.idle(3000);
  EXPECT_TRUE(card.has(field::kStatusProbed));
  EXPECT_TRUE(card.has(field::kStatusBusy));
  // Geometry: three lines, the arc, three barriers. Feed: six pieces and three barriers.
  EXPECT_EQ(card.read(reg::kGeometryBegun), 3U + 1 + 3);
  EXPECT_EQ(card.read(reg::kFeedBegun), 6U + 3);
  EXPECT_EQ(card.read(reg::kOutputs), 0U);
  EXPECT_EQ(card.read(reg::kMarks), 0U);
  EXPECT_EQ(card.core.position(1), 0);
  EXPECT_EQ(card.read(reg::kFault), 0U);
  // Commands behind PROBE_END run after the host has cleared the probe.
  EXPECT_TRUE(card.clear());
  EXPECT_TRUE(card.finish(2000));
  EXPECT_FALSE(card.has(field::kStatusProbed));
  EXPECT_EQ(card.core.position(1), 50);
  EXPECT_EQ(card.read(reg::kGeometryBegun), 8U);
}

TEST(Probe, AnInputThatIsTrippedAlreadyEndsItBeforeTheFirstStep) {
  Probing card;
  card.pins = 0b0100;
  card.idle(3);
  card.start(1000, 2);
  card.idle(3000);
  EXPECT_TRUE(card.has(field::kStatusProbed));
  EXPECT_TRUE(card.steps.pins.empty());
  EXPECT_EQ(card.read(reg::geometry_begun(Area::Probe)), 0U);
  EXPECT_EQ(card.read(reg::kGeometryBegun), 2U);
  EXPECT_TRUE(card.clear());
  EXPECT_TRUE(card.finish(100));
  EXPECT_TRUE(card.steps.path.empty());
}

// The probe is armed after 8 clocks without a path, counted from the first clock in which PROBE is decoded.
TEST(Probe, ItIsArmedWhenThePathBeforeItHasEnded) {
  Probing card;
  ASSERT_TRUE(card.line(200, {kOnePulse / 2}));
  ASSERT_TRUE(card.feed(200, kFullRate / 16));
  card.write(reg::kHold, 1);
  card.start(400, 2);
  card.pins = 0b0100;
  card.idle(20);
  card.write(reg::kHold, 0);
  // The input is ignored while the first path runs.
  std::uint64_t last = 0;
  for (int i = 0; i < 5000 && !card.has(field::kStatusProbed); ++i) {
    card.idle(1);
    if (card.core.outputs().tick) last = card.core.cycles();
  }
  EXPECT_EQ(card.core.cycles(), last + model::Probe::kSettle);
  EXPECT_EQ(card.steps.path.size(), 100U);
}

TEST(Probe, WithoutAnEdgeProbeEndSaysSo) {
  Probing card;
  card.start(100, 2);
  EXPECT_TRUE(card.finish(3000));
  EXPECT_TRUE(card.has(field::kStatusProbeMissed));
  EXPECT_FALSE(card.has(field::kStatusProbed));
  EXPECT_EQ(card.core.position(0), 50);
  card.pins = 0b0100;  // after the end of the probe
  card.idle(100);
  EXPECT_FALSE(card.has(field::kStatusProbed));
  EXPECT_TRUE(card.clear());
  card.idle(2);
  EXPECT_FALSE(card.has(field::kStatusProbeMissed));
  card.pins = 0;
  card.idle(3);
  card.start(100, 2);
  EXPECT_TRUE(card.finish(3000));
  EXPECT_TRUE(card.has(field::kStatusProbeMissed));
  // The next PROBE clears the flag when it is armed.
  card.start(4000, 2);
  card.idle(200);
  EXPECT_FALSE(card.has(field::kStatusProbeMissed));
  // A PROBE_END without a PROBE is an ordinary barrier.
  EXPECT_TRUE(card.finish(30'000));
  EXPECT_TRUE(card.clear());
  EXPECT_TRUE(card.probe_end());
  EXPECT_TRUE(card.finish(100));
  EXPECT_FALSE(card.has(field::kStatusProbeMissed));
}

TEST(Probe, ASecondProbeTakesTheFirstOnesPlace) {
  Probing card;
  EXPECT_TRUE(card.probe(kHigh | 2));
  EXPECT_TRUE(card.line(100, {kOnePulse / 2}));
  EXPECT_TRUE(card.probe(kHigh | 1));
  EXPECT_TRUE(card.line(2000, {kOnePulse / 2}));
  EXPECT_TRUE(card.feed(2100, kFullRate / 4));
  EXPECT_TRUE(card.probe_end());
  card.idle(1500);
  card.pins = 0b0100;
  card.idle(100);
  EXPECT_FALSE(card.has(field::kStatusProbed));
  card.pins = 0b0010;
  card.idle(10);
  EXPECT_TRUE(card.has(field::kStatusProbed));
}

TEST(Probe, AnAbortEndsItInEveryStateAndTheEdgeStaysKnown) {
  for (unsigned state = 0; state < 4; ++state) {
    Probing card(state == 2 ? 0x1000 : 0xFFFFFFF);
    if (state == 0) {  // the PROBE waits behind a path
      ASSERT_TRUE(card.line(100'000, {kOnePulse / 4}));
      ASSERT_TRUE(card.feed(100'000, kFullRate / 4));
    }
    card.start(100'000, 2);
    card.idle(500);
    if (state > 1) card.pins = 0b0100;
    card.idle(200);
    EXPECT_EQ(card.has(field::kStatusProbed), state > 1);
    EXPECT_EQ(card.has(field::kStatusPathActive), state < 3) << state;
    card.write(reg::kControl, field::kControlAbort);
    EXPECT_TRUE(card.finish(100)) << state;
    EXPECT_EQ(card.has(field::kStatusProbed), state > 1);
    // The probe is off: an edge does nothing, and new commands run.
    card.pins = state > 1 ? 0 : 0b0100;
    card.idle(20);
    card.number = 0;
    const auto from = card.core.position(0);
    ASSERT_TRUE(card.line(100, {kOnePulse / 2}));
    ASSERT_TRUE(card.feed(100, kFullRate / 16));
    EXPECT_TRUE(card.finish(400'000)) << state;
    EXPECT_EQ(card.core.position(0), from + 50) << state;
    EXPECT_EQ(card.has(field::kStatusProbed), state > 1);
    EXPECT_TRUE(card.clear());
    card.idle(2);
    EXPECT_FALSE(card.has(field::kStatusProbed));
  }
}

// A hold of the host waits for the end of a fixed piece; the hold of a probe does not.
TEST(Probe, FixedPiecesStopToo) {
  Probing card;
  EXPECT_TRUE(card.probe(kHigh | 2));
  EXPECT_TRUE(card.line(50'000, {kOnePulse / 4}));
  EXPECT_TRUE(card.feed(50'000, kFullRate / 4, 0, 0, 1, card_map::constant::kClassFixed));
  EXPECT_TRUE(card.probe_end());
  card.idle(500);
  card.pins = 0b0100;
  card.idle(100);
  EXPECT_TRUE(card.has(field::kStatusProbed));
  EXPECT_FALSE(card.has(field::kStatusPathActive));
}

// Dropped commands are not subtracted from the queued ticks, so the under-run guard does not hold until the queues have
// been empty once. Then it holds again.
TEST(Probe, TheUnderrunHoldForgetsWhatIsDropped) {
  Probing card;
  const auto starve = [&card] {
    ASSERT_TRUE(card.line(3000, {kOnePulse / 8}));
    ASSERT_TRUE(card.send(command_words(card_map::Opcode::Feed, 0, card.number++, 3000,
                                        {{"rate", kFullRate / 4}, {"floor", 1}, {"stop_distance", 100}})));
    card.idle(20'000);
  };
  EXPECT_TRUE(card.probe(kHigh | 2));
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(card.line(100'000, {kOnePulse / 8}));
  ASSERT_TRUE(card.feed(400'000, kFullRate / 4));
  ASSERT_TRUE(card.probe_end());
  card.idle(500);
  card.pins = 0b0100;
  card.idle(400);
  starve();  // behind PROBE_END
  EXPECT_TRUE(card.clear());
  card.idle(20'000);
  EXPECT_EQ(card.read(reg::kUnderruns), 0U);
  EXPECT_FALSE(card.has(field::kStatusBusy));
  starve();
  EXPECT_EQ(card.read(reg::kUnderruns), 1U);
  EXPECT_TRUE(card.has(field::kStatusUnderrun));
}

// While a fault stops the card on a ramp, edges and PROBE are ignored, so the snapshot in the STOP area stays intact.
TEST(Probe, AFaultsRampTakesNoEdge) {
  Probing card(0x4000);
  ASSERT_TRUE(card.write(reg::kStopReaction, 1));
  ASSERT_TRUE(card.write(reg::kHoldLimit, 50));
  ASSERT_TRUE(card.write(reg::step_length(0), 400));
  card.start(100'000, 20);  // one pulse per 80 clocks is too fast
  card.until(field::kStatusStopping, 100'000);
  EXPECT_TRUE(card.has(field::kStatusStopping));
  const std::uint64_t stopped = card.core.cycles();
  card.pins = 0b0100;
  card.idle(200'000);
  EXPECT_FALSE(card.has(field::kStatusProbed));
  EXPECT_FALSE(card.has(field::kStatusPathActive));
  EXPECT_NEAR(card.read(reg::time_lo(Area::Stop)), static_cast<double>(stopped), 3);
  EXPECT_EQ(card.read(reg::time_lo(Area::Probe)), 0U);
}

TEST(WaitInput, EndsWithItsLevelOrItsTime) {
  for (const std::uint64_t count : {1U, 2U, 50U, 1000U}) {
    CoreBench card;
    card.idle(300);
    ASSERT_TRUE(card.wait_input(kHigh | 3, count));
    std::uint64_t waiting = 0;
    for (int i = 0; i < 1200; ++i) {
      card.idle(1);
      waiting += (card.core.outputs().status & field::kStatusWaiting) != 0 ? 1U : 0U;
    }
    EXPECT_EQ(waiting, count);
    EXPECT_EQ(card.core.outputs().status & (field::kStatusBusy | field::kStatusFaulted), 0U);
    EXPECT_EQ(card.read(reg::kGeometryBegun), 1U);
    EXPECT_EQ(card.read(reg::kFeedBegun), 1U);
  }
  CoreBench card;
  card.idle(300);
  // Without a time-out the card waits as long as necessary, and so do the commands behind it.
  ASSERT_TRUE(card.wait_input(1, 0));
  card.pins = 0b0010;
  ASSERT_TRUE(card.line(100, {kOnePulse / 2}));
  ASSERT_TRUE(card.feed(100, kFullRate / 16));
  card.idle(100'000);
  EXPECT_NE(card.core.outputs().status & field::kStatusWaiting, 0U);
  EXPECT_EQ(card.core.position(0), 0);
  card.pins = 0;
  card.idle(2);
  EXPECT_NE(card.core.outputs().status & field::kStatusWaiting, 0U);
  card.idle(1);
  EXPECT_EQ(card.core.outputs().status & field::kStatusWaiting, 0U);
  EXPECT_TRUE(card.finish(3000));
  EXPECT_EQ(card.core.position(0), 50);
  // The input has the level already, so the wait takes one clock.
  ASSERT_TRUE(card.wait_input(1, 0));
  EXPECT_TRUE(card.finish(100));
}

// A condition can name inputs 16 to 31, which no card has; they read 0 at any level of the pins.
TEST(Probe, AnInputThatTheCardLacksStaysAtZero) {
  Probing card;
  card.pins = 0xFFFF;
  for (const unsigned input : {16U, 17U, 31U}) {
    ASSERT_TRUE(card.wait_input(input, 0));
    EXPECT_TRUE(card.finish(100)) << input;
    ASSERT_TRUE(card.wait_input(kHigh | input, 500));
    EXPECT_FALSE(card.finish(400)) << input;
    EXPECT_TRUE(card.finish(200)) << input;
  }
}

// Reserved bits of a condition, such as captures ([15]), are refused.
TEST(Probe, CapturesAreRefused) {
  for (unsigned bit = 6; bit < 16; ++bit) {
    for (const bool probes : {false, true}) {
      Probing card;
      const unsigned condition = 1U << bit | 1;
      EXPECT_FALSE(probes ? card.probe(condition) : card.wait_input(condition, 0)) << bit;
      EXPECT_EQ(card.read(reg::kRefusal) & 0xFF, static_cast<std::uint32_t>(card_map::Reason::BadField)) << bit;
    }
  }
}

}  // namespace
}  // namespace trammel::testing
