// Coordinate systems, G92, tool lengths and homes: from a program's coordinates to machine coordinates.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "reading.hpp"

namespace trammel::gcode {
namespace {

using ::testing::HasSubstr;

machine::Machine machine_with_tools() {
  machine::Machine machine = machine::default_machine();
  machine.axes[0].offsets = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  machine.axes[2].home = 30;
  machine.axes[0].second_home = -4;
  machine.tools.push_back({1, {0, 0, 12.5}});
  machine.tools.push_back({7, {0.5, 0, 20}});
  return machine;
}

Coordinates end_of(const std::string& text) {
  const Reading program = read_text(text, machine_with_tools());
  EXPECT_FALSE(program.error) << describe(*program.error);
  return program.motions.back().target;
}
double x_of(const std::string& text) { return end_of(text)[0]; }
double z_of(const std::string& text) { return end_of(text)[2]; }

std::string offset_refusal(const std::string& text) { return read_text(text, machine_with_tools()).message(); }

TEST(Offsets, NineCoordinateSystems) {
  const char* const systems[] = {"G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"};
  for (int i = 0; i < 9; ++i) EXPECT_EQ(x_of(std::string(systems[i]) + " G0 X10"), 11 + i) << systems[i];
}

TEST(Offsets, G10SetsASystem) {
  EXPECT_EQ(x_of("G10 L2 P2 X20\nG0 X1\nG55 X1"), 21);
  EXPECT_EQ(x_of("G10 L2 P0 X20\nG0 X1"), 21) << "this one";
  EXPECT_EQ(x_of("G20 G10 L2 P9 X1\nG21 G59.3 G0 X1"), 26.4);
  EXPECT_EQ(x_of("G91 G10 L2 P1 X20\nG90 G0 X1"), 21) << "never in increments";
  EXPECT_EQ(x_of("G0 X10\nG10 L20 P1 X0\nG0 X2"), 13);
  EXPECT_EQ(x_of("G0 X10\nG92 X3\nG10 L20 P0 X0\nG0 X2"), 13) << "what stands on the line counts, G92 and all";
  EXPECT_EQ(x_of("G0 X10\nG92 X3\nG10 L20 P0 X0\nG92.1 G0 X2"), 6);
  EXPECT_THAT(offset_refusal("G10 L1 P1 Z1"), HasSubstr("G10 L1: only L2 and L20 are supported; tool lengths"));
  EXPECT_THAT(offset_refusal("G10 L10 P1 Z1"), HasSubstr("G10 L10: only L2 and L20 are supported; tool lengths"));
  EXPECT_THAT(offset_refusal("G10 L11 P1 Z1"), HasSubstr("G10 L11: only L2 and L20 are supported; tool lengths"));
  EXPECT_EQ(offset_refusal("G10 L3 P1 Z1"), "G10 L3: only L2 and L20 are supported");
  EXPECT_EQ(offset_refusal("G10 L2 P-1 X1"), "'P-1' must not be negative");
  EXPECT_THAT(offset_refusal("G10 P1 X1"), HasSubstr("needs L2 or L20"));
  EXPECT_THAT(offset_refusal("G10 L2 X1"), HasSubstr("G10 needs P"));
  EXPECT_THAT(offset_refusal("G10 L2 P10 X1"), HasSubstr("coordinate systems are 1 (G54) to 9 (G59.3)"));
  EXPECT_THAT(offset_refusal("G10 L2 P1.5 X1"), HasSubstr("G10 P1.5"));
  EXPECT_THAT(offset_refusal("G10 L2 P1 R30"), HasSubstr("cannot be turned"));
  EXPECT_THAT(offset_refusal("G10 L2 P1 X1 G0"), HasSubstr("G10 cannot share a line with a motion"));
  EXPECT_THAT(offset_refusal("G0 X1 L2"), HasSubstr("L without G10 or a drilling cycle"));
}

TEST(Offsets, TheG92Family) {
  EXPECT_EQ(x_of("G0 X10\nG92 X2\nG92.2 G0 X5"), 6);
  EXPECT_EQ(x_of("G0 X10\nG92 X2\nG92.2\nG92.3 G0 X5"), 14);
  EXPECT_EQ(x_of("G0 X10\nG92 X2\nG92.1\nG92.3 G0 X5"), 6);
  EXPECT_EQ(x_of("G0 X10\nG92 X2\nG92.2\nG92 Y0\nG0 X5"), 14) << "what G92 does not name is back too";
}

TEST(Offsets, ToolLengths) {
  EXPECT_EQ(z_of("G43 H1 G0 Z2"), 14.5);
  EXPECT_EQ(z_of("T7 M6 G43 G0 Z2"), 22) << "the tool in the spindle";
  EXPECT_EQ(x_of("G43 H7 G0 X0"), 1.5);
  EXPECT_EQ(z_of("G43 H1\nG43 H0 G0 Z2"), 2);
  EXPECT_EQ(z_of("G43 H1\nG49 G0 Z2"), 2);
  EXPECT_EQ(z_of("T7 M6 G43\nG49 G0 Z2"), 2);
  EXPECT_EQ(z_of("G43 H1\nG53 G0 Z2"), 2);
  EXPECT_EQ(z_of("G43.1 Z3\nG0 Z1"), 4);
  EXPECT_EQ(z_of("G20 G43.1 Z1\nG21 G0 Z1"), 26.4);
  EXPECT_EQ(z_of("G43 H1\nG91 G0 Z2"), 2) << "increments know no offsets";
  EXPECT_EQ(z_of("G43 H1\nG0 Z1\nG92 Z0\nG49 G0 Z0"), 1);
  EXPECT_EQ(z_of("G0 Z5\nG43 H1\nG10 L20 P1 Z0\nG0 Z1"), 6);
  EXPECT_EQ(offset_refusal("G43 H3"),
            "G43 H3: the machine file has no tool 3: --set tools.3.z=LENGTH or [tools.3] of the file describes it");
  EXPECT_EQ(offset_refusal("G43 H11111111111"), "'H11111111111': the number of a tool is at most 999999");
  EXPECT_EQ(offset_refusal("T1000000 M6"), "'T1000000': the number of a tool is at most 999999");
  EXPECT_EQ(offset_refusal("T3 M6\nG43"),
            "G43: the machine file has no tool 3: --set tools.3.z=LENGTH or [tools.3] of the file describes it");
  EXPECT_EQ(offset_refusal("G0 X1 H1"), "H without G43");
  EXPECT_EQ(offset_refusal("G43.1"), "G43.1 without an axis word");
  EXPECT_EQ(offset_refusal("G43.1 Z1 G0"), "G43.1 cannot share a line with a motion");
}

TEST(Offsets, AToolChangeIsAStop) {
  const Reading program = read_text("G0 X1\nT1 M6\nX2\n", machine_with_tools());
  ASSERT_EQ(program.motions.size(), 4U);
  EXPECT_EQ(program.motions[1].kind, MotionKind::kDwell);
  EXPECT_EQ(program.motions[1].seconds, 0);
  const std::map<std::string, std::size_t> expected = {{"M6", 1}, {"T", 1}};
  EXPECT_EQ(program.accepted, expected);
}

TEST(Offsets, Homes) {
  EXPECT_EQ(x_of("G0 X10\nG30"), -4);
  EXPECT_EQ(z_of("G0 Z1\nG30 X0"), 1) << "the axes named alone";
  EXPECT_EQ(x_of("G0 X10 Z2\nG28.1\nG0 X0\nG28"), 11);
  EXPECT_EQ(x_of("G0 X10\nG30.1\nG0 X0\nG30 X3"), 11);
  EXPECT_EQ(z_of("G43 H1 G0 Z1\nG28.1\nG49 G0 Z5\nG28"), 13.5) << "machine coordinates";
  EXPECT_EQ(end_of("G28.1\nG0 E5\nG28")[3], 5);
  EXPECT_EQ(offset_refusal("G30 G0 X1"), "G30 cannot share a line with a motion");
}

}  // namespace
}  // namespace trammel::gcode
