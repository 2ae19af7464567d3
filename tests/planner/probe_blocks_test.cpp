// Blocks around probes, and refusals before the result of a probe is known.
#include <gtest/gtest.h>

#include <string>

#include "plan.hpp"

namespace trammel::planner {
namespace {

machine::Machine probing_machine(const std::vector<std::string>& more = {}) {
  machine::Machine machine = machine_with(more);
  machine.probe.input = 0;
  return machine;
}

CardLimits card_with_path_commands() {
  CardLimits card = kCard;
  card.outputs = 4;
  return card;
}

// The reader and the builder of a program.
struct Building {
  Building(const std::string& program, const machine::Machine& of, const CardLimits& card = card_with_path_commands())
      : text(program), machine(of), lines(text, "p.ngc"), reader(lines, machine), blocks(reader, machine, card) {}
  bool next() { return blocks.next(block); }

  std::string text;
  machine::Machine machine;
  gcode::TextLines lines;
  gcode::Reader reader;
  BlockBuilder blocks;
  Block block;
};

TEST(ProbeBlocks, AProbesWayIsABlockOfItsOwn) {
  Building it("G1 X1 F600\nM3\nG38.2 X3 F60\nG1 X5 F600\nM2\n", probing_machine({"outputs.m3=0"}));
  ASSERT_TRUE(it.next());
  EXPECT_EQ(it.block.end[0], 80);
  for (int twice = 0; twice < 2; ++twice) {
    EXPECT_FALSE(it.next());
    EXPECT_TRUE(it.blocks.at_probe());
    EXPECT_FALSE(it.blocks.error());
  }
  EXPECT_EQ(it.blocks.begin_probe().target[0], 3);
  ASSERT_TRUE(it.next());
  EXPECT_EQ(it.block.geometry, Geometry::kLine);
  EXPECT_EQ(it.block.start[0], 80);
  EXPECT_EQ(it.block.end[0], 240);
  EXPECT_DOUBLE_EQ(it.block.speed, 1);
  EXPECT_EQ(it.block.outputs.set, 1) << "what is switched before it";
  for (int twice = 0; twice < 2; ++twice) EXPECT_FALSE(it.next());
  EXPECT_TRUE(it.blocks.at_probe());

  it.reader.probed({2, 0, 0}, {2.5, 0, 0}, true);
  it.blocks.resume_at({200});
  EXPECT_FALSE(it.blocks.at_probe());
  ASSERT_TRUE(it.next());
  EXPECT_EQ(it.block.start[0], 200) << "from where the machine stands";
  EXPECT_EQ(it.block.end[0], 400);
  EXPECT_DOUBLE_EQ(it.block.length, 2.5);
  EXPECT_EQ(it.block.outputs.set, 0);
  ASSERT_TRUE(it.next());
  EXPECT_EQ(it.block.geometry, Geometry::kEnd);
  EXPECT_FALSE(it.next());
  EXPECT_FALSE(it.blocks.error());
}

TEST(ProbeBlocks, AWayWithoutAPulseIsNoBlock) {
  Building it("G38.3 X0.001 F60\nG1 X0.0125\nM2\n", probing_machine());
  EXPECT_FALSE(it.next());
  ASSERT_TRUE(it.blocks.at_probe());
  it.blocks.begin_probe();
  EXPECT_FALSE(it.next());
  EXPECT_FALSE(it.blocks.error());
  it.reader.probed({}, {}, false);
  it.blocks.resume_at({});
  ASSERT_TRUE(it.next());
  EXPECT_EQ(it.block.end[0], 1);
}

TEST(ProbeBlocks, ACardWithoutPathCommandsHasNone) {
  Building it("G1 X1 F600\nG38.2 X3\n", probing_machine(), kCard);
  ASSERT_TRUE(it.next());
  EXPECT_FALSE(it.next());
  ASSERT_TRUE(it.blocks.error());
  EXPECT_EQ(gcode::describe(*it.blocks.error()), "p.ngc:2: a probe: the card has no path commands");
  EXPECT_EQ(it.blocks.error()->code, gcode::ErrorCode::kNoProbe);
}

TEST(ProbeBlocks, KeepWithinSoftLimits) {
  Building it("G38.2 X30 F60\n", probing_machine({"axis.x.max=20"}));
  EXPECT_FALSE(it.next());
  it.blocks.begin_probe();
  EXPECT_FALSE(it.next());
  ASSERT_TRUE(it.blocks.error());
  EXPECT_EQ(gcode::describe(*it.blocks.error()), "p.ngc:1: X30 is beyond the axis's max of 20 (machine coordinates)");
}

// The probe trips at Z-3 at the latest.
TEST(ProbeBlocks, SoftLimitsOfWhatItDecidesHoldWhenThatIsKnown) {
  const auto error_of = [](const std::string& line, bool known) {
    Building it("G38.2 Z-3 F60\n" + line + "\n", probing_machine({"axis.x.max=20"}));
    EXPECT_FALSE(it.next());
    it.blocks.begin_probe();
    EXPECT_TRUE(it.next());
    if (known) {
      it.reader.probed({0, 0, -3}, {0, 0, -3}, true);
    } else {
      it.reader.assume_probed();
    }
    it.blocks.resume_at(it.block.end);
    const bool made = it.next();
    EXPECT_EQ(made, !it.blocks.error());
    return it.blocks.error() ? gcode::describe(*it.blocks.error()) : "accepted";
  };
  const std::string refused = "p.ngc:2: X30 is beyond the axis's max of 20 (machine coordinates)";
  EXPECT_EQ(error_of("G0 X[#5063*-10]", false), "accepted");
  EXPECT_EQ(error_of("G0 X[#5063*-10]", true), refused);
  EXPECT_EQ(error_of("G0 X30", false), refused) << "no probe decides this one";
  EXPECT_EQ(error_of("G0 X[#5063*-5]", true), "accepted");
}

TEST(RequiredJerk, IsAskedForWhereAnAxisMoves) {
  const auto error_of = [](const std::string& text) {
    Building it(text, machine_with({"axis.x.max_jerk=5000", "axis.z.max_jerk=5000"}));
    it.blocks.require_jerk();
    while (it.next()) continue;
    return it.blocks.error() ? gcode::describe(*it.blocks.error()) : "accepted";
  };
  const std::string refused = "p.ngc:2: axis Y moves and has no max_jerk in the machine file, which S-curves need";
  EXPECT_EQ(error_of("G1 X1 F60\nZ1 X0\nG18 G2 Z0 K-0.5\n"), "accepted");
  EXPECT_EQ(error_of("G1 X1 F60\nX2 Y1\n"), refused);
  EXPECT_EQ(error_of("G1 X1 F60\nG2 I1\n"), refused) << "an arc passes its extremes";
  EXPECT_EQ(error_of("G1 X1 F60\nG4 P1\nX2\n"), "accepted");
}

}  // namespace
}  // namespace trammel::planner
