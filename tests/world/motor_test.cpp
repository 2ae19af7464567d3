// The motor in closed forms: the oscillation of a free rotor, the largest torque, the way to rest with friction, lost
// steps.
#include "trammel/world/motor.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>

#include "trammel/world/carriage.hpp"

namespace trammel::world {
namespace {

constexpr double kStep = Motor::kLongestStep;
constexpr double kPi = 3.14159265358979;

void run(Motor& motor, double seconds) {
  for (int n = 0; n * kStep < seconds; ++n) motor.advance(kStep);
}

MotorParameters without_losses() {
  MotorParameters p;
  p.friction = 0;
  p.damping = 0;
  return p;
}

TEST(WorldMotor, FollowsItsPulsesAndStandsStillAtThem) {
  Motor motor;
  EXPECT_TRUE(motor.still());
  for (int n = 0; n < 100; ++n) {
    motor.pulse(+1);
    EXPECT_FALSE(motor.still());
    run(motor, 1e-3);
  }
  run(motor, 0.3);
  EXPECT_TRUE(motor.still());
  EXPECT_DOUBLE_EQ(motor.position(), 100);
  EXPECT_EQ(motor.lost(), 0);
  EXPECT_LT(motor.largest_lag(), 16);
}

// Small oscillations without losses have the period 2 pi sqrt(J / (T * 50)), with 50 electrical turns per turn.
TEST(WorldMotor, SwingsAtItsOwnFrequency) {
  const MotorParameters p = without_losses();
  Motor motor(p);
  motor.pulse(+1);
  const double inertia = p.rotor_inertia + p.mass * p.radius * p.radius;
  const double period = 2 * kPi * std::sqrt(inertia / (p.holding_torque * 50));
  int crossings = 0;
  double before = motor.position();
  const double seconds = 100 * period;
  for (int n = 0; n * kStep < seconds; ++n) {
    motor.advance(kStep);
    crossings += (motor.position() - 1) * (before - 1) < 0 ? 1 : 0;
    before = motor.position();
  }
  EXPECT_NEAR(crossings, 200, 1);
  EXPECT_NEAR(motor.largest_lag(), 1, 0.02);
}

// A rotor more than half an electrical turn behind the field is pulled in the other direction.
TEST(WorldMotor, ARotorLeftBehindByMoreThanTwoFullStepsFallsIntoTheNextPlace) {
  Motor near;
  for (int n = 0; n < 31; ++n) near.pulse(+1);
  run(near, 1);
  EXPECT_DOUBLE_EQ(near.position(), 31);
  EXPECT_EQ(near.lost(), 0);
  Motor far;
  for (int n = 0; n < 33; ++n) far.pulse(+1);
  run(far, 1);
  EXPECT_DOUBLE_EQ(far.position(), 33 - 64);
  EXPECT_EQ(far.lost(), 64);
  EXPECT_TRUE(far.still());
}

// The torque is largest a quarter of an electrical turn behind the field; at rest it is the whole acceleration.
TEST(WorldMotor, PullsWithItsHoldingTorque) {
  const MotorParameters p = without_losses();
  Motor motor(p);
  for (int n = 0; n < 16; ++n) motor.pulse(+1);
  motor.advance(kStep);
  const double inertia = p.rotor_inertia + p.mass * p.radius * p.radius;
  const double pulses_a_second2 = p.holding_torque / inertia * 3200 / (2 * kPi);
  EXPECT_NEAR(motor.speed(), pulses_a_second2 * kStep, pulses_a_second2 * kStep * 1e-9);
  EXPECT_NEAR(motor.strongest(), pulses_a_second2, pulses_a_second2 * 1e-9);
}

TEST(WorldMotor, AMotorThatIsTooWeakForItsFrictionStaysBehind) {
  MotorParameters p;
  p.friction = 0.5;
  p.friction_speed = 2;
  Motor motor(p);
  for (int n = 0; n < 8000; ++n) {
    motor.pulse(+1);
    run(motor, 1e-4);
  }
  EXPECT_GT(motor.lost(), 1000);
  EXPECT_EQ(motor.lost() % 64, 0);
}

TEST(WorldMotor, WithoutPowerNothingPulls) {
  Motor motor;
  motor.set_power(false);
  for (int n = 0; n < 16; ++n) motor.pulse(+1);
  run(motor, 0.1);
  EXPECT_DOUBLE_EQ(motor.position(), 0);
  EXPECT_TRUE(motor.still());
  motor.set_power(true);
  run(motor, 0.5);
  EXPECT_DOUBLE_EQ(motor.position(), 16);
}

TEST(WorldMotor, RefusesWhatItCannotCompute) {
  const auto refused = [](auto change) {
    MotorParameters p;
    change(p);
    EXPECT_THROW(Motor{p}, std::invalid_argument);
  };
  refused([](MotorParameters& p) { p.holding_torque = 0; });
  refused([](MotorParameters& p) { p.mass = -1; });
  refused([](MotorParameters& p) { p.radius = std::nan(""); });
  refused([](MotorParameters& p) { p.rotor_inertia = 1e-9, p.mass = 0; });
}

TEST(WorldCarriage, AnEndStopHoldsItAndStepsAreLost) {
  CarriageParameters p;
  p.high = 100;
  Carriage carriage(p);
  for (int n = 0; n < 300; ++n) {
    carriage.pulse(+1);
    for (int k = 0; k < 20; ++k) carriage.advance(kStep);
    ASSERT_LE(carriage.position(), 100);
  }
  for (int k = 0; k < 50000; ++k) carriage.advance(kStep);
  EXPECT_EQ(carriage.commanded(), 300);
  // The field holds the motor at 108 and so presses the carriage against the stop.
  EXPECT_EQ(carriage.lost(), 192);
  EXPECT_EQ(carriage.place(), 100);
  EXPECT_THROW((Carriage{{{}, 1, 2}}), std::invalid_argument);
  EXPECT_THROW((Carriage{{{}, -2, -1}}), std::invalid_argument);
}

// EngineInWorld relies on this bound for its waits. The pull is the strongest possible one: a quarter of an electrical
// turn.
TEST(WorldCarriage, StepsShortOfAnEdgeAreShortOfItAndNotByMuch) {
  CarriageParameters p;
  p.motor = without_losses();
  for (const std::int64_t edge : {1, 5, 80, 3000}) {
    Carriage carriage(p);
    const std::uint64_t promised = carriage.steps_short_of(edge, kStep);
    std::uint64_t steps = 0;
    for (;; ++steps) {
      // Keeps the field a quarter of an electrical turn ahead of the rotor.
      while (static_cast<double>(carriage.commanded()) - carriage.position() < 16) carriage.pulse(+1);
      carriage.advance(kStep);
      if (carriage.position() >= static_cast<double>(edge)) break;
    }
    EXPECT_LE(promised, steps) << edge;
    EXPECT_GE(promised + 2 + steps / 100, steps) << edge;
  }
}

}  // namespace
}  // namespace trammel::world
