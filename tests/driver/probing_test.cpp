// Probing through the stream. On the model: the results at the edge and at rest, and refusals before any motion. On a
// stub: a card that another program has used, and a card that hangs.
#include <gmock/gmock.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "error_message.hpp"
#include "register_stub.hpp"
#include "stream_commands.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using test::RegisterStub;
using ::testing::HasSubstr;
namespace reg = card_map::reg;
namespace field = card_map::field;

// A line of 1,000 pulses in 1 s.
std::vector<Command> probing_paths() { return {feed_of(62'500), line_of(62'500, 1000)}; }

class Probing : public ::testing::Test {
 protected:
  Probing() : card_(Card::open(*engine_)) { card_.set_slew_time(20ms); }

  // Options that set input 5 to `level` at the first look after 100 pulses. The next look comes 5 pulses later.
  StreamOptions tripping(bool level) {
    StreamOptions options;
    options.poll_clocks = 5000;
    options.progress = [this, level](const StreamProgress&) {
      if (tripped_at_ != 0 || engine_->positions()[0] < 100) return;
      tripped_at_ = engine_->positions()[0];
      engine_->set_input(5, level);
    };
    return options;
  }

  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine({});
  Card card_;
  std::int64_t tripped_at_ = 0;  // position at which input 5 was set, pulses
};

TEST_F(Probing, TheEdgeEndsTheWayAndTheStreamGoesOn) {
  for (const bool level : {true, false}) {
    engine_->reset();
    tripped_at_ = 0;
    engine_->set_input(5, !level);
    engine_->wait(3000);
    Card card = Card::open(*engine_);
    card.set_slew_time(20ms);
    Stream stream(card, tripping(level));
    stream.send({feed_of(100), line_of(100, 3)});
    const ProbeResult result = stream.probe({5, level}, probing_paths());
    EXPECT_EQ(result.outcome, ProbeOutcome::kTripped);
    ASSERT_GE(tripped_at_, 100);
    EXPECT_EQ(result.edge.position[0], tripped_at_) << "of the edge, not of the look that has found it";
    EXPECT_EQ(result.edge.geometry_begun, 2U) << "the line before, and that of the probing";
    // The ramp of 20 ms covers the distance of 10 ms at full speed: 10 pulses.
    EXPECT_GE(result.rest.position[0], result.edge.position[0] + 9);
    EXPECT_LE(result.rest.position[0], result.edge.position[0] + 12);
    EXPECT_EQ(result.rest.position[0], engine_->positions()[0]);
    EXPECT_GT(result.rest.time, result.edge.time);
    const Status status = card.read_status();
    EXPECT_FALSE(status.probed) << "cleared for the next";
    EXPECT_FALSE(status.busy);
    stream.send({feed_of(100), line_of(100, -10), EndCommand{}});
    EXPECT_TRUE(stream.finish().ended);
    EXPECT_EQ(engine_->positions()[0], result.rest.position[0] - 10);
  }
}

TEST_F(Probing, NothingMovesWhereTheInputHasItsLevelAlready) {
  engine_->set_input(5, true);
  engine_->wait(3000);
  Stream stream(card_);
  const ProbeResult result = stream.probe({5, true}, probing_paths());
  EXPECT_EQ(result.outcome, ProbeOutcome::kTrippedAlready);
  EXPECT_EQ(result.edge.position[0], 0);
  EXPECT_EQ(result.rest.position[0], 0);
  EXPECT_EQ(engine_->positions()[0], 0);
  // The input never has the other level, so the whole line runs.
  const ProbeResult back = stream.probe({5, false}, {feed_of(1000), line_of(1000, 10)});
  EXPECT_EQ(back.outcome, ProbeOutcome::kMissed);
  EXPECT_EQ(engine_->positions()[0], 10);
}

TEST_F(Probing, AMissEndsWhereThePathsEnd) {
  Stream stream(card_);
  const ProbeResult result = stream.probe({5, true}, {feed_of(1000), line_of(600, 7), line_of(400, -2)});
  EXPECT_EQ(result.outcome, ProbeOutcome::kMissed);
  EXPECT_EQ(result.edge.time, 0U);
  EXPECT_EQ(result.rest.position[0], 5);
  EXPECT_TRUE(card_.read_status().probe_missed);
  stream.send({feed_of(100), line_of(100, 1), EndCommand{}});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_EQ(engine_->positions()[0], 6);
}

TEST_F(Probing, WhatCannotBeProbedIsRefusedBeforeAnythingMoves) {
  Stream stream(card_);
  const auto refusal = [&](const ProbeCommand& condition, const std::vector<Command>& paths) {
    return argument_error([&] { stream.probe(condition, paths); });
  };
  EXPECT_EQ(refusal({16, true}, probing_paths()), "stream: PROBE: input 16, but the card has 16 inputs");
  EXPECT_THAT(refusal({32, true}, probing_paths()), HasSubstr("PROBE: input 32"));
  EXPECT_EQ(refusal({5, true}, {}), "probe: no paths to move along");
  EXPECT_EQ(refusal({5, true}, {line_of(1), ProbeCommand{5, true}}), "probe: PROBE among the paths");
  EXPECT_EQ(refusal({5, true}, {line_of(1), ProbeEndCommand{}}), "probe: PROBE_END among the paths");
  EXPECT_EQ(refusal({5, true}, {line_of(1), feed_of(1), EndCommand{}}), "probe: END among the paths");
  LineCommand fifth = line_of(1);
  fifth.mask = 0x10;
  EXPECT_EQ(refusal({5, true}, {feed_of(1), fifth}), "stream: axis mask 0x10, but the card has 4 axes");
  EXPECT_EQ(refusal({5, true}, {WaitInputCommand{17, true, 0}}),
            "stream: WAIT_INPUT: input 17, but the card has 16 inputs");
  EXPECT_EQ(stream.sent(), 0U);
  EXPECT_FALSE(card_.busy());
  EXPECT_EQ(stream.probe({15, true}, {feed_of(100), line_of(100, 1)}).outcome, ProbeOutcome::kMissed);
}

// A card whose registers the test sets.
class ProbingOnStub : public ::testing::Test {
 protected:
  ProbingOnStub() {
    bus_.add_engines(card_map::engines::kPathCommands);
    bus_.values[reg::kPorts] = 0x04'04'01;
    bus_.values[reg::kGeometryRoom] = 4096;
    bus_.values[reg::kFeedRoom] = 2560;
    card_.emplace(Card::open(bus_));
    stream_.emplace(*card_, StreamOptions{100, 10ms, nullptr, false});
    bus_.forget();
  }
  void say_begun(std::uint32_t commands) {
    bus_.on_access = [this, commands](const Access& access) {
      if (access.write && access.address == reg::kStream)
        bus_.values[reg::kGeometryBegun] = bus_.values[reg::kFeedBegun] = commands;
      return true;
    };
  }
  void probe() { stream_->probe({3, true}, {feed_of(1000), line_of(1000)}); }

  RegisterStub bus_;
  std::optional<Card> card_;
  std::optional<Stream> stream_;
};

TEST_F(ProbingOnStub, AnEdgeThatSomebodyElseHasClearedIsNoMiss) {
  say_begun(2);
  EXPECT_EQ(message_of<StateError>([&] { probe(); }),
            "probe: it is over without an edge and without a miss: somebody else has cleared it");
  EXPECT_THROW(stream_->flush(), StateError) << "closed";
}

TEST_F(ProbingOnStub, AnIdleCardThatHasNotBegunAllWasReset) {
  say_begun(1);
  EXPECT_THAT(message_of<StateError>([&] { probe(); }),
              HasSubstr("the card is idle, but of 2 geometry and 2 feed commands it has begun 1 and 1"));
  EXPECT_THROW(stream_->flush(), StateError) << "closed";
}

TEST_F(ProbingOnStub, AHangTimesOut) {
  say_begun(1);
  bool written = false;
  const auto begun = bus_.on_access;
  bus_.on_access = [&, begun](const Access& access) {
    written = written || (access.write && access.address == reg::kStream);
    if (written) bus_.values[reg::kStatus] = field::kStatusBusy;
    return begun(access);
  };
  EXPECT_THAT(message_of<TimeoutError>([&] { probe(); }),
              HasSubstr("probe: waiting for the edge or the end of the paths: not within"));
  EXPECT_GE(bus_.slept, 26ms) << "16,000 clocks of the piece, and the margin";
  EXPECT_LE(bus_.slept, 27ms);
}

TEST_F(ProbingOnStub, TheEdgeIsClearedBeforeAndBehind) {
  say_begun(2);
  bus_.next[reg::kStatus] = {0, field::kStatusBusy, field::kStatusBusy | field::kStatusProbed};
  bus_.values[reg::probe_position(0)] = 7;
  bus_.values[reg::kProbeGeometryBegun] = 1;
  const ProbeResult result = stream_->probe({3, true}, {feed_of(1000), line_of(1000)});
  EXPECT_EQ(result.outcome, ProbeOutcome::kTripped);
  EXPECT_EQ(result.edge.position[0], 7);
  const test::Made clear = test::wrote(reg::kControl, field::kControlProbeClear);
  EXPECT_EQ(std::count(bus_.log.begin(), bus_.log.end(), clear), 2);
}

TEST_F(Probing, ACardWithoutPathCommandsHasNone) {
  RegisterStub bus;
  Card plain = Card::open(bus);
  EXPECT_EQ(argument_error([&] { plain.read_probe_snapshot(); }),
            "probe: needs path_commands, which the card does not have (engines 0x33)");
  EXPECT_THAT(argument_error([&] { plain.clear_probe(); }), HasSubstr("probe: needs path_commands"));
  EXPECT_THAT(argument_error([&] { plain.read_marks(); }), HasSubstr("marks: needs path_commands"));
}

}  // namespace
}  // namespace trammel::driver
