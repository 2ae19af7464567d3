// Kinematics against closed forms in this file: positions, the inverse, rates, and the images of circles.
#include "trammel/kinematics/kinematics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace trammel::kinematics {
namespace {

machine::Machine machine_with(std::initializer_list<const char*> entries) {
  machine::Machine machine = machine::default_machine();  // X Y Z E, 80 steps/mm
  for (const char* entry : entries) machine::apply_override(machine, entry);
  return machine;
}
machine::Machine corexy_machine() { return machine_with({"kinematics.name='corexy'"}); }

TEST(Kinematics, RoundingIsHalfAwayFromZero) {
  EXPECT_EQ(to_pulses(0.00625, 80), 1);
  EXPECT_EQ(to_pulses(-0.00625, 80), -1);
  EXPECT_EQ(to_pulses(0.0062, 80), 0);
  EXPECT_EQ(to_pulses(0.1 + 0.2 - 0.29375, 80), 1) << "a sum that misses a half by its rounding";
}

TEST(Cartesian, AJointForEachAxis) {
  const Kinematics k(machine_with({"axis.y.steps_per_mm=100", "axis.z.steps_per_mm=400"}));
  EXPECT_EQ(k.joints(), 4U);
  EXPECT_TRUE(k.joint_for_each_axis());
  EXPECT_EQ(k.pulses({1, -2, 0.5, 3}), (Pulses{80, -200, 200, 240}));
  EXPECT_THAT(k.coordinates({80, -200, 200, 240}), testing::ElementsAre(1, -2, 0.5, 3, 0, 0, 0, 0));
  EXPECT_EQ(k.finest(2), 400);
  EXPECT_EQ(k.pulse_rate(1, {0, 0.5}), 50);
  EXPECT_EQ(k.step_length(2), 1.0 / 400);
}

TEST(Cartesian, ACircleIsOneWhereTheScalesAreEqual) {
  const Kinematics k(machine_with({"axis.z.steps_per_mm=400"}));
  const auto xy = k.plane(0, 1);
  ASSERT_TRUE(xy);
  EXPECT_TRUE(xy->circle);
  EXPECT_FALSE(xy->mirrored);
  EXPECT_EQ(xy->scale_x, 80);
  const auto zx = k.plane(2, 0);
  ASSERT_TRUE(zx);
  EXPECT_FALSE(zx->circle) << "an ellipse along the joints";
  EXPECT_EQ(zx->joint_x, 2);
  EXPECT_EQ(zx->joint_y, 0);
  EXPECT_EQ(zx->scale_x, 400);
  EXPECT_EQ(zx->scale_y, 80);
}

TEST(SecondMotor, FollowsItsAxisAndNoCircleIsLeft) {
  const Kinematics k(machine_with({"axis.y.second_motor=true", "axis.y.second_inverted=true"}));
  ASSERT_EQ(k.joints(), 5U);
  EXPECT_EQ(k.pulses({1, 2, 3, 0}), (Pulses{80, 160, 240, 0, 160}));
  EXPECT_EQ(k.coordinates({80, 160, 240, 0, 160})[1], 2);
  EXPECT_TRUE(k.joint(4).inverted);
  EXPECT_FALSE(k.joint(1).inverted);
  EXPECT_EQ(k.step_length(4), 0);
  EXPECT_FALSE(k.plane(0, 1)) << "three joints move in this plane";
  EXPECT_TRUE(k.plane(2, 0));
}

TEST(CoreXy, SumAndDifference) {
  const Kinematics k(corexy_machine());
  EXPECT_EQ(k.joints(), 4U);
  EXPECT_FALSE(k.joint_for_each_axis());
  EXPECT_EQ(k.pulses({10, 0, 1, 0}), (Pulses{800, 800, 80, 0}));
  EXPECT_EQ(k.pulses({0, 10, 0, 0}), (Pulses{800, -800, 0, 0}));
  EXPECT_EQ(k.pulses({3, -1, 0, 0}), (Pulses{160, 320, 0, 0}));
  EXPECT_THAT(k.coordinates({160, 320, 80, 0}), testing::ElementsAre(3, -1, 1, 0, 0, 0, 0, 0));
  EXPECT_EQ(k.joint_rate(0, {0.6, 0.8}), 0.6 + 0.8);
  EXPECT_EQ(k.joint_rate(1, {0.6, 0.8}), 0.6 - 0.8);
  EXPECT_DOUBLE_EQ(k.step_length(0), std::sqrt(0.5) / 80);
}

TEST(CoreXy, ACircleIsAMirroredOneAndOnlyThere) {
  const Kinematics k(corexy_machine());
  const auto xy = k.plane(0, 1);
  ASSERT_TRUE(xy);
  EXPECT_TRUE(xy->circle);
  EXPECT_TRUE(xy->mirrored);
  EXPECT_DOUBLE_EQ(xy->scale_x, 80 * std::sqrt(2.0));
  // A point moves once around the circle. Checks, in pulses, its distance from the centre and its direction of
  // rotation.
  const auto at = [&](double angle) {
    const Coordinates point{5 + 3 * std::cos(angle), -2 + 3 * std::sin(angle)};
    return std::pair{k.pulse_rate(xy->joint_x, point), k.pulse_rate(xy->joint_y, point)};
  };
  const std::pair centre{k.pulse_rate(xy->joint_x, {5, -2}), k.pulse_rate(xy->joint_y, {5, -2})};
  for (double angle = 0; angle < 6.2; angle += 0.1) {
    const auto [x, y] = at(angle);
    EXPECT_NEAR(std::hypot(x - centre.first, y - centre.second), 3 * xy->scale_x, 1e-9);
  }
  const auto [x0, y0] = at(0);
  const auto [x1, y1] = at(0.1);
  const double turn = (x0 - centre.first) * (y1 - centre.second) - (y0 - centre.second) * (x1 - centre.first);
  EXPECT_LT(turn, 0) << "counter-clockwise on the machine, clockwise on the joints";
  EXPECT_FALSE(k.plane(2, 0)) << "X moves both motors";
}

TEST(CoreXy, UnequalStepsMakeNoCircleNorAnEllipseAlongTheJoints) {
  EXPECT_FALSE(Kinematics(machine_with({"kinematics.name='corexy'", "axis.y.steps_per_mm=100"})).plane(0, 1));
}

TEST(EveryMember, ComesBackToWhereItWas) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> anywhere(-500, 500);
  const std::vector<machine::Machine> machines{
      machine::default_machine(), corexy_machine(),
      machine_with({"axis.x.second_motor=true", "axis.x.steps_per_mm=320"}),
      machine_with({"kinematics.name='corexy'", "axis.z.second_motor=true", "axis.y.steps_per_mm=133.3"})};
  for (const machine::Machine& machine : machines) {
    const Kinematics k(machine);
    for (int i = 0; i < 2000; ++i) {
      Coordinates at{};
      for (std::size_t a = 0; a < k.axes(); ++a) at[a] = anywhere(random);
      const Pulses pulses = k.pulses(at);
      EXPECT_EQ(k.pulses(k.coordinates(pulses)), pulses);
      for (std::size_t a = 0; a < k.axes(); ++a) EXPECT_NEAR(k.coordinates(pulses)[a], at[a], 1 / k.finest(a));
    }
  }
}

TEST(MachineFile, NamesAMember) {
  const auto error_of = [](std::initializer_list<const char*> entries) -> std::string {
    try {
      machine_with(entries);
    } catch (const machine::MachineError& error) {
      return error.what();
    }
    return "no error";
  };
  using testing::HasSubstr;
  EXPECT_EQ(machine::default_machine().kinematics.name, "cartesian");
  EXPECT_THAT(error_of({"kinematics.name='delta'"}), HasSubstr("must be one of cartesian, corexy"));
  EXPECT_THAT(error_of({"kinematics.nam='corexy'"}), HasSubstr("did you mean name?"));
  EXPECT_THAT(error_of({"kinematics.motor_velocity=100"}), HasSubstr("motor limits are for corexy"));
  EXPECT_THAT(error_of({"kinematics.name='corexy'", "axis.x.second_motor=true"}),
              HasSubstr("with corexy two motors move X and Y together"));
  EXPECT_THAT(error_of({"kinematics.name='corexy'", "kinematics.motor_velocity=0"}),
              HasSubstr("from 0.001 to 1e+07 mm/s, not 0"));
}

}  // namespace
}  // namespace trammel::kinematics
