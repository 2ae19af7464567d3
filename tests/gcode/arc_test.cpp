// G2 and G3: centres, planes and refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "reading.hpp"

namespace trammel::gcode {

using namespace machine;
namespace {

using ::testing::HasSubstr;

Motion last_arc(const std::string& text) {
  const Reading program = read_text("F60\n" + text);
  return program.motions.at(program.motions.size() - 2);
}

std::string arc_refusal(const std::string& text) { return read_text("F60\n" + text).message(); }

void expect_arc(const std::string& text, double centre_x, double centre_y, bool clockwise, bool full = false) {
  SCOPED_TRACE(text);
  const Motion arc = last_arc(text);
  ASSERT_EQ(arc.kind, MotionKind::kArc);
  EXPECT_NEAR(arc.centre_x, centre_x, 1e-9);
  EXPECT_NEAR(arc.centre_y, centre_y, 1e-9);
  EXPECT_EQ(arc.clockwise, clockwise);
  EXPECT_EQ(arc.full_circle, full);
  EXPECT_EQ(arc.feed, 1);
}

TEST(GcodeArc, CentreFromOffsets) {
  expect_arc("G2 X10 Y10 I10", 10, 0, true);
  expect_arc("G3 X10 Y10 J10", 0, 10, false);
  expect_arc("G0 X1 Y2\nG91 G2 X10 Y10 I10 J0", 11, 2, true);
  expect_arc("G0 X1 Y2\nG90.1 G2 X11 Y12 I11 J2", 11, 2, true);
  expect_arc("G0 X5\nG92 X0\nG90.1 G2 X10 Y10 I10 J0", 15, 0, true);
}

TEST(GcodeArc, CentreFromRadius) {
  expect_arc("G2 X10 Y10 R10", 10, 0, true);
  expect_arc("G2 X10 Y10 R-10", 0, 10, true);
  expect_arc("G3 X10 Y10 R10", 0, 10, false);
  expect_arc("G3 X10 Y10 R-10", 10, 0, false);
  expect_arc("G3 X10 R5", 5, 0, false);
  expect_arc("G3 X10 R4.999", 5, 0, false);
}

TEST(GcodeArc, FullCircles) {
  expect_arc("G2 I5", 5, 0, true, true);
  expect_arc("G3 X0 Y0 J-5", 0, -5, false, true);
  expect_arc("G2 I5\nJ5", 0, 5, true, true);
}

TEST(GcodeArc, PlanesAreRightHanded) {
  const Motion zx = last_arc("G18 G2 Z10 X10 K10");
  EXPECT_EQ(zx.axis_x, 2);
  EXPECT_EQ(zx.axis_y, 0);
  EXPECT_NEAR(zx.centre_x, 10, 1e-9);
  EXPECT_NEAR(zx.centre_y, 0, 1e-9);
  const Motion yz = last_arc("G19 G3 Y10 Z10 K10");
  EXPECT_EQ(yz.axis_x, 1);
  EXPECT_EQ(yz.axis_y, 2);
  EXPECT_NEAR(yz.centre_y, 10, 1e-9);
}

TEST(GcodeArc, InverseTimeAndInches) {
  EXPECT_EQ(last_arc("G93 G2 X10 Y10 I10 F30").seconds, 2);
  const Motion inch = last_arc("G20 G2 X1 Y1 I1 F60");
  EXPECT_NEAR(inch.centre_x, 25.4, 1e-12);
  EXPECT_NEAR(inch.feed, 25.4, 1e-12);
}

TEST(GcodeArc, RadiusRule) {
  EXPECT_EQ(arc_refusal("G2 X10 Y10.004 I10"), "accepted");    // error below 0.005 mm
  EXPECT_EQ(arc_refusal("G2 X100 Y100.09 I100"), "accepted");  // error below 0.1 %
  EXPECT_THAT(arc_refusal("G2 X10 Y10.02 I10"), HasSubstr("not on its circle"));
  EXPECT_THAT(arc_refusal("G2 X100 Y100.11 I100"), HasSubstr("not on its circle"));
  EXPECT_EQ(arc_refusal("G2 X1000 Y1000.49 I1000"), "accepted");
  EXPECT_THAT(arc_refusal("G2 X1000 Y1000.51 I1000"), HasSubstr("not on its circle"));
}

TEST(GcodeArc, Refusals) {
  EXPECT_EQ(arc_refusal("G2 I0 J0"), "arc of radius 0");
  EXPECT_EQ(arc_refusal("G2 X1 R0"), "arc of radius 0");
  EXPECT_EQ(arc_refusal("G2 X1 I1"), "arc of radius 0");
  EXPECT_THAT(arc_refusal("G2"), HasSubstr("I, J, K or R"));
  EXPECT_THAT(arc_refusal("G2 I5\nX1"), HasSubstr("I, J, K or R"));
  EXPECT_THAT(arc_refusal("G2 X10 R4.9"), HasSubstr("R is too small"));
  EXPECT_THAT(arc_refusal("G2 R5"), HasSubstr("full circle"));
  EXPECT_THAT(arc_refusal("G2 X10 R5 I5"), HasSubstr("not both"));
  EXPECT_THAT(arc_refusal("G2 X10 I5 K1"), HasSubstr("K in the plane XY (G17)"));
  EXPECT_THAT(arc_refusal("G18 G2 X10 I5 J1"), HasSubstr("J in the plane ZX (G18)"));
  EXPECT_THAT(arc_refusal("G2 X10 R5 J5"), HasSubstr("not both"));
  EXPECT_THAT(arc_refusal("G90.1 G2 X10 I5"), HasSubstr("both words"));
  EXPECT_THAT(arc_refusal("G90.1 G2 X10 J5"), HasSubstr("both words"));
  EXPECT_EQ(refusal("G2 X10 I5"), "1: motion with feed, but no F word before");
  EXPECT_EQ(arc_refusal("G53 G2 X10 Y10 I10"), "G53 needs G0 or G1");
  EXPECT_EQ(arc_refusal("G1 X1 I5"), "I without G2, G3 or G5");
  EXPECT_EQ(arc_refusal("G0 R5"), "R without G2, G3 or a drilling cycle");
  EXPECT_THAT(arc_refusal("G1 X10 P2"), HasSubstr("P without"));
  EXPECT_THAT(arc_refusal("G2 X10 Y10 I10\nP2"), HasSubstr("P without")) << "no arc on this line";
  EXPECT_EQ(arc_refusal("G2 X10 Y10 I10 P0"), "P0: an arc makes a whole number of turns, 1 to 10000");
}

// Axes outside the plane move along, which makes a helix. P counts every turn that the arc begins.
TEST(GcodeArc, Helices) {
  const Motion thread = last_arc("G2 X10 Y10 Z-3 E1 I10 P3");
  EXPECT_EQ(thread.kind, MotionKind::kArc);
  EXPECT_EQ(thread.target[2], -3);
  EXPECT_EQ(thread.target[3], 1);
  EXPECT_EQ(thread.turns, 2U);
  EXPECT_FALSE(thread.full_circle);
  EXPECT_EQ(last_arc("G2 X10 Y10 Z-3 I10").turns, 0U);
  EXPECT_EQ(last_arc("G2 X10 Y10 Z-3 I10 P1").turns, 0U);
  const Motion circles = last_arc("G3 Z2 I5 P4");
  EXPECT_TRUE(circles.full_circle);
  EXPECT_EQ(circles.turns, 3U);
  const Motion side = last_arc("G18 G3 X20 Y7 Z0 I10 K0");
  EXPECT_EQ(side.target[1], 7);
  EXPECT_EQ(last_arc("G2 X5 I2.5\nX10 I2.5 P2").turns, 1U) << "G2 is modal";
  // If another word of the line uses P, then P belongs to that word.
  EXPECT_EQ(last_arc("G2 I5 G64 P2").turns, 0U);
  EXPECT_EQ(last_arc("G2 I5 G4 P2").turns, 0U);
  // G61 does not use P.
  EXPECT_EQ(last_arc("G2 I5 G61 P2").turns, 1U);
  EXPECT_EQ(last_arc("G2 I5 G61.1 P3").turns, 2U);
}

TEST(GcodeArc, NeedsTheAxesOfThePlane) {
  Machine machine = default_machine();
  machine.axes.erase(machine.axes.begin() + 1);
  EXPECT_EQ(read_text("G2 I5 F1", machine).error->code, ErrorCode::kArcPlaneAxis);
  EXPECT_EQ(read_text("G19 G2 J5 F1", machine).message(),
            "an arc in this plane needs an axis Y, which the machine lacks");
  EXPECT_FALSE(read_text("G18 G2 I5 F1", machine).error);
}

}  // namespace
}  // namespace trammel::gcode
