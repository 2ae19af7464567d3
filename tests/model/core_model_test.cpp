// The golden core as a whole against its documentation.
#include "trammel/model/core_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "chord_arc.hpp"
#include "core_bench.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;
using model::ArcPoints;
using model::prepare_chords;

constexpr std::uint64_t kTickEachClock = ~std::uint64_t{0};  // a tick nearly every clock

TEST(CoreModel, AccessesAnswerAfterFourAndFiveClocks) {
  CoreBench bench;
  bench.idle(300);
  std::uint64_t before = bench.core.cycles();
  ASSERT_TRUE(bench.write(reg::kHoldLimit, 1234));
  EXPECT_EQ(bench.core.cycles() - before, 4U);
  before = bench.core.cycles();
  EXPECT_EQ(bench.read(reg::kHoldLimit), 1234U);
  EXPECT_EQ(bench.core.cycles() - before, 5U);
}

TEST(CoreModel, ALineMovesItsAxes) {
  CoreBench bench;
  ASSERT_TRUE(bench.line(1000, {100 * kOnePulse / 1000, -(50 * kOnePulse / 1000)}));
  ASSERT_TRUE(bench.feed(1000, kTickEachClock / 4));
  ASSERT_TRUE(bench.end());
  ASSERT_TRUE(bench.finish(10000));
  EXPECT_EQ(bench.core.position(0), 100U);
  EXPECT_EQ(bench.core.position(1), 0U - 50U);
  EXPECT_EQ(bench.core.outputs().fault, 0U);
  EXPECT_EQ(bench.core.outputs().status & 0x3F, 0x20U) << "ended";
  EXPECT_EQ(bench.core.outputs().geometry_begun, 2U);
  EXPECT_EQ(bench.core.outputs().feed_begun, 2U);
}

TEST(CoreModel, ACircleComesBack) {
  CoreBench bench;
  for (const std::int64_t r : {1, 10, 100}) {
    ASSERT_TRUE(bench.circle(static_cast<std::uint64_t>(r) * 8 * 20, r));
    ASSERT_TRUE(bench.feed(static_cast<std::uint64_t>(r) * 8 * 20, kTickEachClock / 2));
  }
  ASSERT_TRUE(bench.line(10, {kOnePulse / 2}));
  ASSERT_TRUE(bench.feed(10, kTickEachClock / 20));
  ASSERT_TRUE(bench.end());
  ASSERT_TRUE(bench.finish(100000));
  EXPECT_EQ(bench.core.outputs().fault, 0U);
  EXPECT_EQ(bench.core.position(0), 5U);
  EXPECT_EQ(bench.core.position(1), 0U);
  EXPECT_EQ(bench.steps.path.size(), 888U + 5U);
}

model::CardConfig with_eight_directions() {
  model::CardConfig config;
  config.engines = model::RegisterFile::kMaxEngines;
  return config;
}

TEST(CoreModel, ACircleInEightDirectionsComesBack) {
  CoreBench bench(with_eight_directions());
  for (const std::int64_t r : {1, 10, 100}) {
    ASSERT_TRUE(bench.circle(static_cast<std::uint64_t>(r) * 8 * 20, r, r == 10, true));
    ASSERT_TRUE(bench.feed(static_cast<std::uint64_t>(r) * 8 * 20, kTickEachClock / 2));
  }
  ASSERT_TRUE(bench.end());
  ASSERT_TRUE(bench.finish(100000));
  EXPECT_EQ(bench.core.outputs().fault, 0U);
  EXPECT_EQ(bench.core.position(0), 0U);
  EXPECT_EQ(bench.core.position(1), 0U);
  // Each coordinate travels 4 R in either step rule; a tick that moves both axes counts as two steps.
  EXPECT_EQ(bench.steps.path.size(), 888U);
}

// A circle of radius 10 in 8 directions with one wrong field.
std::vector<std::uint32_t> wrong_circle(const char* name, int128 value) {
  std::vector<std::pair<std::string_view, int128>> fields = {{"path_ticks", 56},    {"prescale", kOnePulse / 10},
                                                             {"plane", 1 << 8 | 2}, {"quadrants", 4},
                                                             {"gradient_x", 20},    {"half_x", 1},
                                                             {"half_y", 1}};
  for (auto& field : fields) {
    if (field.first == name) field.second = value;
  }
  return command_words(card_map::Opcode::Arc, 3, 0, 560, fields);
}

// An error that a single field shows is refused. If ticks and quadrants do not fit the curve, the arc misses its end.
TEST(CoreModel, MalformedArcsInEightDirections) {
  const auto refused = [](const std::vector<std::uint32_t>& words, const model::CardConfig& config) {
    CoreBench bench(config);
    return !bench.send(words) &&
           (bench.read(reg::kRefusal) & 0xFF) == static_cast<unsigned>(card_map::Reason::BadField);
  };
  const model::CardConfig eight = with_eight_directions();
  EXPECT_FALSE(refused(wrong_circle("quadrants", 4), eight));
  EXPECT_TRUE(refused(wrong_circle("quadrants", 4), {})) << "no 8 directions built in";
  EXPECT_TRUE(refused(wrong_circle("path_ticks", 0), eight));
  EXPECT_TRUE(refused(wrong_circle("path_ticks", 561), eight)) << "more than the feed's";
  EXPECT_TRUE(refused(wrong_circle("prescale", kOnePulse + 1), eight));
  EXPECT_TRUE(refused(wrong_circle("plane", 1 << 8 | 6), eight));
  const auto fault = [&eight](const std::vector<std::uint32_t>& words) {
    CoreBench bench(eight);
    EXPECT_TRUE(bench.send(words));
    bench.number = 1;
    EXPECT_TRUE(bench.feed(560, kTickEachClock / 2));
    EXPECT_TRUE(bench.finish(100000));
    return bench.core.outputs().fault;
  };
  constexpr std::uint32_t kIncomplete = card_map::field::kFaultPathIncomplete;
  EXPECT_EQ(fault(wrong_circle("quadrants", 4)), 0U);
  EXPECT_EQ(fault(wrong_circle("quadrants", 5)), kIncomplete) << "round again";
  EXPECT_EQ(fault(wrong_circle("prescale", kOnePulse / 11)), kIncomplete) << "too few path ticks";
  EXPECT_EQ(fault(wrong_circle("prescale", kOnePulse / 8)), 0U) << "too many do no harm";
  EXPECT_EQ(fault(wrong_circle("quadrants", 0)), 0U) << "start and end are one: no step";
}

// A circle at one tick per clock, with a path tick every `each` ticks, then a second path. The members are the clocks
// of the last path tick and the last feed tick of the circle, and of the first tick of the second path.
struct HandOver {
  std::uint64_t path_tick = 0;
  std::uint64_t tick = 0;
  std::uint64_t first = 0;
};

HandOver hand_over(std::int64_t radius, std::uint64_t each, bool to_arc, bool eight = false) {
  CoreBench bench(with_eight_directions());
  const auto steps = static_cast<std::uint64_t>(eight ? CoreBench::steps_in_eight(radius) : 8 * radius);
  const std::uint64_t ticks = steps * each;
  bench.logs = true;
  EXPECT_TRUE(bench.write(reg::kHold, 1));
  EXPECT_TRUE(bench.circle(ticks, radius, false, eight));
  EXPECT_TRUE(to_arc ? bench.circle(400, radius, false, eight) : bench.line(400, {kOnePulse / 3, kOnePulse / 5}));
  EXPECT_TRUE(bench.feed(ticks + 400, ~std::uint64_t{0}));
  EXPECT_TRUE(bench.write(reg::kHold, 0));
  bench.idle((eight ? 32 : 16) * ticks + 2000);
  HandOver result;
  unsigned swaps = 0;
  for (std::size_t i = 0; i < bench.log.size() && result.first == 0; ++i) {
    const model::CoreModel::Outputs& out = bench.log[i].outputs;
    swaps += out.path_swap ? 1U : 0U;
    if (out.path_tick && swaps == 1) result.path_tick = i;
    if (out.tick) (swaps == 1 ? result.tick : result.first) = i;
  }
  return result;
}

// docs/developer/architecture.md, Sequencers: the accumulator is ready 9 clocks after its last path tick, or 17 in 8
// directions. The first tick of the next path follows 29 clocks later for an arc and 4 clocks later for a line.
TEST(CoreModel, HandOverAfterAnArc) {
  for (const std::int64_t radius : {1, 5, 20}) {
    for (const std::uint64_t each : {1U, 2U, 3U, 5U, 9U, 10U, 11U, 14U, 20U, 100U}) {
      const HandOver arc = hand_over(radius, each, true);
      EXPECT_EQ(arc.first, std::max(arc.path_tick + 9 + 29, arc.tick + 37)) << radius << ", " << each;
      const HandOver line = hand_over(radius, each, false);
      EXPECT_EQ(line.first, std::max(line.path_tick + 9 + 4, line.tick + 8)) << radius << ", " << each;
      const HandOver eight = hand_over(radius, each, true, true);
      EXPECT_EQ(eight.first, std::max(eight.path_tick + 17 + 29, eight.tick + 37)) << radius << ", " << each;
      const HandOver line_after = hand_over(radius, each, false, true);
      EXPECT_EQ(line_after.first, std::max(line_after.path_tick + 17 + 4, line_after.tick + 8))
          << radius << ", " << each;
    }
  }
  // With 20 or more ticks per path tick the last path tick has been processed; only 37 or 8 clocks remain.
  EXPECT_EQ(hand_over(5, 100, true).first - hand_over(5, 100, true).tick, 37U);
  EXPECT_EQ(hand_over(5, 100, false).first - hand_over(5, 100, false).tick, 8U);
}

// An arc in chords in the plane of the first two axes; it lasts `ticks` feed ticks.
std::vector<std::uint32_t> chord_words(std::uint8_t number, const ArcPoints& arc, std::uint64_t ticks) {
  const model::ChordFields fields = prepare_chords(arc);
  const model::ChordRotation::State& state = fields.state;
  const int128 prescale = ((int128{fields.path_ticks} << 40) + ticks / 2) / ticks;
  return command_words(card_map::Opcode::ArcChord, 3, number, ticks,
                       {{"path_ticks", fields.path_ticks},
                        {"prescale", prescale},
                        {"plane", 1 << 8 | (state.clockwise ? 1 : 0)},
                        {"shifts", state.k | state.m << 8},
                        {"x", state.x},
                        {"y", state.y},
                        {"first_x", fields.first[0]},
                        {"first_y", fields.first[1]},
                        {"closing_x", state.closing_x},
                        {"closing_y", state.closing_y}});
}

// An arc from the rightmost point, about 40 pulses long.
ArcPoints short_arc(std::int64_t radius, bool clockwise) {
  ArcPoints arc;
  const double angle = 40.0 / static_cast<double>(radius);
  arc.start = {radius, 0};
  arc.end = {std::llround(static_cast<double>(radius) * std::cos(angle)),
             std::llround(static_cast<double>(radius) * std::sin(angle)) * (clockwise ? -1 : 1)};
  arc.clockwise = clockwise;
  arc.ticks_a_pulse = 16;
  return arc;
}

// The steps of the path and their path ticks are those of the arc, regardless of the clocks between ticks.
TEST(CoreModel, AChordArcsStepsCarryTheirPathTicks) {
  std::vector<StepRecorder::Path> lists[2];
  const ArcPoints arc = short_arc(90, false);
  const std::uint64_t ticks = prepare_chords(arc).path_ticks;
  for (const unsigned slow : {0U, 1U}) {
    model::CardConfig config;
    config.engines |= card_map::engines::kArcGenerator;
    CoreBench bench(config);
    ASSERT_TRUE(bench.line(50, {kOnePulse / 10}));
    ASSERT_TRUE(bench.send(chord_words(bench.number++, arc, ticks)));
    ASSERT_TRUE(bench.line(50, {kOnePulse / 10}));
    ASSERT_TRUE(bench.feed(ticks + 100, slow != 0 ? kTickEachClock / 37 : kTickEachClock));
    ASSERT_TRUE(bench.finish(100'000));
    for (auto [command, tick, axis, direction, cycle] : bench.steps.path)
      lists[slow].emplace_back(command, tick, axis, direction, 0);
  }
  EXPECT_GT(lists[0].size(), 40U);
  EXPECT_EQ(lists[0], lists[1]);
  for (const auto& step : lists[0]) {
    EXPECT_GE(std::get<1>(step), 1U);
    EXPECT_LE(std::get<1>(step), std::get<0>(step) == 1 ? ticks : 50U);
  }
}

// Clocks between ticks: within an arc in chords, and from one path to the next.
struct ChordGaps {
  std::uint64_t longest = 0;    // second path, after the ten ticks in which the tick source recovers
  std::uint64_t start = 0;      // longest among its first ten ticks
  std::uint64_t hand_over = 0;  // from the last tick of the second path to the first tick of the third
};

// A line, an arc, and then another arc or a line of all axes.
ChordGaps chord_gaps(std::int64_t radius, bool to_arc) {
  model::CardConfig config;
  config.engines |= card_map::engines::kArcGenerator;
  CoreBench bench(config);
  const ArcPoints arc = short_arc(radius, false);
  const std::uint64_t ticks = prepare_chords(arc).path_ticks;
  bench.logs = true;
  for (unsigned n = 0; n < 4; ++n) {
    EXPECT_TRUE(bench.write(reg::step_length(n), 1));
    for (const auto address : {reg::step_space(n), reg::dir_setup(n), reg::dir_hold(n)})
      EXPECT_TRUE(bench.write(address, 0));
  }
  EXPECT_TRUE(bench.write(reg::kHold, 1));
  EXPECT_TRUE(bench.line(400, {kOnePulse / 20, kOnePulse / 10}));
  EXPECT_TRUE(bench.send(chord_words(bench.number++, short_arc(radius, false), ticks)));
  if (to_arc)
    EXPECT_TRUE(bench.send(chord_words(bench.number++, short_arc(radius, true), ticks)));
  else
    EXPECT_TRUE(bench.line(ticks, {0, 0, 0, 0}));
  EXPECT_TRUE(bench.feed(2 * ticks + 400, ~std::uint64_t{0}));
  EXPECT_TRUE(bench.write(reg::kHold, 0));
  bench.idle(3 * ticks + 3000);
  EXPECT_EQ(bench.core.outputs().fault, 0U);
  const std::int64_t x = 20 + (to_arc ? 2 : 1) * (arc.end[0] - arc.start[0]);
  EXPECT_EQ(bench.core.position(0), static_cast<std::uint32_t>(x));
  EXPECT_EQ(bench.core.position(1), static_cast<std::uint32_t>(40 + (to_arc ? 0 : arc.end[1])));
  ChordGaps gaps;
  unsigned swaps = 0;
  std::uint64_t made = 0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < bench.log.size(); ++i) {
    const model::CoreModel::Outputs& out = bench.log[i].outputs;
    if (out.tick && swaps == 2) {
      std::uint64_t& gap = made < 10 ? gaps.start : gaps.longest;
      gap = std::max<std::uint64_t>(gap, i - last);
      ++made;
    }
    if (out.tick && swaps == 3 && gaps.hand_over == 0) gaps.hand_over = i - last;
    if (out.tick) last = i;
    swaps += out.path_swap ? 1U : 0U;
  }
  EXPECT_EQ(swaps, 3U);
  EXPECT_EQ(made, ticks);
  return gaps;
}

// docs/developer/architecture.md, arc_generator: only the start stalls; the hand-over takes the documented clocks.
TEST(CoreModel, HandOverOfArcsInChords) {
  for (const std::int64_t radius : {10, 40, 5000, 600'000}) {
    const ChordGaps line = chord_gaps(radius, false);
    const ChordGaps arc = chord_gaps(radius, true);
    EXPECT_EQ(line.longest, 1U) << radius;
    EXPECT_EQ(line.start, radius < 500'000 ? 14U : 16U) << radius;
    EXPECT_EQ(line.hand_over, 23U) << radius;
    EXPECT_EQ(arc.hand_over, 33U) << radius;
    EXPECT_EQ(arc.longest, 1U) << radius;
  }
}

TEST(CoreModel, DirectMove) {
  CoreBench bench;
  ASSERT_TRUE(bench.write(reg::frequency_lo(1), 1U << 30));
  ASSERT_TRUE(bench.write(reg::frequency_hi(1), 1));
  ASSERT_TRUE(bench.write(reg::count(1), 17));
  ASSERT_TRUE(bench.write(reg::direction(1), 1));
  ASSERT_TRUE(bench.write(reg::kLengthLo, 100));
  ASSERT_TRUE(bench.write(reg::kStart, 2));
  EXPECT_TRUE((bench.core.outputs().status & 2) != 0);
  ASSERT_TRUE(bench.finish(10000));
  EXPECT_EQ(bench.core.position(1), 0U - 17U);
}

}  // namespace
}  // namespace trammel::testing
