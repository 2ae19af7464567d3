#include "trammel/planner/planner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "chord_arc.hpp"
#include "plan.hpp"

namespace trammel::planner {

using namespace driver;
using namespace machine;
using namespace gcode;
namespace {

__extension__ typedef __int128 int128;

using ::testing::HasSubstr;

std::vector<Planned> plan_of(const std::string& text, const Machine& machine = default_machine(),
                             std::uint32_t clock_hz = kClock, ArcsBy arcs = ArcsBy::kGenerator) {
  const Plan result = plan_text(text, machine, with_arcs_by({clock_hz, 4}, arcs));
  if (result.error) throw std::runtime_error(describe(*result.error));
  return result.blocks;
}

std::string refusal(const std::string& text) {
  const Plan result = plan_text(text, default_machine(), {kClock, 4});
  return result.error ? describe(*result.error) : "accepted";
}

std::uint64_t path_ticks(const Planned& segment) {
  std::uint64_t sum = 0;
  for (const LineCommand& line : commands<LineCommand>(segment)) {
    sum += line.ticks;
  }
  for (const ArcCommand& arc : commands<ArcCommand>(segment)) {
    sum += arc.ticks;
  }
  for (const ArcChordCommand& arc : commands<ArcChordCommand>(segment)) {
    sum += arc.ticks;
  }
  return sum;
}

// Pulses that the lines of a segment make: floor(1/2 + N * increment / 2^40).
Pulses line_pulses(const Planned& segment) {
  Pulses sum{};
  for (const LineCommand& line : commands<LineCommand>(segment)) {
    for (std::size_t axis = 0; axis < card_map::kMaxAxes; ++axis) {
      const int128 phase = (int128{1} << 39) + static_cast<int128>(line.ticks) * line.increment[axis];
      sum[axis] += static_cast<std::int64_t>(phase >> 40);
    }
  }
  return sum;
}

// Pulses of the lines and of the arcs in chords: in their plane by the rule of their increments, outside it as lines.
Pulses pulses_of(const Planned& segment) {
  Pulses sum = line_pulses(segment);
  for (const ArcChordCommand& arc : commands<ArcChordCommand>(segment)) {
    model::ChordPath path(model::fields_of(arc));
    path.finish([] {});
    sum[arc.axis_x] += path.position()[0];
    sum[arc.axis_y] += path.position()[1];
    Planned further;
    LineCommand line;
    line.ticks = arc.path_ticks;
    line.increment = arc.increment;
    further.commands.emplace_back(line);
    const Pulses made = line_pulses(further);
    for (std::size_t axis = 0; axis < card_map::kMaxAxes; ++axis) sum[axis] += made[axis];
  }
  return sum;
}

// Throws when a command does not fit its layout.
void encode_all(const Planned& segment) {
  std::vector<std::uint32_t> words;
  for (const Command& command : segment.commands) {
    encode(command, 0, words);
  }
}

bool is_sound(const Stretch& stretch) { return stretch.feed_ticks == stretch.path_ticks && stretch.piece_first; }

// Checks that apply to every moving segment.
void expect_sound(const Planned& segment) {
  EXPECT_NO_THROW(encode_all(segment));
  bool geometry = false;
  for (const Command& command : segment.commands) {
    const bool feed = std::holds_alternative<FeedCommand>(command);
    EXPECT_FALSE(feed && geometry) << "feed after geometry";
    geometry = geometry || !feed;
  }
  if (commands<ArcCommand>(segment).empty()) {
    const Pulses made = pulses_of(segment);
    for (std::size_t axis = 0; axis < card_map::kMaxAxes; ++axis) {
      EXPECT_EQ(made[axis], segment->end[axis] - segment->start[axis]);
    }
  }
  for (const LineCommand& line : commands<LineCommand>(segment)) {
    for (const std::int64_t increment : line.increment) {
      EXPECT_LE(std::abs(increment), std::int64_t{1} << 40);
    }
  }
}

// Largest rate, ticks/s.
double top_rate(const Planned& segment, std::uint32_t clock_hz = kClock) {
  double top = 0;
  for (const FeedCommand& piece : commands<FeedCommand>(segment)) {
    top = std::max(top, std::ldexp(static_cast<double>(piece.rate), -64));
  }
  return top * clock_hz;
}

TEST(Planner, LineHasFeedThenGeometry) {
  const auto segments = plan_of("G1 X10 Y5 F3000\nM2\n");
  ASSERT_EQ(segments.size(), 2U);
  const Planned& line = segments[0];
  EXPECT_EQ(line->line, 1U);
  EXPECT_EQ(line->geometry, Geometry::kLine);
  EXPECT_EQ(line->end, (Pulses{800, 400}));
  ASSERT_EQ(line.commands.size(), 4U);
  expect_sound(line);
  EXPECT_EQ(commands<LineCommand>(line)[0].mask, 3);
  // 11.18 mm at 80 steps/mm and 128 ticks per step.
  EXPECT_EQ(path_ticks(line), static_cast<std::uint64_t>(std::llround(std::hypot(800, 400) * 128)));
  EXPECT_NEAR(line.planned.seconds, std::hypot(10, 5) / 50 + 50 / 1000.0 * 0.894, 0.002);
  EXPECT_TRUE(std::holds_alternative<EndCommand>(segments[1].commands.at(0)));
}

TEST(Planner, FeedHoldsAlongThePath) {
  // ticks/s = feed * N / length.
  const auto xy = plan_of("G1 X30 Y40 F600");
  EXPECT_NEAR(top_rate(xy[0]) / static_cast<double>(path_ticks(xy[0])), 10.0 / 50, 1e-6);
  const auto with_e = plan_of("G1 X30 Y40 E7 F600");
  EXPECT_NEAR(top_rate(with_e[0]) / static_cast<double>(path_ticks(with_e[0])), 10.0 / 50, 1e-6);
  const auto e_only = plan_of("G1 E7 F600");
  EXPECT_NEAR(top_rate(e_only[0]) / static_cast<double>(path_ticks(e_only[0])), 10.0 / 7, 1e-5);
  const auto inverse_time = plan_of("G93 G1 X30 Y40 F6");
  EXPECT_NEAR(top_rate(inverse_time[0]) / static_cast<double>(path_ticks(inverse_time[0])), 0.1, 1e-6);
}

TEST(Planner, AxisLimitsBindTheFeed) {
  // Z is limited to 100 mm/s, which is 125 mm/s along (3, 0, 4).
  const auto segments = plan_of("G0 X60 Z80");
  EXPECT_NEAR(top_rate(segments[0]) / static_cast<double>(path_ticks(segments[0])), 100.0 / 80, 1e-4);
  const auto fast = plan_of("G1 X100 F60000");
  EXPECT_NEAR(top_rate(fast[0]) / static_cast<double>(path_ticks(fast[0])), 150.0 / 100, 1e-4);
}

TEST(Planner, PulseShapeBindsTheSpeed) {
  Machine machine = default_machine();
  apply_override(machine, "axis.x.step_length_ns=500000");  // with the space 502 us: 1992 pulses/s
  const auto segments = plan_of("G0 X100", machine);
  EXPECT_LE(top_rate(segments[0]) / static_cast<double>(path_ticks(segments[0])) * 8000, 1992.0);
  EXPECT_GE(top_rate(segments[0]) / static_cast<double>(path_ticks(segments[0])) * 8000, 1800.0);
}

TEST(Planner, RoundsAbsoluteTargetsHalfAwayFromZero) {
  // 0.00625 mm are half a pulse.
  EXPECT_EQ(plan_of("G0 X0.00625")[0]->end[0], 1);
  EXPECT_EQ(plan_of("G0 X-0.00625")[0]->end[0], -1);
  EXPECT_EQ(plan_of("G0 X0.00624").size(), 1U);
  std::string text = "G91 G0\n";
  for (int i = 0; i < 1000; ++i) {
    text += "X0.003\n";
  }
  const auto segments = plan_of(text);
  EXPECT_EQ(segments.at(segments.size() - 2)->end[0], 240);
  Pulses here{};
  for (const Planned& segment : segments) {
    EXPECT_EQ(segment->start, here);
    here = segment->end;
  }
}

TEST(Planner, ExtremesWork) {
  Machine machine = default_machine();
  apply_override(machine, "axis.x.steps_per_mm=1000000");
  for (const std::uint32_t clock_hz : {100'000U, 1'000'000U, kClock}) {
    machine.clock_hz = clock_hz;
    for (const auto& segment : plan_of("G0 X0.000001\nX2000 Y0.0125\nG1 X0 F0.06\nY0 F0.06", machine, clock_hz)) {
      if (segment->geometry != Geometry::kEnd) {
        expect_sound(segment);
        EXPECT_LE(top_rate(segment, clock_hz), 0.9001 * clock_hz);
      }
    }
  }
}

TEST(Planner, RefusesTargetsBeyondTheCounters) {
  EXPECT_EQ(refusal("G0 X26843545"), "accepted");
  EXPECT_THAT(refusal("G0 X1\nG0 X26843546"), HasSubstr("p.ngc:2: X26843546 is beyond the card's 32-bit"));
  EXPECT_THAT(refusal("G0 X1\nG0 Y-26843546"), HasSubstr("p.ngc:2: Y"));
  EXPECT_THAT(refusal("G0 X26843000\nG2 I1000 F1"), HasSubstr("p.ngc:2: X"));
  EXPECT_EQ(refusal("G0 X26843000\nG2 I-1000 F1"), "accepted");
  EXPECT_THAT(refusal("G2 X1 R1e"), HasSubstr("malformed"));
  EXPECT_THAT(refusal("G2 X1 R1000000000000 F1"), HasSubstr("too large"));
}

TEST(Planner, DwellIsSplitAtTheCommandsWidth) {
  const auto segments = plan_of("G4 P0.25\nG4 P15000");
  EXPECT_EQ(commands<DwellCommand>(segments[0]).at(0).clocks, 25'000'000U);
  const auto parts = commands<DwellCommand>(segments[1]);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].clocks + parts[1].clocks, 1'500'000'000'000U);
  EXPECT_THAT(refusal("G4 P9000000"), HasSubstr("p.ngc:1: a dwell of"));
}

TEST(Planner, ArcsGoToTheAccumulator) {
  const auto segments =
      plan_of("G0 X10\nG3 X0 Y10 I-10 F600\nG2 J-5\n", default_machine(), kClock, ArcsBy::kAccumulator);
  ASSERT_EQ(segments.size(), 4U);
  for (const std::size_t i : {1U, 2U}) {
    const Planned& arc = segments[i];
    expect_sound(arc);
    EXPECT_EQ(arc->geometry, Geometry::kArc);
    ASSERT_EQ(commands<ArcCommand>(arc).size(), 1U);
  }
  const ArcCommand quarter = commands<ArcCommand>(segments[1])[0];
  EXPECT_EQ(quarter.path_ticks, 1600U);
  EXPECT_EQ(quarter.end_x, -800);
  EXPECT_EQ(quarter.end_y, 800);
  EXPECT_FALSE(quarter.clockwise);
  EXPECT_EQ(segments[1]->centre_x, 0);
  EXPECT_NEAR(segments[1]->exact.sweep, std::acos(0.0), 1e-12);
  EXPECT_NEAR(segments[1].planned.seconds, 10 * std::acos(0.0) / 10, 0.05);
  EXPECT_EQ(commands<ArcCommand>(segments[2])[0].path_ticks, 3200U);
  EXPECT_EQ(segments[2]->centre_y, 5 * 80 * 256);
}

TEST(Planner, CentripetalAccelerationIsLimited) {
  const auto arc = plan_of("G2 I1 F60000", default_machine(), kClock, ArcsBy::kAccumulator)[0];
  const ArcCommand command = commands<ArcCommand>(arc).at(0);
  const double unit_steps =
      top_rate(arc) * static_cast<double>(command.path_ticks) / static_cast<double>(command.ticks);
  EXPECT_LE(unit_steps * unit_steps / 80, 1000.0 * 80 / 2 * 1.001);
  EXPECT_GE(unit_steps * unit_steps / 80, 1000.0 * 80 / 2 * 0.89);
}

// In 8 directions the path between two steps is 1 to sqrt(2) pulses long. The acceleration is largest on the diagonal:
// v^2 / r across the path, and as much along it.
TEST(Planner, ArcsGoInEightDirectionsWhereTheCardHasThem) {
  CardLimits card{kClock, 4};
  const std::string text = "G2 I1 F60000\nG2 X2 Y2 I2 F600\n";
  card.eight_directions = true;
  const Plan without = plan_text(text, default_machine(), with_arcs_by(card, ArcsBy::kAccumulator));
  EXPECT_FALSE(commands<ArcCommand>(without.blocks[0]).at(0).eight_directions);
  const Plan eight = plan_text(text, default_machine(), with_arcs_by(card, ArcsBy::kEightDirections));
  card.eight_directions = false;
  const Plan lacking = plan_text(text, default_machine(), with_arcs_by(card, ArcsBy::kEightDirections));
  EXPECT_FALSE(commands<ArcCommand>(lacking.blocks[0]).at(0).eight_directions);

  ASSERT_EQ(eight.blocks.size(), 3U);
  for (std::size_t i = 0; i < 2; ++i) expect_sound(eight.blocks[i]);
  const ArcCommand circle = commands<ArcCommand>(eight.blocks[0]).at(0);
  EXPECT_TRUE(circle.eight_directions);
  EXPECT_EQ(circle.path_ticks, 4 * 113U) << "4 round(80 sqrt(2))";
  EXPECT_LT(commands<ArcCommand>(eight.blocks[1]).at(0).path_ticks,
            commands<ArcCommand>(without.blocks[1]).at(0).path_ticks);
  const double steps = top_rate(eight.blocks[0]) * static_cast<double>(circle.path_ticks) /
                       static_cast<double>(circle.ticks);                 // steps/s
  const double diagonal = steps * std::sqrt(2.0);                         // pulses/s along the path
  const double acceleration = std::sqrt(2.0) * diagonal * diagonal / 80;  // across and along the path, pulses/s^2
  EXPECT_LE(acceleration, 1000.0 * 80 * 1.001);
  EXPECT_GE(acceleration, 1000.0 * 80 * 0.6);
}

TEST(Planner, ArcsInEightDirectionsWaitForTheirSteps) {
  CardLimits card{1'000'000, 4};
  Machine machine = default_machine();
  for (MachineAxis& axis : machine.axes) axis.max_velocity = axis.max_acceleration = 1e6;
  card.eight_directions = true;
  const Plan plan = plan_text("G2 I100 F6000000\n", machine, with_arcs_by(card, ArcsBy::kEightDirections));
  const ArcCommand arc = commands<ArcCommand>(plan.blocks[0]).at(0);
  const double steps =
      top_rate(plan.blocks[0], card.clock_hz) * static_cast<double>(arc.path_ticks) / static_cast<double>(arc.ticks);
  EXPECT_LE(steps, 1e6 / 17);
  EXPECT_GE(steps, 1e6 / 19);
}

TEST(Planner, UnequalScalesGoOutAsChords) {
  Machine machine = default_machine();
  apply_override(machine, "axis.x.steps_per_mm=200");
  const auto segments = plan_of("G0 X10\nG3 X0 Y10 I-10 F600\nG2 J-10\n", machine);
  for (const std::size_t i : {1U, 2U}) {
    const Planned& arc = segments[i];
    expect_sound(arc);
    EXPECT_EQ(arc->geometry, Geometry::kChords);
    const auto lines = commands<LineCommand>(arc);
    ASSERT_GT(lines.size(), 10U);
    // Every corner is within the rounding to a pulse from the ellipse, every chord's middle within 0.25 pulse more.
    const double centre_x = static_cast<double>(arc->centre_x) / 256;
    const double centre_y = static_cast<double>(arc->centre_y) / 256;
    Pulses here = arc->start;
    for (const LineCommand& line : lines) {
      Planned one;
      one.commands.emplace_back(line);
      const Pulses step = line_pulses(one);
      const auto off_ellipse = [&](double x, double y) {
        const double scaled = std::hypot((x - centre_x) / 2000, (y - centre_y) / 800);
        return std::abs(scaled - 1) * std::hypot(x - centre_x, y - centre_y);
      };
      const double x = static_cast<double>(here[0]);
      const double y = static_cast<double>(here[1]);
      EXPECT_LE(off_ellipse(x, y), 1.8);
      EXPECT_LE(off_ellipse(x + static_cast<double>(step[0]) / 2, y + static_cast<double>(step[1]) / 2), 2.3);
      here[0] += step[0];
      here[1] += step[1];
    }
    EXPECT_EQ(here, arc->end);
  }
}

TEST(Planner, TinyAndHugeArcsEndWhereTheyShould) {
  for (const char* text : {"G2 X0.01 I0.005 F60", "G2 I0.01 F60", "G2 X0.02 Y0.02 R0.02 F60", "G2 X100 R3000000 F60",
                           "G2 I0.001 F60", "G3 X0.0001 Y0.0001 R-1 F60"}) {
    SCOPED_TRACE(text);
    for (const ArcsBy arcs : {ArcsBy::kGenerator, ArcsBy::kAccumulator, ArcsBy::kChords}) {
      for (const Planned& segment : plan_of(text, default_machine(), kClock, arcs)) {
        if (moves(segment.planned.block)) {
          expect_sound(segment);
        }
      }
    }
  }
}

// Any program is either refused with the number of its line or has a sound plan.
TEST(Planner, RandomTextIsRefusedOrPlanned) {
  std::size_t planned = 0;
  const std::vector<std::string> words = {
      "G0",   "G1",  "G2",  "G3",  "G17",  "G18",   "G19", "G20",   "G21",        "G28",   "G53",      "G55", "G80",
      "G90",  "G91", "G92", "G93", "G94",  "G90.1", "M82", "M83",   "X1",         "X-2.5", "Y3",       "Y0",  "Z1",
      "E2",   "I1",  "J-1", "K1",  "R2",   "F100",  "F0",  "P0.01", "G4",         "/",     "%",        "(x)", ";",
      "X1e9", "F1",  "I0",  "M2",  "I9e1", "X.001", "N5",  "J2",    "X999999999", "R-3",   "R99999999"};
  const std::vector<std::string> sound = {"G94 G1 X1 Y2 F100", "G91 G0 X-1 Z2", "G90 G0 Y7", "G94 G17 G91.1 G2 I3 F60",
                                          "G92 X0"};
  EXPECT_TRUE(rc::check("random programs", [&] {
    std::string text = "F500 G1\n";
    const int lines = *rc::gen::inRange(1, 5);
    for (int line = 0; line < lines; ++line) {
      const int count = *rc::gen::inRange(1, 4);
      // Half of the lines are valid in any state, so that some programs are accepted.
      if (*rc::gen::arbitrary<bool>()) {
        text += *rc::gen::elementOf(sound) + "\n";
        continue;
      }
      for (int word = 0; word < count; ++word) {
        text += *rc::gen::elementOf(words) + " ";
      }
      text += "\n";
    }
    const Plan result = plan_text(text, default_machine(), {kClock, 4});
    for (const Planned& segment : result.blocks) {
      encode_all(segment);
      planned += moves(segment.planned.block);
    }
    for (const Stretch& stretch : stretches_of(result.blocks)) {
      RC_ASSERT(is_sound(stretch));
    }
    RC_ASSERT(!result.error || result.error->line >= 1U);
  }));
  EXPECT_GT(planned, 10U);
}

TEST(Planner, RandomLinesAreSound) {
  EXPECT_TRUE(rc::check("lines", [] {
    const auto coordinate = [] { return *rc::gen::inRange(-200000, 200000) / std::pow(10, *rc::gen::inRange(1, 5)); };
    std::string text = "G1 F" + std::to_string(*rc::gen::inRange(1, 20000)) + "\n";
    for (int i = 0; i < 5; ++i) {
      text += "X" + std::to_string(coordinate()) + "Y" + std::to_string(coordinate()) + "Z" +
              std::to_string(coordinate()) + "E" + std::to_string(coordinate()) + "\n";
    }
    const std::uint32_t clock_hz = *rc::gen::element(1'000'000U, 25'000'000U, kClock);
    const std::vector<Planned> segments = plan_of(text, default_machine(), clock_hz);
    for (const Stretch& stretch : stretches_of(segments)) RC_ASSERT(is_sound(stretch));
    for (const Planned& segment : segments) {
      if (segment->geometry == Geometry::kEnd) {
        continue;
      }
      const Pulses made = line_pulses(segment);
      for (std::size_t axis = 0; axis < card_map::kMaxAxes; ++axis) {
        RC_ASSERT(made[axis] == segment->end[axis] - segment->start[axis]);
      }
      // No axis exceeds its velocity: ticks/s times pulses per tick.
      const Machine machine = default_machine();
      for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
        // The limit applies to the path before its ends and ticks are rounded.
        const double pulses =
            static_cast<double>(std::abs(made[axis]) - 1) / static_cast<double>(path_ticks(segment) + 1);
        RC_ASSERT(top_rate(segment, clock_hz) * pulses <= machine.axes[axis].max_velocity * 80 * 1.000001);
      }
    }
  }));
}

#ifdef TRAMMEL_SHARED_GCODE_DIR
TEST(PlannerShared, OctocatIsSound) {
  const Machine machine = default_machine();
  gcode::FileLines lines(TRAMMEL_SHARED_GCODE_DIR "/octocat.gcode");
  const Plan result = plan_lines(lines, machine, {kClock, 4});
  ASSERT_FALSE(result.error);
  Pulses here = result.start;
  for (const Planned& segment : result.blocks) {
    ASSERT_EQ(segment->start, here);
    here = segment->end;
  }
  for (const Stretch& stretch : stretches_of(result.blocks)) ASSERT_TRUE(is_sound(stretch)) << stretch.first;
  const std::size_t count = result.blocks.size();
  EXPECT_GT(count, 25000U);
  EXPECT_EQ(here, (Pulses{400, 400, 2992, 211565}));
}
#endif

}  // namespace
}  // namespace trammel::planner
