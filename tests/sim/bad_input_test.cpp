// Wrong data from a host, over the bus of both engines. It is refused, clamped or a fault, as
// docs/reference/behaviour.md says. Reason and number are latched, the position stays intact, and the card remains
// usable. The driver refuses the same data before it sends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <optional>

#include "host.hpp"
#include "trammel/driver/arc.hpp"
#include "trammel/driver/arc_chord.hpp"
#include "trammel/driver/stream.hpp"

namespace {

using namespace trammel;
using testing::HasSubstr;
namespace reg = card_map::reg;
namespace field = card_map::field;
using card_map::Reason;
using driver::Command;
using Words = std::vector<std::uint32_t>;

constexpr std::uint64_t kOne = std::uint64_t{1} << 40;  // a pulse
constexpr std::int64_t kPulses = 5;                     // pulses of the path before the wrong data
constexpr std::int64_t kFirst = std::numeric_limits<std::int64_t>::min();
constexpr std::uint64_t kTicks = 2000;

driver::LineCommand line(std::uint64_t ticks, std::int64_t pulses) {
  driver::LineCommand command{ticks, 1, {}};
  command.increment[0] = pulses * static_cast<std::int64_t>(kOne / ticks);
  return command;
}
driver::FeedCommand feed(std::uint64_t ticks) {
  driver::FeedCommand command;
  command.ticks = ticks;
  command.rate = std::uint64_t{1} << 61;  // a tick in 8 clocks
  command.floor = 1U << 28;               // a tick in 16 clocks
  return command;
}
driver::FeedCommand feed(std::int64_t acceleration, std::int64_t jerk) {
  driver::FeedCommand command = feed(kTicks);
  command.acceleration = acceleration;
  command.jerk = jerk;
  return command;
}
driver::ArcCommand circle() {
  driver::ArcGeometry arc;
  arc.centre_x = -10 * driver::kCentreUnitsPerPulse;
  arc.sweep = 6.283185307179586;
  return driver::make_arc(arc, kTicks);
}
driver::ArcChordCommand chord_circle() {
  driver::HelixGeometry arc;
  arc.arc.centre_x = -10 * driver::kCentreUnitsPerPulse;
  arc.arc.sweep = 6.283185307179586;
  return driver::make_helix(arc, kTicks);
}
template <class Kind>
Kind with(Kind command, const std::function<void(Kind&)>& change) {
  change(command);
  return command;
}

// One error. The commands are sent like the good ones before them, except that `damage` changes their words.
struct Bad {
  const char* name;
  std::vector<Command> commands;
  std::function<void(Words&)> damage;  // changes the words of the first command
  std::optional<Reason> refused;       // reported with the number of the first command
  std::uint32_t fault = 0;
  std::optional<std::int64_t> clamped_to = {};  // the command runs, and X ends there
  std::vector<Command> said = {};               // commands for the driver, if not `commands`
  const char* driver = nullptr;                 // part of its ArgumentError; none: the driver sends the commands too
};

void set_count(Words& words, std::uint64_t count) {
  words[1] = static_cast<std::uint32_t>(count);
  words[2] = (words[2] & 0xFFFF0000) | static_cast<std::uint32_t>(count >> 32);
}
void set_halfword(Words& words, std::size_t at, std::uint16_t value) {
  std::uint32_t& word = words[at / 2];
  word = at % 2 == 0 ? (word & 0xFFFF0000) | value : (word & 0xFFFF) | std::uint32_t{value} << 16;
}

// Over a screen: a table, a row for each thing that can be wrong.
std::vector<Bad> stream_of_bad_input() {
  constexpr std::int64_t kMin = kFirst;
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  constexpr std::size_t kPayload = 5;  // halfword
  const std::vector<Command> good{line(kTicks, 4)};
  return {
      {"torn stream", good, [](Words& words) { words.resize(2); }, Reason::Truncated},
      {"a word lost", good, [](Words& words) { words.erase(words.begin()); }, Reason::UnknownOpcode},
      {"a command lost", good, [](Words& words) { words[0] += 1U << 24; }, Reason::BadNumber},
      {"length of another command", good, [](Words& words) { words[0] += 1U << 16; }, Reason::BadLength},
      {"axis that the card lacks",
       {driver::LineCommand{kTicks, 0x81, {}}},
       {},
       Reason::BadMask,
       0,
       {},
       {},
       "but the card has 4 axes"},
      {"zero ticks of a path",
       good,
       [](Words& words) { set_count(words, 0); },
       Reason::BadField,
       0,
       {},
       {driver::LineCommand{0, 1, {}}},
       "count 0 is outside"},
      {"zero ticks of a piece",
       {feed(kTicks)},
       [](Words& words) { set_count(words, 0); },
       Reason::BadField,
       0,
       {},
       {driver::FeedCommand{}},
       "count 0 is outside"},
      {"no floor",
       {feed(kTicks)},
       [](Words& words) { words[4] &= 0xFFFF, words[5] &= 0xFFFF0000; },
       Reason::BadField,
       0,
       {},
       {with<driver::FeedCommand>(feed(kTicks), [](auto& piece) { piece.floor = 0; })},
       "floor = 0 is out of its range"},
      {"more than a pulse a tick",
       good,
       [](Words& words) { set_halfword(words, kPayload + 2, 0x101); },
       Reason::BadField,
       0,
       {},
       {driver::LineCommand{kTicks, 1, {static_cast<std::int64_t>(kOne) + 1}}},
       "increment = 1099511627777"},
      {"paths with more ticks than pieces",
       {line(100, 4), feed(60), driver::EndCommand{}},
       {},
       {},
       field::kFaultTickMismatch},
      {"pieces with more ticks than paths",
       {line(60, 4), feed(100), driver::EndCommand{}},
       {},
       {},
       field::kFaultTickMismatch},
      {"arc of more path ticks than feed ticks",
       {circle()},
       [](Words& words) { set_halfword(words, kPayload, kTicks + 1); },
       Reason::BadField,
       0,
       {},
       {with<driver::ArcCommand>(circle(), [](auto& arc) { arc.path_ticks = kTicks + 1; })},
       "path_ticks = 2001"},
      {"arc whose end is not reached in its ticks",
       {with<driver::ArcCommand>(circle(), [](auto& arc) { arc.prescale /= 2; }), feed(kTicks), driver::EndCommand{}},
       {},
       {},
       field::kFaultPathIncomplete},
      {"arc with a quadrant too many",
       {with<driver::ArcCommand>(circle(), [](auto& arc) { arc.quadrants = 5; }), feed(kTicks), driver::EndCommand{}},
       {},
       {},
       field::kFaultPathIncomplete},
      {"arc about one axis",
       {circle()},
       [](Words& words) { words[0] = (words[0] & 0xFFFF00FF) | 0x100; },
       Reason::BadMask,
       0,
       {},
       {with<driver::ArcCommand>(circle(), [](auto& arc) { arc.axis_y = arc.axis_x; })},
       "plane of axes 0 and 0"},
      {"arc in chords without the axes of its plane",
       {chord_circle()},
       [](Words& words) { words[0] = (words[0] & 0xFFFF00FF) | 0x600; },
       Reason::BadMask,
       0,
       {},
       {with<driver::ArcChordCommand>(chord_circle(), [](auto& arc) { arc.mask = 6; })},
       "without the axes 0 and 1"},
      {"arc in chords of more path ticks than feed ticks",
       {chord_circle()},
       [](Words& words) { set_halfword(words, kPayload, kTicks + 1); },
       Reason::BadField,
       0,
       {},
       {with<driver::ArcChordCommand>(chord_circle(), [](auto& arc) { arc.path_ticks = kTicks + 1; })},
       "path_ticks = 2001"},
      // Clamped: the line makes all its pulses, at the floor or at one tick per clock.
      {"jerk that reverses the feed",
       {feed(0, -(std::int64_t{1} << 58)), line(kTicks, 4), driver::EndCommand{}},
       {},
       {},
       0,
       kPulses + 4,
       {},
       "acceleration and jerk would reverse the feed after"},
      {"jerk beyond the accumulator",
       {feed(0, kMin), line(kTicks, 4), driver::EndCommand{}},
       {},
       {},
       0,
       kPulses + 4,
       {},
       "acceleration and jerk would reverse the feed after"},
      {"acceleration beyond the accumulator",
       {feed(kMax, kMax), line(kTicks, 4), driver::EndCommand{}},
       {},
       {},
       0,
       kPulses + 4},
      {"deceleration beyond the accumulator",
       {feed(kMin, 0), line(kTicks, 4), driver::EndCommand{}},
       {},
       {},
       0,
       kPulses + 4},
  };
}

class Pulses final : public driver::StepSink {
 public:
  void pin_step(const driver::PinStep& step) override { at_pins[step.axis] += step.direction; }
  void path_step(const driver::PathStep& /*step*/) override {}
  std::vector<std::int64_t> at_pins = std::vector<std::int64_t>(4);
};

std::unique_ptr<sim::Engine> make(sim::EngineKind kind) {
  sim::SimulationOptions options;
  options.kind = kind;
  return sim::make_engine(options);
}

class BadInput : public testing::TestWithParam<sim::EngineKind> {
 protected:
  // A card that has made a path of kPulses; its next command number is 3.
  struct Bench {
    explicit Bench(sim::EngineKind kind) : engine(make(kind)), card(driver::Card::open(*engine)), host(*engine) {
      engine->set_sink(&pulses);
      good_path();
      EXPECT_EQ(engine->positions()[0], kPulses);
    }
    void good_path() {
      host.send(line(50, kPulses));
      host.send(feed(50));
      host.send(driver::EndCommand{});
      EXPECT_TRUE(host.wait_idle(100'000));
    }
    std::unique_ptr<sim::Engine> engine;
    Pulses pulses;
    driver::Card card;
    test::Host host;
  };
  static constexpr std::uint8_t kNumber = 3;

  static void send_raw(Bench& bench, const Bad& bad) {
    for (std::size_t i = 0; i < bad.commands.size(); ++i) {
      Words words;
      driver::encode(bad.commands[i], static_cast<std::uint8_t>(kNumber + i), words);
      if (i == 0 && bad.damage) bad.damage(words);
      for (const std::uint32_t word : words) {
        driver::Access access = driver::write_of(reg::kStream, word);
        if (bench.engine->transfer(&access, 1) != 1) return;
      }
    }
    if (bad.refused == Reason::Truncated) bench.engine->write(reg::kControl, field::kControlFlush);
  }
  static void expect_latched(Bench& bench, const Bad& bad) {
    bench.engine->wait(60'000);
    EXPECT_EQ(bench.engine->read(reg::kFault), bad.fault);
    const std::uint32_t refusal = bench.engine->read(reg::kRefusal);
    EXPECT_EQ(refusal & field::kRefusalReason, bad.refused ? static_cast<std::uint32_t>(*bad.refused) : 0U);
    if (bad.refused && *bad.refused != Reason::BadNumber && *bad.refused != Reason::UnknownOpcode) {
      EXPECT_EQ((refusal & field::kRefusalCommand) >> field::kRefusalCommandShift, kNumber);
    }
    EXPECT_EQ(bench.engine->positions(), bench.pulses.at_pins) << "each pulse is counted";
    if (bad.refused) {
      EXPECT_EQ(bench.engine->positions()[0], kPulses) << "nothing of it has moved";
    }
    EXPECT_EQ(bench.engine->positions()[0], bad.clamped_to.value_or(bench.engine->positions()[0]));
    if (bad.fault != 0) {
      const driver::Snapshot stop = bench.card.read_stop_snapshot();
      EXPECT_EQ(stop.faults, bad.fault);
      EXPECT_EQ(stop.geometry_begun, 3U) << "it was at the path that is wrong, after a path and its end";
    }
  }
  // The card works as before, from the same position.
  static void expect_usable(Bench& bench) {
    const std::int64_t here = bench.engine->positions()[0];
    bench.card.clear_faults();
    bench.host.abort();
    bench.card.clear_refusal();
    bench.good_path();
    EXPECT_EQ(bench.engine->positions()[0], here + kPulses);
    EXPECT_EQ(bench.engine->positions(), bench.pulses.at_pins);
  }
  static void expect_said_by_the_driver(Bench& bench, const Bad& bad) {
    const std::vector<Command>& commands = bad.said.empty() ? bad.commands : bad.said;
    driver::Stream stream(bench.card);
    const std::vector<std::int64_t> here = bench.engine->positions();
    try {
      stream.send(commands);
      stream.finish();
      EXPECT_TRUE(bad.driver == nullptr && bad.fault == 0) << "sent as if it were good";
    } catch (const driver::ArgumentError& error) {
      EXPECT_THAT(error.what(), HasSubstr(bad.driver == nullptr ? "no error of the driver's" : bad.driver));
      EXPECT_EQ(stream.sent(), 0U);
      EXPECT_EQ(bench.engine->positions(), here);
    } catch (const driver::FaultError& error) {
      EXPECT_EQ(error.faults(), bad.fault) << error.what();
      EXPECT_THAT(error.what(), HasSubstr(driver::describe_faults(bad.fault)));
    }
    EXPECT_EQ(bench.engine->positions(), bench.pulses.at_pins);
  }
};

INSTANTIATE_TEST_SUITE_P(Engines, BadInput, testing::Values(sim::EngineKind::kRtl, sim::EngineKind::kModel),
                         [](const auto& engine) { return engine.param == sim::EngineKind::kRtl ? "Rtl" : "Model"; });

TEST_P(BadInput, IsRefusedClampedOrAFaultWithThePositionIntact) {
  for (const Bad& bad : stream_of_bad_input()) {
    SCOPED_TRACE(bad.name);
    Bench bench(GetParam());
    send_raw(bench, bad);
    expect_latched(bench, bad);
    expect_usable(bench);
    if (bad.damage && bad.said.empty()) continue;  // only a transport can do this
    Bench other(GetParam());
    expect_said_by_the_driver(other, bad);
  }
}

TEST_P(BadInput, AnOverrideOutOfRangeChangesNothing) {
  Bench bench(GetParam());
  for (const std::uint32_t ratio : {reg::kRatioFeed, reg::kRatioRapid, reg::kRatioFixed}) {
    EXPECT_THROW(bench.engine->write(ratio, 0x10001), driver::RefusedError);
    const std::uint32_t refusal = bench.engine->read(reg::kRefusal);
    EXPECT_EQ(refusal & field::kRefusalReason, static_cast<std::uint32_t>(Reason::BadValue));
    bench.card.clear_refusal();
    EXPECT_EQ(bench.engine->read(ratio), 0x10000U);
  }
  for (const auto piece_class : {driver::PieceClass::kFeed, driver::PieceClass::kRapid, driver::PieceClass::kFixed}) {
    EXPECT_THROW(bench.card.set_ratio(piece_class, 0x10001), driver::ArgumentError);
    EXPECT_THROW(bench.card.set_override(piece_class, 200.1, 200), driver::ArgumentError);
    EXPECT_THROW(bench.card.set_override(piece_class, -1), driver::ArgumentError);
    EXPECT_THROW(bench.card.set_override(piece_class, std::numeric_limits<double>::quiet_NaN()), driver::ArgumentError);
    EXPECT_EQ(bench.card.ratio(piece_class), 0x10000U);
  }
  bench.host.send(line(50, kPulses));
  bench.host.send(feed(50));
  EXPECT_TRUE(bench.host.wait_idle(10'000));
  EXPECT_EQ(bench.engine->positions()[0], 2 * kPulses);
}

// Values beyond the accumulators of the arc engines: any curve ends with its ticks or raises a fault, and each of its
// pulses is counted.
TEST_P(BadInput, OverflowsOfTheArcEnginesEndAndAreCounted) {
  const driver::Int128 most(driver::Uint128(0x7FFF, ~std::uint64_t{0}));
  for (const bool accumulator : {true, false}) {
    SCOPED_TRACE(accumulator);
    Bench bench(GetParam());
    if (accumulator) {
      bench.host.send(with<driver::ArcCommand>(circle(), [&](auto& arc) {
        arc.deviation = arc.gradient_x = arc.gradient_y = most;
        arc.half_x = arc.half_y = (std::uint64_t{1} << 40);
      }));
    } else {
      bench.host.send(with<driver::ArcChordCommand>(chord_circle(), [](auto& arc) {
        arc.x = kFirst;
        arc.y = std::numeric_limits<std::int64_t>::max();
        arc.k = 1;
      }));
    }
    bench.host.send(feed(kTicks));
    bench.host.send(driver::EndCommand{});
    bench.engine->wait(60'000);
    const std::uint32_t found = bench.engine->read(reg::kFault);
    EXPECT_TRUE(found == 0 || (accumulator && found == field::kFaultPathIncomplete)) << found;
    EXPECT_EQ(bench.engine->positions(), bench.pulses.at_pins);
    if (accumulator && found == 0) {
      EXPECT_EQ(bench.engine->positions()[0], kPulses) << "the end of its circle";
    }
    expect_usable(bench);
  }
}

// Nothing after the PROBE begins. The edge is latched at the present position, and commands behind PROBE_END run after
// the probe is cleared. Inputs show the levels of the pins: input 2 is high.
TEST_P(BadInput, AProbeThatIsTrippedAlreadyMovesNothing) {
  Bench bench(GetParam());
  bench.engine->set_inputs(1U << 2);
  bench.engine->wait(10);
  bench.host.send(driver::ProbeCommand{2, true});
  bench.host.send(line(100, 40));
  bench.host.send(feed(100));
  bench.host.send(driver::ProbeEndCommand{});
  bench.engine->wait(60'000);
  EXPECT_EQ(bench.engine->read(reg::kFault), 0U);
  EXPECT_NE(bench.engine->read(reg::kStatus) & field::kStatusProbed, 0U);
  EXPECT_EQ(bench.engine->positions()[0], kPulses) << "nothing has moved";
  using card_map::Area;
  EXPECT_EQ(bench.engine->read(reg::position(Area::Probe, 0)), static_cast<std::uint32_t>(kPulses));
  EXPECT_EQ(bench.engine->read(reg::geometry_begun(Area::Probe)), 2U) << "the path and the end before it";
  bench.engine->write(reg::kControl, field::kControlProbeClear);
  bench.host.send(line(50, kPulses));
  bench.host.send(feed(50));
  EXPECT_TRUE(bench.host.wait_idle(100'000));
  EXPECT_EQ(bench.engine->positions()[0], 2 * kPulses) << "what stands behind PROBE_END runs";
  EXPECT_EQ(bench.engine->read(reg::kStatus) & field::kStatusProbed, 0U);
  expect_usable(bench);
  // With the input low the probe is armed, and its path runs to the end without an edge.
  bench.engine->set_inputs(0);
  bench.engine->wait(10);
  const std::int64_t here = bench.engine->positions()[0];
  bench.host.send(driver::ProbeCommand{2, true});
  bench.host.send(line(100, 40));
  bench.host.send(feed(100));
  bench.host.send(driver::ProbeEndCommand{});
  EXPECT_TRUE(bench.host.wait_idle(100'000));
  EXPECT_EQ(bench.engine->positions()[0], here + 40);
  EXPECT_NE(bench.engine->read(reg::kStatus) & field::kStatusProbeMissed, 0U);
}

}  // namespace
