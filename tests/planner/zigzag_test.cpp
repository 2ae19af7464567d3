// The least time of a zigzag, by closed forms, and the excess time of the S-curve planner.
//
// Each corner has a highest speed. The speed falls towards the corner and rises after it, so it is least at the corner
// and the acceleration along the path is 0 there. Therefore, in each segment, the fastest motion within the same limits
// is the fastest rise from the corner's speed and the fastest fall back to it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "plan.hpp"

namespace trammel::planner {
namespace {

// Limits along the path, in mm and seconds.
struct PathLimits {
  double speed, acceleration, jerk;

  double change_time(double from, double to) const {
    const double change = std::abs(to - from);
    const double rise = acceleration / jerk;
    return change >= acceleration * rise ? change / acceleration + rise : 2 * std::sqrt(change / jerk);
  }
  double change_length(double from, double to) const { return (from + to) / 2 * change_time(from, to); }

  // Least time from one speed to a peak and then to the other speed.
  double least_time(double length, double from, double to) const {
    double low = std::max(from, to);
    double high = speed;
    const auto needs = [&](double peak) { return change_length(from, peak) + change_length(peak, to); };
    if (needs(high) <= length) return change_time(from, high) + change_time(high, to) + (length - needs(high)) / high;
    for (int i = 0; i < 100; ++i) {
      const double middle = (low + high) / 2;
      (needs(middle) < length ? low : high) = middle;
    }
    return change_time(from, low) + change_time(low, to);
  }
};

constexpr unsigned kSegments = 40;
constexpr double kLastTick = 0.0025;  // s; saved by the last tick, which takes 1/3 of its time in the closed form
constexpr double kDegree = 3.14159265358979323846 / 180;

std::string zigzag(double degrees, double length) {
  const double up = length * std::sin(degrees / 2 * kDegree);
  const double across = length * std::cos(degrees / 2 * kDegree);
  std::string text = "G64 G1 F9000\n";
  for (unsigned i = 1; i <= kSegments; ++i) text += fmt::format("X{:.9f} Y{:.9f}\n", i % 2 * across, i * up);
  return text;
}

// Limits along the path, by the axis that limits most.
PathLimits limits_along(const machine::Machine& machine, double degrees) {
  const double most = std::max(std::sin(degrees / 2 * kDegree), std::cos(degrees / 2 * kDegree));
  const machine::MachineAxis& axis = machine.axes[0];
  return {9000.0 / 60, axis.max_acceleration / most, axis.max_jerk / most};
}

// Speed in a corner, from the jump of the velocity: X reverses there.
double corner_speed(const Plan& plan, double degrees) {
  return plan.blocks[kSegments / 2].planned.velocity_jump / (2 * std::cos(degrees / 2 * kDegree));
}

TEST(Zigzag, TakesHardlyMoreThanTheLeastTime) {
  double worst = -1;
  unsigned judged = 0;
  for (const double jerk : {20'000.0, 50'000.0, 500'000.0}) {
    machine::Machine machine = machine::default_machine();
    for (machine::MachineAxis& axis : machine.axes) {
      axis.max_jerk = jerk;
      axis.max_velocity = 300;
    }
    for (const double degrees : {30.0, 60.0, 90.0, 150.0}) {
      for (const double length : {0.2, 1.0, 5.0, 20.0}) {
        const Plan plan = plan_text(zigzag(degrees, length), machine, kCard);
        ASSERT_FALSE(plan.error);
        const double corner = corner_speed(plan, degrees);
        const PathLimits limits = limits_along(machine, degrees);
        // In longer ramps the first corners would be passed at lower speeds.
        if (limits.change_length(0, corner) > length) continue;
        ++judged;
        const double least = limits.least_time(length, 0, corner) + limits.least_time(length, corner, 0) +
                             (kSegments - 2) * limits.least_time(length, corner, corner);
        double planned = 0;
        for (const Planned& block : plan.blocks) planned += block.planned.seconds;
        worst = std::max(worst, planned / least - 1);
        EXPECT_GT(planned, least - kLastTick) << jerk << ' ' << degrees << ' ' << length;
      }
    }
  }
  RecordProperty("worst_percent", fmt::format("{:.3f}", 100 * worst));
  EXPECT_LT(worst, 1e-4);
  EXPECT_EQ(judged, 46U);
}

}  // namespace
}  // namespace trammel::planner
