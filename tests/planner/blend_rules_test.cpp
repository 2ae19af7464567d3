// G64 P: the corners that become blends, and the parts of the motions beside it that a blend replaces.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "plan.hpp"
#include "trammel/driver/trigonometry.hpp"

namespace trammel::planner {
namespace {

using ::testing::ElementsAre;

CardLimits switching_card() {
  CardLimits card = kCard;
  card.outputs = 4;
  return card;
}

machine::Machine fine_steps(double steps_per_mm = 1e4) {
  machine::Machine machine = machine::default_machine();
  for (machine::MachineAxis& axis : machine.axes) {
    axis.steps_per_mm = steps_per_mm;
    axis.max_velocity = 100;
  }
  return machine;
}

std::vector<Block> moving_blocks(const std::string& text, const machine::Machine& machine = fine_steps()) {
  const Plan plan = plan_text(text, machine, switching_card());
  EXPECT_FALSE(plan.error) << plan.error->message;
  std::vector<Block> blocks;
  for (const Planned& planned : plan.blocks) {
    if (moves(planned.planned.block)) blocks.push_back(planned.planned.block);
  }
  return blocks;
}

std::vector<Corner> corners_of(const std::string& text, const machine::Machine& machine = fine_steps()) {
  std::vector<Corner> corners;
  for (const Block& block : moving_blocks(text, machine)) corners.push_back(block.corner);
  return corners;
}

constexpr auto kBlend = Corner::kBlended;

TEST(BlendRules, FeedIsTheLesserOfTheTwo) {
  const auto feed = [](const std::string& text) {
    const std::vector<Block> blocks = moving_blocks("G64 P1\n" + text);
    EXPECT_EQ(blocks.size(), 3U) << text;
    EXPECT_EQ(blocks.at(1).corner, kBlend) << text;
    return blocks.at(1).rapid ? -1 : blocks.at(1).wanted;
  };
  EXPECT_NEAR(feed("G1 X20 F600\nY20 F700\n"), 10, 1e-9);
  EXPECT_NEAR(feed("G1 X20 F700\nY20 F600\n"), 10, 1e-9);
  EXPECT_EQ(feed("G0 X20\nY20\n"), -1) << "none between rapids";
  EXPECT_NEAR(feed("G0 X20\nG1 Y20 F4800\n"), 80, 1e-9);
  EXPECT_NEAR(feed("G1 X20 F4800\nG0 Y20\n"), 80, 1e-9);
  EXPECT_NEAR(feed("G93 G1 X20 F2\nY18 F2\n"), 18 / 30.0, 1e-9) << "lengths a time";
}

TEST(BlendRules, MotionsUnderG93KeepTheirSpeed) {
  const std::vector<Block> blocks = moving_blocks("G93 G64 P1\nG1 X20 F2\nY18 F2\n");
  ASSERT_EQ(blocks.size(), 3U);
  EXPECT_NEAR(blocks[0].wanted, 20 / 30.0, 1e-9);
  EXPECT_NEAR(blocks[2].wanted, 18 / 30.0, 1e-9);
  EXPECT_LT(blocks[0].length, 19) << "what is left of them takes less time";
}

TEST(BlendRules, MachinesMayLackAnAxisOfSpace) {
  machine::Machine flat = fine_steps();
  flat.axes.erase(flat.axes.begin() + 2);
  EXPECT_THAT(corners_of("G64 P1 F600\nG1 X20\nY20\n", flat), ElementsAre(Corner::kNone, kBlend, Corner::kNone));
  machine::Machine lathe = fine_steps();
  lathe.axes.erase(lathe.axes.begin() + 1);
  EXPECT_THAT(corners_of("G64 P1 F600\nG1 X20\nZ20\n", lathe), ElementsAre(Corner::kNone, kBlend, Corner::kNone));
}

// If there are more words of outputs than a blend can take along, the corner is kept and the outputs switch there.
TEST(BlendRules, EightWordsOfOutputsAtTheMost) {
  machine::Machine machine = fine_steps();
  machine.outputs.m3 = 1;
  const auto blocks = [&](int words) {
    std::string text = "G64 P1 F600\nG1 X20\n";
    for (int i = 0; i < words; ++i) text += i % 2 == 0 ? "M3\n" : "M5\n";
    return moving_blocks(text + "G1 Y20\n", machine);
  };
  const std::vector<Block> eight = blocks(8);
  ASSERT_EQ(eight.size(), 3U);
  EXPECT_EQ(eight[1].corner, kBlend);
  EXPECT_EQ(eight[1].outputs.clear, 1U);
  const std::vector<Block> nine = blocks(9);
  ASSERT_EQ(nine.size(), 2U);
  EXPECT_EQ(nine[0].corner, Corner::kNone);
  EXPECT_EQ(nine[0].end[0], 200'000);
  EXPECT_EQ(nine[1].outputs.set, 1U);
}

TEST(BlendRules, CornersAreKeptOnDemand) {
  const machine::Machine machine = fine_steps();
  gcode::TextLines lines("G64 P1 F600\nG1 X20\nY20\nM2\n", "p.ngc");
  gcode::Reader reader(lines, machine);
  BlockBuilder blocks(reader, machine, kCard);
  blocks.keep_corners();
  Block block;
  ASSERT_TRUE(blocks.next(block));
  EXPECT_EQ(block.end[0], 200'000);
  EXPECT_EQ(block.corner, Corner::kNone);
  ASSERT_TRUE(blocks.next(block));
  EXPECT_EQ(block.geometry, Geometry::kLine);
  EXPECT_EQ(block.end[1], 200'000);
}

// A full circle from (0, 0), clockwise about (5, 0). It ends upwards; the next motion goes to the left.
TEST(BlendRules, AFullCircleLosesItsEnd) {
  for (const char* turns : {"", " P3"}) {
    const std::vector<Block> blocks = moving_blocks(fmt::format("G64 P0.2 F600\nG2 I5{}\nG1 X-10\n", turns));
    ASSERT_EQ(blocks.size(), 3U);
    EXPECT_EQ(blocks[1].corner, kBlend);
    const double whole = 2 * driver::kPi * (*turns == 0 ? 1 : 3);
    EXPECT_LT(blocks[0].exact.sweep, whole - 0.01);
    EXPECT_GT(blocks[0].exact.sweep, whole - 0.5);
    EXPECT_LT(blocks[0].end[1], -100) << "below its begin, still on its way up";
    EXPECT_EQ(blocks[2].end[0], -100'000);
    EXPECT_EQ(blocks[2].end[1], 0);
  }
}

// The radius of the arc grows by 4 um, which is subtracted from the tolerance.
TEST(BlendRules, RoundedCentresTakeOfTheTolerance) {
  const std::string program = "G2 X10.004 I5\nG1 X20\n";
  EXPECT_THAT(corners_of("G64 P0.003 F600\n" + program), ElementsAre(Corner::kNoCurve, Corner::kNone));
  const std::vector<Block> blocks = moving_blocks("G64 P0.2 F600\n" + program);
  ASSERT_EQ(blocks.size(), 3U);
  EXPECT_EQ(blocks[1].corner, kBlend);
  EXPECT_NEAR(blocks[1].distance, 0.2, 1e-9) << "all of it at the most";
}

// A blend within a quarter of a pulse is not made, unless the rules of the corner do not allow its speed.
TEST(BlendRules, InvisibleOnesAreThoseOfTheCornersOwnDeviation) {
  const auto corner = [](double deviation) {
    machine::Machine machine = fine_steps(1);
    machine.motion.junction_deviation = deviation;
    const std::vector<Corner> corners = corners_of("G64 P0.2 F6000\nG1 X100\nX200 Y36\n", machine);
    return corners.size() > 1 && corners[1] == kBlend ? kBlend : corners.at(0);
  };
  EXPECT_EQ(corner(0.3), Corner::kInvisible);
  EXPECT_EQ(corner(0.001), kBlend);
}

// Soft limits apply to the corner, because it is a target of the program, although the blended path does not reach it.
TEST(BlendRules, CornersHaveToBeWithinSoftLimits) {
  machine::Machine machine = fine_steps();
  machine.axes[0].max = 20;
  const auto message = [&](const std::string& x) {
    const Plan plan = plan_text("G64 P1 F600\nG1 X" + x + "\nX0 Y20\n", machine, kCard);
    return plan.error ? gcode::describe(*plan.error) : "accepted";
  };
  EXPECT_EQ(message("20"), "accepted");
  EXPECT_EQ(message("20.1"), "p.ngc:2: X20.1 is beyond the axis's max of 20 (machine coordinates)");
}

}  // namespace
}  // namespace trammel::planner
