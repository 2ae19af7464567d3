// A machine with crossed belts (CoreXY) on the model's card. The test converts motor pulses to coordinates by its own
// inverse.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "steps.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/run/jog.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::run {
namespace {

constexpr double kSteps = 80;  // pulses per mm of belt
constexpr std::uint32_t kClock = 1'000'000;

struct Place {
  double x;
  double y;
};

class CoreXyRun : public ::testing::Test {
 protected:
  CoreXyRun() {
    machine::apply_override(machine_, "kinematics.name='corexy'");
    power_up();
  }
  Outcome run(const std::string& text, const RunSettings& settings = {}) {
    const auto shared = std::make_shared<const std::string>(text);
    Runner runner([shared] { return std::make_unique<gcode::TextLines>(*shared, "p.ngc"); }, machine_,
                  planner::limits_of(card_->identification()), settings);
    plan_ = runner.plan();
    return runner.run(*card_);
  }
  void power_up() {
    engine_ = sim::make_model_engine(sim::EngineOptions{4, kClock, false});
    steps_ = {};
    engine_->set_sink(&steps_);
    card_.emplace(driver::Card::open(*engine_));
  }
  // Positions after each tick of the path in which an axis stepped.
  std::vector<Place> places() const {
    std::vector<Place> result;
    double a = 0;
    double b = 0;
    for (std::size_t i = 0; i < steps_.path.size(); ++i) {
      const driver::PathStep& step = steps_.path[i];
      (step.axis == 0 ? a : b) += step.axis < 2 ? step.direction : 0;
      const bool last = i + 1 == steps_.path.size() || steps_.path[i + 1].command != step.command ||
                        steps_.path[i + 1].tick != step.tick;
      if (last) result.push_back({(a + b) / 2 / kSteps, (a - b) / 2 / kSteps});
    }
    return result;
  }

  machine::Machine machine_ = machine::default_machine();
  std::unique_ptr<sim::Engine> engine_;
  std::optional<driver::Card> card_;
  test::Steps steps_;
  Plan plan_;
};

TEST_F(CoreXyRun, LinesEndWhereTheProgramSays) {
  const Outcome outcome = run("G1 X10 F900\nY5\nX3 Y-4 Z1\nX3 Y-4 E2\n");
  EXPECT_EQ(outcome.counted, (std::vector<std::int64_t>{-80, 560, 80, 160}));
  EXPECT_EQ(outcome.final_position, outcome.counted);
  EXPECT_EQ(outcome.final_coordinates[0], 3);
  EXPECT_EQ(outcome.final_coordinates[1], -4);
}

TEST_F(CoreXyRun, ALineStaysStraight) {
  run("G1 X10 Y4 F900\n");
  const double length = std::hypot(10, 4);
  for (const Place& at : places()) {
    // An error of sqrt(2) / 2 pulses in the joints is half a pulse of belt in the plane, in any direction.
    EXPECT_LE(std::abs(at.x * 4 - at.y * 10) / length, 0.51 / kSteps);
  }
}

// Each method of making an arc, in both directions: no point is off the circle by more than a pulse of belt, and the
// end is exact.
TEST_F(CoreXyRun, ArcsKeepTheirCircle) {
  for (const planner::ArcsBy by :
       {planner::ArcsBy::kGenerator, planner::ArcsBy::kAccumulator, planner::ArcsBy::kChords}) {
    for (const char* turn : {"G2", "G3"}) {
      power_up();
      RunSettings settings;
      settings.arcs = by;
      const Outcome outcome = run(std::string(turn) + " X5 Y5 I5 J0 F1200\n", settings);
      EXPECT_EQ(outcome.final_coordinates[0], 5);
      EXPECT_EQ(outcome.final_coordinates[1], 5);
      double lowest = 9;
      for (const Place& at : places()) {
        EXPECT_NEAR(std::hypot(at.x - 5, at.y), 5, 1.1 / kSteps);
        lowest = std::min(lowest, at.y);
      }
      // From the left end of the circle, G2 goes up first and G3 goes down first.
      EXPECT_EQ(lowest < -4, turn[1] == '3') << turn;
    }
  }
}

TEST_F(CoreXyRun, MotorLimitsBecomeLimitsAlongThePath) {
  // Along the diagonal, motor A moves sqrt(2) mm of belt per mm of path, and motor B does not move.
  machine::apply_override(machine_, "kinematics.motor_velocity=50");
  run("G1 X70.71067811865476 Y70.71067811865476 F9000\n");
  const double cruise = 100 / (50 / std::sqrt(2.0));
  EXPECT_GT(plan_.seconds, cruise);
  EXPECT_LT(plan_.seconds, cruise * 1.05);
}

TEST_F(CoreXyRun, JogsInTheAxesDirections) {
  MachinePosition position(card_->read_snapshot(), machine_);
  configure(*card_, machine_);
  Jog jog(*card_, machine_, position);
  jog.start({0, 2}, 20);
  jog.wait();
  EXPECT_EQ(position.pulses()[0], 160);
  EXPECT_EQ(position.pulses()[1], -160);
  EXPECT_EQ(position.millimetres()[1], 2);
  position.set(0, 7);
  EXPECT_EQ(position.millimetres()[0], 7);
  EXPECT_EQ(position.millimetres()[1], 2);
}

}  // namespace
}  // namespace trammel::run
