// Continuing at a place of the path: the filter between planner and stream, and the card's steps from that place on,
// which equal those of the undisturbed run.
#include "trammel/run/replay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "clocks.hpp"
#include "steps.hpp"
#include "trammel/driver/feed_time.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::run {
namespace {

using driver::Command;
using driver::FeedCommand;
using Commands = std::vector<Command>;

struct ReplayedCommands final : driver::CommandSink, Observer {
  void put(const Command& command) override { commands.push_back(command); }
  void command(std::uint64_t /*number*/, const Command& command) override { commands.push_back(command); }
  Commands commands;
};

bool is_geometry(const Command& command) {
  return !std::holds_alternative<FeedCommand>(command) && driver::counts_as_begun(command);
}

// The ticks of a path command, and its path ticks per tick in units of 2^-40.
std::pair<std::uint64_t, std::uint64_t> path_ticks_of(const Command& command) {
  constexpr std::uint64_t kOne = std::uint64_t{1} << 40;
  if (const auto* line = std::get_if<driver::LineCommand>(&command)) return {line->ticks, kOne};
  if (const auto* arc = std::get_if<driver::ArcCommand>(&command)) return {arc->ticks, arc->prescale};
  if (const auto* arc = std::get_if<driver::ArcChordCommand>(&command)) return {arc->ticks, arc->prescale};
  return {0, kOne};
}

// Number of the command, counted from the program's first one; tick, axis, direction.
using ReplayStep = std::tuple<std::uint64_t, std::uint64_t, unsigned, int>;

// `first`: number of the first counted command in `commands`.
std::vector<ReplayStep> replay_steps(const Commands& commands, const std::vector<driver::PathStep>& made,
                                     std::uint64_t first) {
  std::vector<std::uint64_t> numbers;
  for (const Command& command : commands) numbers.push_back(is_geometry(command) ? first++ : 0);
  std::vector<ReplayStep> steps;
  for (const driver::PathStep& step : made) {
    steps.emplace_back(numbers.at(step.command), step.tick, step.axis, step.direction);
  }
  return steps;
}

struct PathVariant {
  const char* name;
  const char* program;
  planner::ArcsBy arcs;
  const char* machine;  // overrides of the machine file, separated by blanks
};

constexpr const char* kReplayArcs =
    "F3000\nG1 X2 Y1\nG2 X4 Y1 I1\nG1 X1 Y3\nG3 X1 Y3 J-1\nG4 P0.01\nG3 X0 Y0 R4\nG0 X3\n";
constexpr const char* kReplayHelices = "F3000\nG2 X0 Y0 I1 Z0.5\nG3 X1 Y1 R1 Z0\nG1 X1.5\nG2 X2.5 Y1 I0.5 Z0.3\n";

const std::vector<PathVariant>& path_variants() {
  static const std::vector<PathVariant> all{
      {"lines", "F3000\nG1 X2 Y1\nX2.1 Y1.7 Z0.3\nG0 X0\nG1 X0.7 F300\nG4 P0.01\nG1 X0 Y0 Z0 F4000\n",
       planner::ArcsBy::kGenerator, ""},
      {"lines with limited jerk", "F3000\nG1 X2 Y1\nX2.1 Y1.7\nG0 X0\nG1 X0.7 F300\n", planner::ArcsBy::kGenerator,
       "axis.x.max_jerk=50000 axis.y.max_jerk=50000 axis.z.max_jerk=50000 axis.e.max_jerk=50000"},
      {"arc generator", kReplayArcs, planner::ArcsBy::kGenerator, ""},
      {"accumulator", kReplayArcs, planner::ArcsBy::kAccumulator, ""},
      {"accumulator in 8 directions", kReplayArcs, planner::ArcsBy::kEightDirections, ""},
      {"helices", kReplayHelices, planner::ArcsBy::kGenerator, ""},
      {"chords", kReplayHelices, planner::ArcsBy::kChords, ""},
      {"conics", kReplayArcs, planner::ArcsBy::kAccumulator, "axis.y.steps_per_mm=128"},
  };
  return all;
}

machine::Machine variant_machine(const PathVariant& variant) {
  machine::Machine machine = machine::default_machine();
  std::istringstream entries(variant.machine);
  for (std::string entry; entries >> entry;) machine::apply_override(machine, entry);
  return machine;
}

// A card, and the steps that it makes from commands.
struct ReplayBench {
  explicit ReplayBench(const machine::Machine& machine) {
    engine->set_sink(&steps);
    configure(card, machine);
  }
  void send(const Commands& commands) {
    driver::Stream stream(card);
    for (const Command& command : commands) stream.put(command);
    stream.finish();
  }

  std::unique_ptr<sim::Engine> engine = sim::make_model_engine(sim::EngineOptions{4, kSlowClock, false});
  driver::Card card = driver::Card::open(*engine);
  test::Steps steps;
};

Commands planned_commands(const PathVariant& variant, const machine::Machine& machine,
                          const planner::CardLimits& limits) {
  const std::string text = variant.program;
  const ProgramLines lines = [text] { return std::make_unique<gcode::TextLines>(text, "p.ngc"); };
  RunSettings settings;
  settings.arcs = variant.arcs;
  Runner runner(lines, machine, limits, settings);
  ReplayedCommands list;
  runner.add(list);
  runner.plan();
  ReplayBench bench(machine);
  runner.run(bench.card);
  return list.commands;
}

// Compares the steps of the undisturbed run after `done` ticks of the place's command with those that a card makes from
// the place on.
void judge_place(const PathVariant& variant, const Commands& all, const std::vector<ReplayStep>& whole,
                 const PathPlace& place, std::uint64_t done) {
  ReplayedCommands rest;
  Replay replay(rest, place);
  for (const Command& command : all) replay.put(command);
  ASSERT_TRUE(replay.begun());
  ReplayBench bench(variant_machine(variant));
  bench.send(rest.commands);
  const std::vector<ReplayStep> made = replay_steps(rest.commands, bench.steps.path, replay.skipped());
  std::uint64_t passed = 0;
  std::uint64_t number = 0;
  for (const Command& command : all) {
    if (!is_geometry(command) || number++ != place.command) continue;
    const driver::Uint128 sum = driver::Uint128::product(done, path_ticks_of(command).second);
    passed = ((sum + driver::Uint128(std::uint64_t{1} << 39)) >> 40).low();
    break;
  }
  const auto from = std::find_if(whole.begin(), whole.end(), [&](const ReplayStep& step) {
    return std::get<0>(step) > place.command || (std::get<0>(step) == place.command && std::get<1>(step) > passed);
  });
  EXPECT_TRUE(std::vector<ReplayStep>(from, whole.end()) == made)
      << variant.name << ", command " << place.command << ", tick " << done << ": " << made.size() << " steps, "
      << whole.end() - from << " wanted";
}

// Number of feed ticks of a command after which its path tick `path_tick` has come.
std::uint64_t ticks_up_to(const Command& command, std::uint64_t path_tick) {
  const driver::Uint128 half(std::uint64_t{1} << 39);
  return driver::ceil_div((driver::Uint128(path_tick) << 40) - half, driver::Uint128(path_ticks_of(command).second))
      .low();
}

std::mt19937_64 seeded() {
  const char* const seed = std::getenv("TRAMMEL_SEED");
  return std::mt19937_64(seed != nullptr ? std::stoull(seed) : 1);
}

class ReplayOf : public ::testing::TestWithParam<std::size_t> {};

// Also tests the first and the last tick of a command, and the ticks just before and just after a step.
TEST_P(ReplayOf, FromAnyTickOnTheStepsOfTheUndisturbedRun) {
  std::mt19937_64 random = seeded();
  const PathVariant& variant = path_variants()[GetParam()];
  const machine::Machine machine = variant_machine(variant);
  ReplayBench bench(machine);
  const Commands all = planned_commands(variant, machine, planner::limits_of(bench.card.identification()));
  bench.send(all);
  const std::vector<ReplayStep> whole = replay_steps(all, bench.steps.path, 0);
  Commands paths;
  std::copy_if(all.begin(), all.end(), std::back_inserter(paths), is_geometry);
  ASSERT_GT(whole.size(), 300U);
  for (unsigned i = 0; i < 30; ++i) {
    const auto& [at, path_tick, axis, direction] = whole[random() % whole.size()];
    const bool at_step = i % 8 > 3;
    const std::uint64_t command = at_step ? at : random() % paths.size();
    const std::uint64_t ticks = path_ticks_of(paths[command]).first;
    const std::uint64_t done = at_step      ? ticks_up_to(paths[command], path_tick) - i % 2
                               : i % 8 == 0 ? 0
                               : i % 8 == 1 ? ticks
                                            : random() % (ticks + 1);
    const std::uint64_t left = i % 16 == 0 ? PathPlace::kAllTicks : ticks - done;
    judge_place(variant, all, whole, {command, left}, done);
    if (HasFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, ReplayOf, ::testing::Range(std::size_t{0}, path_variants().size()),
                         [](const auto& variant) {
                           std::string name = path_variants()[variant.param].name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

// Simulates a piece clock by clock. Returns the clocks up to `ticks` ticks, and the rate then in use, in ticks per
// clock.
std::pair<std::uint64_t, double> clocks_to(const FeedCommand& piece, std::uint64_t ticks) {
  double rate = static_cast<double>(piece.rate) * 0x1p-64;
  double acceleration = static_cast<double>(piece.acceleration) * 0x1p-64;
  const double floor = piece.floor * 0x1p-32;
  double in_use = rate;
  double phase = 0;
  std::uint64_t clocks = 0;
  for (std::uint64_t made = 0; made < ticks;) {
    phase += in_use;
    if (phase >= 1) {
      phase -= 1;
      ++made;
    }
    if (++clocks % 32 != 0) continue;
    rate += acceleration;
    acceleration += static_cast<double>(piece.jerk) * 0x1p-64;
    in_use = std::clamp(rate, floor, 1.0);
  }
  return {clocks, in_use};
}

// A piece from one rate to another, in ticks per clock, over `updates` updates; with `jerk` the jerk brings the
// acceleration to 0.
FeedCommand ramp(double from, double to, double updates, bool jerk) {
  FeedCommand piece;
  const double change = (to - from) / updates;
  piece.floor = 1U << 12;
  piece.rate = static_cast<std::uint64_t>(from * 0x1p64);
  piece.acceleration = static_cast<std::int64_t>((jerk ? 2 : 1) * change * 0x1p64);
  piece.jerk = jerk ? static_cast<std::int64_t>(-2 * change / updates * 0x1p64) : 0;
  const double mean = jerk ? from + (to - from) * 2 / 3 : (from + to) / 2;
  piece.ticks = static_cast<std::uint64_t>(mean * 32 * updates);
  return piece;
}

TEST(RestOfAPiece, GoesOnAtTheRateThatThePieceHasThere) {
  std::mt19937_64 random = seeded();
  const auto share = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (unsigned i = 0; i < 300; ++i) {
    SCOPED_TRACE(i);
    const double from = i % 3 == 0 ? 0.001 : 0.01 + 0.5 * share();
    const double to = i % 3 == 1 ? 0 : 0.01 + 0.5 * share();
    FeedCommand piece = ramp(from, to, 20 + 1000 * share(), i % 2 == 0);
    piece.stop_distance = 77;
    piece.piece_class = driver::PieceClass::kRapid;
    if (i % 10 == 9) piece.acceleration = piece.jerk = 0;
    const std::uint64_t gone = random() % piece.ticks;
    const std::vector<FeedCommand> rest = rest_of(piece, gone);
    const auto [clocks, rate] = clocks_to(piece, gone);
    const double update =
        (std::abs(static_cast<double>(piece.acceleration)) + 2 * std::abs(static_cast<double>(piece.jerk))) * 0x1p-64;
    EXPECT_NEAR(static_cast<double>(rest[0].rate) * 0x1p-64, rate, 1e-9 + update);
    // The last ticks of a stop come at the floor: a fraction of such a tick takes as long as all ticks before it.
    const std::uint64_t last = to == 0 ? 4 : 0;
    std::uint64_t ticks = 0;
    std::uint64_t made = 0;
    for (const FeedCommand& part : rest) {
      EXPECT_EQ(part.stop_distance, 77U);
      EXPECT_EQ(part.piece_class, driver::PieceClass::kRapid);
      EXPECT_EQ(driver::ticks_to_reversal(part), std::nullopt) << "the stream would refuse it";
      ticks += part.ticks;
      made += clocks_to(part, part.ticks - (&part == &rest.back() ? std::min(last, part.ticks) : 0)).first;
    }
    EXPECT_EQ(ticks, piece.ticks - gone);
    const std::uint64_t end = std::max(gone, piece.ticks - last);
    const double left = static_cast<double>(clocks_to(piece, end).first - clocks);
    EXPECT_NEAR(static_cast<double>(made), left, 0.02 * left + 100) << gone;
  }
}

TEST(RestOfAPiece, WithNothingGoneIsThePiece) {
  const FeedCommand piece = ramp(0.3, 0.1, 500, true);
  ASSERT_EQ(rest_of(piece, 0).size(), 1U);
  const FeedCommand rest = rest_of(piece, 0)[0];
  EXPECT_EQ(rest.rate, piece.rate);
  EXPECT_EQ(rest.acceleration, piece.acceleration);
  EXPECT_EQ(rest.jerk, piece.jerk);
}

driver::LineCommand line_of_ticks(std::uint64_t ticks) {
  driver::LineCommand line;
  line.ticks = ticks;
  line.mask = 1;
  return line;
}

FeedCommand piece_of_ticks(std::uint64_t ticks) {
  FeedCommand piece;
  piece.ticks = ticks;
  piece.rate = std::uint64_t{1} << 60;
  return piece;
}

// Two lines under one piece with output switches between them, a dwell, and a third line.
const Commands& switching_commands() {
  static const Commands commands{driver::OutputCommand{5, 0}, piece_of_ticks(300),         line_of_ticks(100),
                                 driver::OutputCommand{2, 4}, driver::MarkCommand{},       line_of_ticks(200),
                                 driver::DwellCommand{9},     driver::OutputCommand{0, 1}, piece_of_ticks(50),
                                 line_of_ticks(50),           driver::EndCommand{}};
  return commands;
}

// Of several PWM commands that are skipped, the last one holds. It is sent before the silent piece.
TEST(Replay, RestoresThePulses) {
  ReplayedCommands rest;
  Replay replay(rest, PathPlace{1, 20});
  const driver::PwmCommand dim{0, 100, false, 0, 0};
  const driver::PwmCommand bright{0, 60'000, true, 3, 40'000};
  const driver::PwmCommand behind{0, 0, false, 0, 0};
  const Commands all{dim,    piece_of_ticks(150), line_of_ticks(100), bright, line_of_ticks(50),
                     behind, driver::EndCommand{}};
  for (const Command& command : all) replay.put(command);
  ASSERT_GE(rest.commands.size(), 2U);
  EXPECT_EQ(std::get<driver::PwmCommand>(rest.commands[0]).gain, 40'000);
  EXPECT_TRUE(std::get<FeedCommand>(rest.commands[1]).silent);
  EXPECT_EQ(std::get<driver::PwmCommand>(rest.commands[rest.commands.size() - 2]).duty, 0);
}

Commands replayed(const PathPlace& place) {
  ReplayedCommands rest;
  Replay replay(rest, place);
  for (const Command& command : switching_commands()) replay.put(command);
  EXPECT_EQ(replay.skipped(), place.ticks_left == 0 && place.command < 2 ? place.command + 1 : place.command);
  return rest.commands;
}

TEST(Replay, RestoresTheOutputsThenIsSilentThenGoesOn) {
  const Commands rest = replayed({1, 150});
  ASSERT_EQ(rest.size(), 9U);
  EXPECT_EQ(std::get<driver::OutputCommand>(rest[0]).set, 3U);
  EXPECT_EQ(std::get<driver::OutputCommand>(rest[0]).clear, 4U);
  EXPECT_TRUE(std::get<FeedCommand>(rest[1]).silent);
  EXPECT_EQ(std::get<FeedCommand>(rest[1]).ticks, 50U);
  EXPECT_EQ(std::get<FeedCommand>(rest[1]).stop_distance, 0U);
  EXPECT_FALSE(std::get<FeedCommand>(rest[2]).silent);
  EXPECT_EQ(std::get<FeedCommand>(rest[2]).ticks, 150U);
  EXPECT_EQ(std::get<driver::LineCommand>(rest[3]).ticks, 200U) << "whole";
  EXPECT_TRUE(std::holds_alternative<driver::DwellCommand>(rest[4]));
  EXPECT_TRUE(std::holds_alternative<driver::EndCommand>(rest[8]));
}

TEST(Replay, APathThatIsDoneIsTheBeginOfTheNext) {
  for (const PathPlace& place : {PathPlace{0, 0}, PathPlace{1, 200}, PathPlace{1}}) {
    const Commands rest = replayed(place);
    ASSERT_EQ(rest.size(), 8U);
    EXPECT_EQ(std::get<FeedCommand>(rest[1]).ticks, 200U);
    EXPECT_EQ(std::get<driver::LineCommand>(rest[2]).ticks, 200U);
  }
}

TEST(Replay, ADwellUnderWayIsMadeWhole) {
  for (const PathPlace& place : {PathPlace{1, 0}, PathPlace{2, 0}, PathPlace{2}}) {
    const Commands rest = replayed(place);
    ASSERT_EQ(rest.size(), 6U);
    EXPECT_EQ(std::get<driver::DwellCommand>(rest[1]).clocks, 9U);
  }
}

TEST(Replay, APlaceThatTheProgramLacksIsRefused) {
  EXPECT_THROW(replayed({1, 201}), ReplayError);
  ReplayedCommands rest;
  Replay behind(rest, {5});
  for (const Command& command : switching_commands()) behind.put(command);
  EXPECT_FALSE(behind.begun());
  Replay probing(rest, {5});
  EXPECT_THROW(probing.put(driver::ProbeCommand{}), ReplayError);
  EXPECT_TRUE(rest.commands.empty());
}

}  // namespace
}  // namespace trammel::run
