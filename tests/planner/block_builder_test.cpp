#include "trammel/planner/block_builder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "plan.hpp"
#include "trammel/driver/card_timing.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::planner {
namespace {

using ::testing::HasSubstr;

std::string refusal(const std::string& text, const machine::Machine& machine, gcode::ErrorCode* code = nullptr,
                    const gcode::Coordinates& start = {}) {
  const Plan plan = plan_text(text, machine, kCard, start);
  if (!plan.error) return "accepted";
  if (code != nullptr) *code = plan.error->code;
  return gcode::describe(*plan.error);
}

TEST(SoftLimits, RefuseTargetsWithFileAndLine) {
  const machine::Machine machine = machine_with({"axis.x.min=-10", "axis.x.max=200"});
  gcode::ErrorCode code{};
  EXPECT_EQ(refusal("G0 X200\nX-10\n", machine), "accepted") << "the limits themselves";
  EXPECT_EQ(refusal("G0 X200\nX200.01\n", machine, &code),
            "p.ngc:2: X200.01 is beyond the axis's max of 200 (machine coordinates)");
  EXPECT_EQ(code, gcode::ErrorCode::kSoftLimit);
  EXPECT_THAT(refusal("G1 X-10.5 F100\n", machine), HasSubstr("p.ngc:1: X-10.5 is beyond the axis's min of -10"));
  EXPECT_EQ(refusal("G0 Y5000\n", machine), "accepted") << "Y has none";
}

TEST(SoftLimits, CountInMachineCoordinates) {
  const machine::Machine machine = machine_with({"axis.x.max=200", "axis.x.g54=150"});
  EXPECT_EQ(refusal("G54 G0 X50\n", machine), "accepted");
  EXPECT_THAT(refusal("G54 G0 X51\n", machine), HasSubstr("X201 is beyond"));
}

TEST(SoftLimits, HoldForTheExtremesOfArcs) {
  const machine::Machine machine = machine_with({"axis.x.max=109.9", "axis.y.min=-10.001"});
  // Half a circle of radius 10 about (100, 0), with its ends inside: clockwise through X110, else through X90.
  EXPECT_THAT(refusal("G0 X100 Y10\nG2 Y-10 J-10 F100\n", machine), HasSubstr("p.ngc:2: X110 is beyond"));
  EXPECT_EQ(refusal("G0 X100 Y10\nG3 Y-10 J-10 F100\n", machine), "accepted");
  EXPECT_THAT(refusal("G0 X90\nG3 I10 F100\n", machine), HasSubstr("p.ngc:2: X110 is beyond")) << "a full circle";
  EXPECT_THAT(refusal("G0 X90\nG3 X109 Y-10.1 R20 F100\n", machine), HasSubstr("Y-10.1")) << "the end";
}

// A machine outside its limits may move other axes, and may move back inside.
TEST(SoftLimits, HoldForWhatMovesOnly) {
  const machine::Machine machine = machine_with({"axis.x.max=10", "axis.y.max=10"});
  EXPECT_EQ(refusal("G0 Y5\nX3\n", machine, nullptr, {50, 0}), "accepted");
  EXPECT_THAT(refusal("G0 X49\n", machine, nullptr, {50, 0}), HasSubstr("X49 is beyond"));
}

TEST(CountersRange, HoldsForTheExtremesOfArcs) {
  const machine::Machine machine = machine::default_machine();
  gcode::ErrorCode code{};
  EXPECT_THAT(refusal("G0 X26843000\nG2 I1000 F1\n", machine, &code),
              HasSubstr("p.ngc:2: X26845000 is beyond the card"));
  EXPECT_EQ(code, gcode::ErrorCode::kPositionRange);
}

TEST(Blocks, StartWhereTheMachineStands) {
  const Plan plan = plan_text("G91 G0 X1\n", machine::default_machine(), kCard, {10, 5});
  EXPECT_EQ(plan.start, (Pulses{800, 400}));
  ASSERT_FALSE(plan.blocks.empty());
  EXPECT_EQ(plan.blocks[0]->start, (Pulses{800, 400}));
  EXPECT_EQ(plan.blocks[0]->end, (Pulses{880, 400}));
}

TEST(Blocks, HaveLengthAndLimitsOfTheirPath) {
  const machine::Machine machine = machine_with({"axis.x.max_jerk=5000", "axis.y.max_jerk=50000"});
  const Plan plan = plan_text("G1 X30 Y40 F600\nG1 Z1\n", machine, kCard);
  const Block& block = plan.blocks.at(0).planned.block;
  EXPECT_DOUBLE_EQ(block.length, 50);
  EXPECT_DOUBLE_EQ(block.pulses_per_mm, 80);
  EXPECT_DOUBLE_EQ(block.speed, 10);
  EXPECT_DOUBLE_EQ(block.wanted, 10);
  EXPECT_DOUBLE_EQ(block.feed, 10);
  EXPECT_DOUBLE_EQ(block.acceleration, machine.axes[1].max_acceleration / 0.8) << "Y makes four fifths";
  EXPECT_DOUBLE_EQ(block.jerk, 5000 / 0.6) << "X makes three";
  EXPECT_EQ(block.entry, (Direction{0.6, 0.8}));
  EXPECT_EQ(block.exit, block.entry);
}

TEST(Blocks, AreThoseOfThePathBeforeRounding) {
  const Plan plan = plan_text("G1 X0.021 Y0.004 F600\n", machine::default_machine(), kCard);
  const Block& block = plan.blocks.at(0).planned.block;
  EXPECT_EQ(block.end, (Pulses{2, 0}));
  EXPECT_DOUBLE_EQ(block.length, std::sqrt(0.021 * 0.021 + 0.004 * 0.004));
  EXPECT_DOUBLE_EQ(block.entry[1], 0.004 / block.length);
}

// A line that is too short for a step is part of the next line.
TEST(Blocks, BeginWhereTheLastOneEnded) {
  const Plan plan = plan_text("G1 X1 F600\nX1.003 Y0.004\nX1.006 Y0.008\nX2\n", machine::default_machine(), kCard);
  ASSERT_EQ(plan.blocks.size(), 4U);
  EXPECT_DOUBLE_EQ(plan.blocks[1]->length, 0.01) << "a pulse in Y";
  EXPECT_EQ(plan.blocks[1]->end, (Pulses{80, 1}));
  EXPECT_DOUBLE_EQ(plan.blocks[2]->length, 0.994);
}

// The length is measured along X, Y and Z if one of them moves. If another axis makes more pulses, pulses_per_mm counts
// the pulses of that axis.
TEST(Blocks, HaveTheLengthOfXYZWhateverGoesAlong) {
  const Plan plan = plan_text("G1 X3 Y4 E2 F600\nX3.1 E12\nX3.1001 E22\n", machine::default_machine(), kCard);
  EXPECT_DOUBLE_EQ(plan.blocks.at(0)->length, 5);
  EXPECT_DOUBLE_EQ(plan.blocks[0]->entry[3], 0.4);
  EXPECT_NEAR(plan.blocks.at(1)->length, 0.1, 1e-12);
  EXPECT_NEAR(plan.blocks[1]->entry[3], 100, 1e-9);
  // The steps of E are as even: 128 ticks each, over the same length.
  EXPECT_NEAR(plan.blocks[0]->pulses_per_mm, 80, 1e-9);
  EXPECT_NEAR(plan.blocks[1]->pulses_per_mm, 8000, 1e-6);
  // X moves by less than a pulse, so the length is that of E.
  EXPECT_NEAR(plan.blocks.at(2)->length, 10, 1e-9);
}

TEST(Blocks, LeaveRoomForOverridesAndHolds) {
  const machine::Machine machine =
      machine_with({"motion.max_override=2", "motion.hold_reserve=0.25", "axis.x.max_jerk=8000"});
  const Plan plan = plan_text("G0 X100\n", machine, kCard);
  EXPECT_DOUBLE_EQ(plan.blocks.at(0)->speed, machine.axes[0].max_velocity / 2);
  EXPECT_DOUBLE_EQ(plan.blocks[0]->acceleration, machine.axes[0].max_acceleration * 0.75 / 4);
  EXPECT_DOUBLE_EQ(plan.blocks[0]->jerk, 1000);
}

TEST(Blocks, EndAtAnError) {
  const machine::Machine machine = machine_with({"axis.x.max=10"});
  gcode::TextLines lines("G0 X11\nG0 X1\n", "p.ngc");
  gcode::Reader reader(lines, machine);
  BlockBuilder blocks(reader, machine, kCard);
  Block block;
  EXPECT_FALSE(blocks.next(block));
  EXPECT_FALSE(blocks.next(block)) << "what follows is not looked at";
  ASSERT_TRUE(blocks.error());
  EXPECT_EQ(blocks.error()->line, 1U);
}

TEST(Blocks, RefuseStepTimesThatTheCardCannotKeep) {
  const machine::Machine machine = machine_with({"axis.x.step_length_ns=600000"});
  EXPECT_NO_THROW(plan_text("G0 X1\n", machine, kCard));
  EXPECT_THROW(plan_text("G0 X1\n", machine, {1'000'000'000, 4, true}), driver::ArgumentError);
}

SpeedLimit limit_of(const std::string& text, const machine::Machine& machine = machine::default_machine(),
                    const CardLimits& card = kCard) {
  const Plan plan = plan_text(text, machine, card);
  return plan.blocks.at(plan.blocks.size() - 2).planned.limit;
}

TEST(FeedsNotReached, HaveACause) {
  EXPECT_EQ(limit_of("G1 X100 F600\n"), SpeedLimit::kNone);
  EXPECT_EQ(limit_of("G0 X100\n"), SpeedLimit::kNone) << "as fast as may be";
  EXPECT_EQ(limit_of("G1 X100 F60000\n"), SpeedLimit::kAxisVelocity);
  EXPECT_EQ(limit_of("G1 X100 F6000\n", machine_with({"axis.x.step_length_ns=500000"})), SpeedLimit::kPulseShape);
  EXPECT_EQ(limit_of("G1 X0.1 F6000\n"), SpeedLimit::kAcceleration) << "too short";
  EXPECT_EQ(limit_of("G2 I1 F6000\n"), SpeedLimit::kAcceleration) << "too strong a curve";
  const std::vector<std::string> fast = {"axis.x.step_length_ns=100",      "axis.x.step_space_ns=100",
                                         "axis.y.step_length_ns=100",      "axis.y.step_space_ns=100",
                                         "axis.x.max_velocity=2000",       "axis.y.max_velocity=2000",
                                         "axis.x.max_acceleration=100000", "axis.y.max_acceleration=100000"};
  EXPECT_EQ(limit_of("G2 I300 F100000\n", machine_with(fast), {1'000'000, 4, true, false, false}), SpeedLimit::kClock);
}

TEST(FeedsNotReached, SayHowFarTheyCome) {
  const machine::Machine machine = machine::default_machine();
  const Plan plan = plan_text("G1 X100 F60000\nG4 P0\nG1 X100.1 F6000\n", machine, kCard);
  EXPECT_NEAR(plan.blocks[0].planned.speed, machine.axes[0].max_velocity, 1e-6);
  // The speed rises over half of the way and falls over the other half: v^2 = a s.
  EXPECT_NEAR(plan.blocks[2].planned.speed, std::sqrt(machine.axes[0].max_acceleration * 0.1), 0.1);
}

// 128 ticks per pulse of length would be 15 ticks, too few to decode the next line.
TEST(ShortLines, TakeWhatTheCardNeedsToDecodeTheNext) {
  const auto ticks = [](unsigned axes) {
    const Plan plan = plan_text("G0 X0.0055\nX0.007\n", machine::default_machine(), {100'000'000, axes, true});
    return commands<driver::LineCommand>(plan.blocks.at(0)).at(0).ticks;
  };
  const Plan plan = plan_text("G1 F6 X0.006\nG4 P0\nX0.0075\n", machine::default_machine(), kCard);
  EXPECT_EQ(ticks(4), 72U);
}

// Arcs go to the generator, else to the accumulator, else they become chords. Helices and unequal scales go only to an
// engine that can make them.
TEST(Arcs, GoToWhatTheCardHas) {
  const std::string flat = "G1 X10 F600\nG2 X20 I5\n";
  const std::string helix = "G1 X10 F600\nG2 X20 I5 Z1\n";
  const machine::Machine equal = machine::default_machine();
  const machine::Machine unequal = machine_with({"axis.y.steps_per_mm=100"});
  const auto geometry = [](const std::string& text, const machine::Machine& machine, bool accumulator, bool generator) {
    const Plan plan = plan_text(text, machine, {kCard.clock_hz, 4, accumulator, false, generator});
    const Planned& arc = plan.blocks.at(1);
    EXPECT_EQ(arc->end[0], 1600);
    const std::size_t lines = commands<driver::LineCommand>(arc).size();
    switch (arc->geometry) {
      case Geometry::kArcChord:
        EXPECT_EQ(commands<driver::ArcChordCommand>(arc).size(), 1U);
        break;
      case Geometry::kArc:
        EXPECT_EQ(commands<driver::ArcCommand>(arc).size(), 1U);
        break;
      default:
        EXPECT_GT(lines, 20U);
    }
    return arc->geometry;
  };
  for (const bool accumulator : {false, true}) {
    EXPECT_EQ(geometry(flat, equal, accumulator, true), Geometry::kArcChord);
    EXPECT_EQ(geometry(helix, equal, accumulator, true), Geometry::kArcChord);
    EXPECT_EQ(geometry(helix, equal, accumulator, false), Geometry::kChords);
    EXPECT_EQ(geometry(flat, unequal, accumulator, true), Geometry::kChords);
  }
  EXPECT_EQ(geometry(flat, equal, true, false), Geometry::kArc);
  EXPECT_EQ(geometry(flat, unequal, true, false), Geometry::kArc);
  EXPECT_EQ(geometry(flat, unequal, false, false), Geometry::kChords);
  EXPECT_EQ(geometry(flat, equal, false, false), Geometry::kChords);
}

// The accumulator in 4 directions would step through the centre of a circle of one pulse, so this circle is sent as
// lines.
TEST(Arcs, OfOnePulseGoOutAsLines) {
  const auto geometry = [](bool eight, const std::string& arc) {
    CardLimits card{kCard.clock_hz, 4};
    card = with_arcs_by(card, eight ? ArcsBy::kEightDirections : ArcsBy::kAccumulator);
    card.eight_directions = eight;
    return plan_text("G1 X1.0125 Y1 F600\n" + arc, machine::default_machine(), card).blocks.at(1)->geometry;
  };
  const std::string one = "G3 X1.0125 Y1 I-0.0125\n";
  const std::string two = "G3 X1.0125 Y1 I-0.025\n";
  EXPECT_EQ(geometry(false, one), Geometry::kChords);
  EXPECT_EQ(geometry(true, one), Geometry::kArc);
  EXPECT_EQ(geometry(false, two), Geometry::kArc);
}

// Half a turn between ends whose difference does not fit in 32 bits, although each of them is in range.
TEST(Arcs, OfEndsTooFarApartGoOutAsLines) {
  const CardLimits card = with_arcs_by({kCard.clock_hz, 4}, ArcsBy::kAccumulator);
  const machine::Machine machine = machine_with({"axis.x.steps_per_mm=10000", "axis.y.steps_per_mm=10000"});
  for (const char* program : {"G0 X-110000\nG2 X110000 R110000 F6000\n", "G0 Y-110000\nG2 Y110000 R110000 F6000\n"}) {
    gcode::TextLines lines(program, "p.ngc");
    gcode::Reader reader(lines, machine);
    BlockBuilder blocks(reader, machine, card);
    Block block;
    ASSERT_TRUE(blocks.next(block));
    ASSERT_TRUE(blocks.next(block));
    EXPECT_EQ(block.geometry, Geometry::kChords) << program;
    EXPECT_GT(block.chord_lines, 1000U);
  }
}

TEST(Arcs, MayBeAskedForOtherwise) {
  const CardLimits all{100'000'000, 4};
  EXPECT_TRUE(with_arcs_by(all, ArcsBy::kGenerator).arc_generator);
  EXPECT_TRUE(with_arcs_by(all, ArcsBy::kAccumulator).accumulator);
  EXPECT_FALSE(with_arcs_by(all, ArcsBy::kAccumulator).arc_generator);
  EXPECT_FALSE(with_arcs_by(all, ArcsBy::kChords).accumulator);
  EXPECT_FALSE(with_arcs_by(all, ArcsBy::kChords).arc_generator);
}

TEST(PlannedBlock, CountsItsCommandsBeforeTheyArePut) {
  class Sink final : public driver::CommandSink {
   public:
    explicit Sink(const PlannedBlock& planned) : planned_(planned) {}
    void put(const driver::Command& command) override {
      const bool feed = std::holds_alternative<driver::FeedCommand>(command);
      const bool barrier =
          std::holds_alternative<driver::DwellCommand>(command) || std::holds_alternative<driver::EndCommand>(command);
      geometry += !feed;
      pieces += feed || barrier;
      ++all;
      announced = planned_.commands;
      line = planned_.block.line;
    }
    std::uint64_t geometry = 0, pieces = 0, all = 0, announced = 0;
    std::size_t line = 0;

   private:
    const PlannedBlock& planned_;
  };
  const machine::Machine machine = machine_with({"axis.y.steps_per_mm=100"});
  gcode::TextLines lines("G1 X10 F600\nG2 X20 I5\nG4 P30000\nM2\n", "p.ngc");
  gcode::Reader reader(lines, machine);
  BlockBuilder blocks(reader, machine, kCard);
  Planner planner(blocks, machine, kCard);
  PlannedBlock planned;
  std::size_t count = 0;
  while (true) {
    Sink sink(planned);
    if (!planner.next(sink, planned)) break;
    ++count;
    EXPECT_EQ(sink.all, planned.commands);
    EXPECT_EQ(sink.announced, planned.commands);
    EXPECT_EQ(sink.geometry, planned.geometry);
    EXPECT_EQ(sink.pieces, planned.feed);
    EXPECT_EQ(sink.line, planned.block.line);
  }
  EXPECT_EQ(count, 4U);
}

}  // namespace
}  // namespace trammel::planner
