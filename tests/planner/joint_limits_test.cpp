// Crossed belts: joints that two axes move, and that have their own limits.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "plan.hpp"

namespace trammel::planner {
namespace {

const double kRootTwo = std::sqrt(2.0);

Block first_on_belts(const std::string& text, std::vector<std::string> more = {}) {
  more.insert(more.begin(), "kinematics.name='corexy'");
  const Plan plan = plan_text(text, machine_with(more), kCard);
  EXPECT_FALSE(plan.error);
  return plan.blocks.at(0).planned.block;
}

// A = X + Y, B = X - Y, mm of belt.
TEST(JointLimits, AJointMayMakeMorePulsesThanAnyAxis) {
  const Block diagonal = first_on_belts("G1 X10 Y10 F600\n");
  EXPECT_EQ(diagonal.end, (Pulses{1600, 0}));
  EXPECT_NEAR(diagonal.pulses_per_mm, 80 * kRootTwo, 1e-9);
  EXPECT_DOUBLE_EQ(first_on_belts("G1 X10 F600\n").pulses_per_mm, 80);
  EXPECT_DOUBLE_EQ(first_on_belts("G1 Z10 F600\n").pulses_per_mm, 80);
}

TEST(JointLimits, BindWhatMovesTheJoint) {
  const std::vector<std::string> motors = {"kinematics.motor_velocity=100", "kinematics.motor_acceleration=500",
                                           "kinematics.motor_jerk=5000"};
  const auto expect = [](const Block& block, double speed, double acceleration, double jerk) {
    EXPECT_NEAR(block.speed, speed, 1e-9);
    EXPECT_NEAR(block.acceleration, acceleration, 1e-9);
    EXPECT_DOUBLE_EQ(block.jerk, jerk);
  };
  expect(first_on_belts("G0 X10\n", motors), 100, 500, 5000);
  expect(first_on_belts("G0 X10 Y10\n", motors), 100 / kRootTwo, 500 / kRootTwo, 5000 / kRootTwo);
  expect(first_on_belts("G0 X10 Y10\n"), 150 * kRootTwo, 1000 * kRootTwo, INFINITY);
  expect(first_on_belts("G0 Z10\n", motors), 100, 1000, INFINITY);
  const std::vector<std::string> fast = {"kinematics.motor_velocity=1000", "kinematics.motor_acceleration=50000"};
  expect(first_on_belts("G0 X10\n", fast), 150, 1000, INFINITY);
}

// At a quarter turn from X to Y the velocity of joint B changes by 2 mm/s per mm/s along the path; that of joint A does
// not change.
TEST(JointLimits, BindTheSpeedInCorners) {
  const auto jump = [](const std::vector<std::string>& more) {
    std::vector<std::string> overrides = {"kinematics.name='corexy'", "motion.junction_deviation=0.05"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return plan_text("G1 F6000 X50\nY50\nX100\n", machine_with(overrides), kCard).blocks.at(0).planned.velocity_jump;
  };
  const auto expected = [](double acceleration) {
    const double half = std::sqrt(0.5);
    return std::sqrt(acceleration * 0.05 * half / (1 - half));
  };
  EXPECT_NEAR(jump({}), expected(1000 * kRootTwo), 0.01);
  EXPECT_NEAR(jump({"kinematics.motor_acceleration=1500"}), expected(1500 / kRootTwo), 0.01);
  EXPECT_NEAR(jump({"kinematics.motor_acceleration=5000"}), expected(1000 * kRootTwo), 0.01);
}

TEST(JointLimits, ArcsThatAreNoCirclesOfPulsesAreChords) {
  const auto geometry = [](const std::string& text, const std::vector<std::string>& more) {
    return first_on_belts(text, more).geometry;
  };
  EXPECT_EQ(geometry("G2 X10 I5 F600\n", {}), Geometry::kArcChord);
  EXPECT_EQ(geometry("G2 X10 I5 F600\n", {"axis.y.steps_per_mm=100"}), Geometry::kChords);
  EXPECT_EQ(geometry("G18 G2 X10 I5 F600\n", {}), Geometry::kChords) << "X moves both motors, Z a third one";
}

}  // namespace
}  // namespace trammel::planner
