// The motor against its equations, and the integration against a finer one.
#include "trammel/measure/motor.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace trammel::measure {
namespace {

// `pulses` of one axis, with even intervals or with every second pulse late by `delay` of the interval.
Trace pulses_along_x(std::uint64_t pulses, double delay = 0) {
  constexpr std::uint64_t kInterval = 1000;
  Trace trace;
  trace.clear(2, {});
  for (std::uint64_t i = 0; i < pulses; ++i) {
    const std::uint64_t late = i % 2 == 1 ? static_cast<std::uint64_t>(delay * kInterval) : 0;
    trace.add(kInterval * i + kInterval / 2 + late, {1});
  }
  trace.finish(kInterval * pulses);
  return trace;
}

IdealCurve line_along_x(std::int64_t pulses) { return IdealCurve::line(2, {}, {pulses, 0}); }

MotorRun run_at(double speed) {
  MotorRun run;
  run.speed = speed;
  return run;
}

TEST(Motor, FollowsEvenPulsesAndLagsByTheLoad) {
  // At high speed the steps average out: friction and damping against the torque of the field give the mean lag. The
  // largest lag cannot be below it, and the motor keeps up.
  const Vibration vibration = simulate_motors(pulses_along_x(100), line_along_x(100), run_at(800));
  EXPECT_FALSE(vibration.lost_steps);
  EXPECT_GT(vibration.largest_lag, 0.1);
  EXPECT_LT(vibration.largest_lag, 2);
  EXPECT_GT(vibration.rms_ripple, 0);
  EXPECT_EQ(vibration.axis[1].rms_ripple, 0);
}

TEST(Motor, IntegrationHasConverged) {
  for (const double speed : {70.0, 300.0, 1000.0}) {
    MotorRun run = run_at(speed);
    const Vibration coarse = simulate_motors(pulses_along_x(50, 0.2), line_along_x(50), run);
    run.step /= 4;
    const Vibration fine = simulate_motors(pulses_along_x(50, 0.2), line_along_x(50), run);
    ASSERT_FALSE(coarse.lost_steps) << speed;
    EXPECT_NEAR(coarse.rms_ripple, fine.rms_ripple, 2e-3 * fine.rms_ripple) << speed;
    EXPECT_NEAR(coarse.largest_lag, fine.largest_lag, 5e-3) << speed;
  }
}

TEST(Motor, UnevenPulsesShakeItMore) {
  for (const double speed : {300.0, 600.0, 1000.0}) {
    const Vibration even = simulate_motors(pulses_along_x(100), line_along_x(100), run_at(speed));
    const Vibration uneven = simulate_motors(pulses_along_x(100, 0.4), line_along_x(100), run_at(speed));
    ASSERT_FALSE(even.lost_steps) << speed;
    EXPECT_GT(uneven.lost_steps ? 1e9 : uneven.rms_ripple, even.rms_ripple) << speed;
  }
}

TEST(Motor, HalfStepsRunSmoother) {
  MotorRun run = run_at(300);
  const Vibration full = simulate_motors(pulses_along_x(100), line_along_x(100), run);
  run.drive = Drive::kHalfStep;
  run.speed = 600;  // the same rotor speed
  const Vibration half = simulate_motors(pulses_along_x(200), line_along_x(200), run);
  EXPECT_LT(half.rms_ripple, full.rms_ripple);
}

TEST(Motor, LosesStepsBeyondItsTorque) {
  EXPECT_TRUE(simulate_motors(pulses_along_x(400), line_along_x(400), run_at(100000)).lost_steps);
  MotorRun overloaded = run_at(100);
  overloaded.motor.friction = 0.5;  // above the holding torque
  EXPECT_TRUE(simulate_motors(pulses_along_x(400), line_along_x(400), overloaded).lost_steps);
}

TEST(Motor, ConstantVelocityFromAStandstillIsHarder) {
  // The second paper starts at full speed. At some speeds the motor can run but not start.
  MotorRun run = run_at(1800);
  EXPECT_FALSE(simulate_motors(pulses_along_x(400), line_along_x(400), run).lost_steps);
  run.ramp_time = 0;
  EXPECT_TRUE(simulate_motors(pulses_along_x(400), line_along_x(400), run).lost_steps);
}

TEST(Motor, LostStretchesAreNeighbouringSpeeds) {
  std::vector<Vibration> sweep(6);
  for (const std::size_t i : {1U, 2U, 5U}) sweep[i].lost_steps = true;
  const auto ranges = lost_at({1, 2, 3, 4, 5, 6}, sweep);
  ASSERT_EQ(ranges.size(), 2U);
  EXPECT_EQ(ranges[0].first, 2);
  EXPECT_EQ(ranges[0].last, 3);
  EXPECT_EQ(ranges[1].first, 6);
  EXPECT_EQ(ranges[1].last, 6);
}

TEST(Motor, SweepIsLogarithmicWithFortySpeedsOrMore) {
  const std::vector<double> speeds = sweep_speeds();
  EXPECT_GE(speeds.size(), 40U);
  EXPECT_EQ(speeds.front(), 100);
  EXPECT_EQ(speeds.back(), 6400);
  for (std::size_t i = 1; i < speeds.size(); ++i) EXPECT_NEAR(speeds[i] / speeds[i - 1], 1.104, 0.006);
}

TEST(Motor, MirroredAxisVibratesAlike) {
  Trace trace;
  trace.clear(2, {});
  for (std::uint64_t i = 0; i < 50; ++i) trace.add(10 * i + 5, {1, -1});
  trace.finish(500);
  const Vibration vibration = simulate_motors(trace, IdealCurve::line(2, {}, {50, -50}), run_at(400));
  EXPECT_NEAR(vibration.axis[0].rms_ripple, vibration.axis[1].rms_ripple, 1e-6);
  EXPECT_NEAR(vibration.rms_ripple, std::sqrt(2.0) * vibration.axis[0].rms_ripple, 1e-6);
}

}  // namespace
}  // namespace trammel::measure
