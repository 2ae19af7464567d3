// Probing and waiting for an input through the driver, on both engines. A switch follows the position; the steps at the
// pins show where the card was.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "commands.hpp"
#include "steps.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/sim/engines.hpp"

namespace {

using namespace trammel;
using namespace std::chrono_literals;
using driver::Command;
using driver::ProbeCommand;
using driver::ProbeOutcome;
using driver::ProbeResult;
using testing::HasSubstr;

constexpr std::uint32_t kClockHz = 10'000'000;
constexpr std::uint64_t kClocksATick = 16;

class DriverProbe : public testing::TestWithParam<sim::EngineKind> {
 protected:
  DriverProbe() : engine(make(GetParam())), card(driver::Card::open(*engine)) { engine->set_sink(&steps); }

  static std::unique_ptr<sim::Engine> make(sim::EngineKind kind) {
    sim::SimulationOptions options;
    options.kind = kind;
    options.clock_hz = kClockHz;
    return sim::make_engine(options);
  }
  // Polls often, and updates the switch at each poll.
  driver::StreamOptions options() {
    driver::StreamOptions result;
    result.poll_clocks = 64;
    result.margin = 10ms;
    result.progress = [this](const driver::StreamProgress& progress) {
      if (look) look(progress);
    };
    return result;
  }
  // Input 2 rises when axis 0 has reached `at`.
  void switch_at(std::int64_t at) {
    look = [this, at](const driver::StreamProgress&) {
      if (pressed_at == 0 && engine->positions()[0] >= at) {
        engine->set_inputs(0b0100);
        pressed_at = engine->cycles();
      }
    };
  }
  static Command line(std::uint64_t ticks, std::int64_t pulses) { return test::line(ticks, {pulses}); }
  static Command feed(std::uint64_t ticks) { return test::feed(ticks, static_cast<double>(kClocksATick)); }
  static std::vector<Command> towards(std::uint64_t ticks, std::int64_t pulses) {
    return {line(ticks, pulses), feed(ticks)};
  }
  static std::string text_of(driver::Stream& stream, const ProbeCommand& probe, const std::vector<Command>& paths) {
    try {
      stream.probe(probe, paths);
    } catch (const driver::ArgumentError& error) {
      return error.what();
    }
    return {};
  }

  std::unique_ptr<sim::Engine> engine;
  driver::Card card;
  test::Steps steps;
  std::function<void(const driver::StreamProgress&)> look;
  std::uint64_t pressed_at = 0;  // cycle
};

INSTANTIATE_TEST_SUITE_P(Engines, DriverProbe, testing::Values(sim::EngineKind::kRtl, sim::EngineKind::kModel),
                         [](const auto& kind) { return kind.param == sim::EngineKind::kRtl ? "Rtl" : "Model"; });

TEST_P(DriverProbe, TheEdgeIsLatchedAndTheStopIsARamp) {
  constexpr std::uint64_t kRamp = 20'000;  // clocks from full ratio to rest: 2 ms
  card.set_slew_time(2ms);
  driver::Stream stream(card, options());
  switch_at(500);
  const ProbeResult result = stream.probe(ProbeCommand{2, true}, towards(20'000, 5000));
  EXPECT_EQ(result.outcome, ProbeOutcome::kTripped);
  // Three clocks from the pin: two flip-flops and the strobe.
  EXPECT_EQ(result.edge.time, pressed_at + 3);
  EXPECT_EQ(result.edge.position[0], steps.position(0, result.edge.time));
  EXPECT_GE(result.edge.position[0], 500);
  EXPECT_TRUE(result.edge.status.path_active);
  // The way to rest takes the ticks of half the ramp, with a pulse every four ticks.
  EXPECT_NEAR(result.rest.position[0] - result.edge.position[0], kRamp / 2 / kClocksATick / 4, 2);
  EXPECT_EQ(result.rest.position[0], steps.position(0, engine->cycles()));
  EXPECT_FALSE(result.rest.status.busy);
  EXPECT_FALSE(result.rest.status.probed);
  // Moves back to the edge: the stream can go on.
  const std::int64_t back = result.edge.position[0] - result.rest.position[0];
  stream.send({line(1000, back), feed(1000), driver::EndCommand{}});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_EQ(engine->positions()[0], result.edge.position[0]);
}

TEST_P(DriverProbe, TrippedAlready) {
  driver::Stream stream(card, options());
  stream.send({line(100, 10), feed(100)});
  engine->set_inputs(0b0100);
  const ProbeResult result = stream.probe(ProbeCommand{2, true}, towards(20'000, 5000));
  EXPECT_EQ(result.outcome, ProbeOutcome::kTrippedAlready);
  EXPECT_EQ(result.edge.position[0], 10);
  EXPECT_EQ(result.rest.position[0], 10);
  EXPECT_EQ(steps.pins.size(), 10U);
}

TEST_P(DriverProbe, Missed) {
  driver::Stream stream(card, options());
  engine->set_inputs(0b1011);
  const ProbeResult missed = stream.probe(ProbeCommand{2, true}, towards(2000, 50));
  EXPECT_EQ(missed.outcome, ProbeOutcome::kMissed);
  EXPECT_EQ(missed.rest.position[0], 50);
  EXPECT_EQ(missed.edge.time, 0U);
  // The next probe does not report this result as its own.
  switch_at(60);
  const ProbeResult found = stream.probe(ProbeCommand{2, true}, towards(20'000, 5000));
  EXPECT_EQ(found.outcome, ProbeOutcome::kTripped);
  EXPECT_EQ(found.edge.position[0], steps.position(0, found.edge.time));
}

// More paths than the queues hold: commands that the host still sends are dropped too.
TEST_P(DriverProbe, PathsLongerThanTheQueues) {
  driver::Stream stream(card, options());
  std::vector<Command> paths;
  for (int i = 0; i < 1000; ++i) {
    paths.push_back(line(200, 10));
    paths.push_back(feed(200));
    if (i % 7 == 0) paths.push_back(driver::MarkCommand{});
  }
  switch_at(300);
  const ProbeResult result = stream.probe(ProbeCommand{2, true}, paths);
  EXPECT_EQ(result.outcome, ProbeOutcome::kTripped);
  EXPECT_LT(result.rest.position[0], 400);
  EXPECT_EQ(result.rest.geometry_begun, 1001U);  // paths and PROBE_END, executed or dropped
  EXPECT_EQ(result.rest.feed_begun, 1001U);
  stream.send({line(100, 7), feed(100)});
  stream.finish();
  EXPECT_EQ(engine->positions()[0], result.rest.position[0] + 7);
}

TEST_P(DriverProbe, WhatItRefuses) {
  driver::Stream stream(card, options());
  const std::vector<Command> paths = towards(100, 10);
  EXPECT_THAT(text_of(stream, ProbeCommand{16, true}, paths), HasSubstr("PROBE: input 16, but the card has 16 inputs"));
  EXPECT_THAT(text_of(stream, ProbeCommand{0, true}, {}), HasSubstr("probe: no paths"));
  EXPECT_THAT(text_of(stream, ProbeCommand{}, {line(5, 1), ProbeCommand{}}), HasSubstr("probe: PROBE among the paths"));
  EXPECT_THAT(text_of(stream, ProbeCommand{}, {line(5, 1), driver::EndCommand{}}), HasSubstr("END among the paths"));
  EXPECT_THROW(stream.put(driver::WaitInputCommand{19, true, 0}), driver::ArgumentError);
  EXPECT_EQ(stream.sent(), 0U);
  EXPECT_TRUE(steps.pins.empty());
}

TEST_P(DriverProbe, AnAbortFromElsewhereEndsIt) {
  driver::Stream stream(card, options());
  look = [this](const driver::StreamProgress&) {
    if (engine->positions()[0] >= 50) card.request_abort();
  };
  EXPECT_THROW(stream.probe(ProbeCommand{2, true}, towards(20'000, 5000)), driver::StateError);
  EXPECT_LT(engine->positions()[0], 200);
  stream.restart();
  switch_at(engine->positions()[0] + 100);
  EXPECT_EQ(stream.probe(ProbeCommand{2, true}, towards(20'000, 5000)).outcome, ProbeOutcome::kTripped);
}

TEST_P(DriverProbe, WaitingForAnInputOutlastsAnyMargin) {
  driver::Stream stream(card, options());
  const std::uint64_t begin = engine->cycles();
  constexpr std::uint64_t kLate = 2'000'000;  // 200 ms: 20 times the margin
  look = [this, begin](const driver::StreamProgress& progress) {
    EXPECT_EQ(steps.pins.size(), progress.status.waiting ? 10U : steps.pins.size());
    if (engine->cycles() - begin > kLate) engine->set_inputs(0b0010);
  };
  stream.send({line(100, 10), feed(100), driver::WaitInputCommand{1, true, 0}, line(100, 10), feed(100)});
  stream.finish();
  EXPECT_GT(engine->cycles() - begin, kLate);
  EXPECT_EQ(steps.pins.size(), 20U);
  EXPECT_GT(steps.pins[10].cycle, begin + kLate);
  // A time-out is no error; the input shows whether it occurred.
  look = nullptr;
  engine->set_inputs(0);
  const std::uint64_t before = engine->cycles();
  stream.send(driver::WaitInputCommand{1, true, 500'000});
  stream.finish();
  EXPECT_GE(engine->cycles() - before, 500'000U);
  EXPECT_LT(engine->cycles() - before, 510'000U);
  EXPECT_EQ(card.read_inputs() & 0b0010, 0);
}

}  // namespace
