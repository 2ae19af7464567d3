// Results, messages and refusals of `trammel calibrate`.
#include "calibrate/calibration.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "common/errors.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::test {
namespace {

using ::testing::HasSubstr;

const std::string kMachineFile =
    "[card]\nclock_hz = 64e6\n[axis.x]\nsteps_per_mm = 80 # 20 teeth\nmax_velocity = 100\nmax_acceleration = 500\n"
    "step_length_ns = 2000\nstep_space_ns = 2000\ndirection_setup_ns = 1000\ndirection_hold_ns = 1000\ninverted = "
    "false\n"
    "[axis.y]\nsteps_per_mm = 100\nmax_velocity = 100\nmax_acceleration = 500\nstep_length_ns = 2000\n"
    "step_space_ns = 2000\ndirection_setup_ns = 1000\ndirection_hold_ns = 1000\ninverted = false\n";

std::string refusal(const app::Measured& measured) {
  try {
    app::calibrate(measured, kMachineFile, "m.toml");
  } catch (const app::UsageError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Calibration, TellsTheNewScaleByHowMuchAndTheLine) {
  const app::Calibration result = app::calibrate({"x", 100, 99.2, false}, kMachineFile, "m.toml");
  EXPECT_EQ(result.said,
            "X: 100 mm commanded, 99.2 mm measured, -0.8 %\n"
            "X: steps_per_mm 80 -> 80.64516 (+0.806 %)\n"
            "m.toml:4: steps_per_mm = 80.64516 # 20 teeth\n");
  EXPECT_TRUE(result.changed);
  EXPECT_EQ(result.doubt, "");
  EXPECT_EQ(machine::parse_machine(result.text, "m.toml").axes[0].steps_per_mm, 80.64516);
  EXPECT_EQ(machine::parse_machine(result.text, "m.toml").axes[1].steps_per_mm, 100);
}

// After the change the same command moves the axis by the right distance: pulses / true scale.
TEST(Calibration, ASecondMeasurementIsRight) {
  const double true_scale = 80 * 100 / 99.2;
  const app::Calibration first = app::calibrate({"X", 100, 100 * 80 / true_scale, false}, kMachineFile, "m.toml");
  const double moves = 100 * machine::parse_machine(first.text, "m.toml").axes[0].steps_per_mm / true_scale;
  EXPECT_NEAR(moves, 100, 1e-5);
  const app::Calibration second = app::calibrate({"X", 100, 100, false}, first.text, "m.toml");
  EXPECT_FALSE(second.changed);
  EXPECT_EQ(second.text, first.text);
  EXPECT_THAT(second.said, HasSubstr("steps_per_mm is right as it is\n"));
}

TEST(Calibration, RefusesDistancesThatTellNothing) {
  EXPECT_THAT(refusal({"W", 100, 99, false}), HasSubstr("the machine has no axis W"));
  EXPECT_THAT(refusal({"XY", 100, 99, false}), HasSubstr("the machine has no axis XY"));
  EXPECT_THAT(refusal({"", 100, 99, false}), HasSubstr("the machine has no axis "));
  const double infinite = std::numeric_limits<double>::infinity();
  for (const auto& [commanded, measured] : {std::pair{0., 99.},
                                            {100., 0.},
                                            {0., 0.},
                                            {infinite, 1.},
                                            {1., infinite},
                                            {infinite, infinite},
                                            {1., std::nan("")}})
    EXPECT_THAT(refusal({"X", commanded, measured, true}), HasSubstr("must be distances other than 0")) << commanded;
  EXPECT_THAT(refusal({"Y", 100, -99, true}),
              HasSubstr("Y moved in the opposite direction. Change `inverted` in [axis.y]"));
}

TEST(Calibration, AWholeFactorNeedsForce) {
  EXPECT_THAT(refusal({"X", 100, 201, false}), HasSubstr("X moved 2.01 times as far as commanded, outside 0.5 to 2"));
  EXPECT_THAT(refusal({"X", 100, 49, false}), HasSubstr("X moved 0.49 times as far"));
  EXPECT_EQ(refusal({"X", 100, 200, false}), "no error");
  EXPECT_EQ(refusal({"X", 100, 50, false}), "no error");
  EXPECT_EQ(refusal({"X", 100, 25.4, true}), "no error");
  // --force does not allow a value that no machine file may have.
  EXPECT_THROW(app::calibrate({"X", 100, 1e-4, true}, kMachineFile, "m.toml"), machine::MachineError);
}

TEST(Calibration, BothMotorsOfCrossedBelts) {
  const std::string belts = kMachineFile + "[kinematics]\nname = \"corexy\"\n";
  const app::Calibration result = app::calibrate({"Y", 100, 80, false}, belts, "m.toml");
  const machine::Machine machine = machine::parse_machine(result.text, "m.toml");
  EXPECT_EQ(machine.axes[0].steps_per_mm, 100);
  EXPECT_EQ(machine.axes[1].steps_per_mm, 125);
  EXPECT_THAT(result.said, HasSubstr("\nX: steps_per_mm 80 -> 100 (+25 %)\n"));
  EXPECT_THAT(result.said, HasSubstr("\nY: steps_per_mm 100 -> 125 (+25 %)\n"));
}

TEST(Calibration, NamesPlacesThatWereMeasuredBefore) {
  std::string text = kMachineFile;
  text.insert(text.find("[axis.y]"), "min = 0\nmax = 300\n");
  EXPECT_THAT(app::calibrate({"X", 100, 99, false}, text, "m.toml").doubt,
              HasSubstr("min and max of axis X were not changed"));
  EXPECT_EQ(app::calibrate({"Y", 100, 99, false}, text, "m.toml").doubt, "");
  text += "[inputs]\nx_home = 0\n[homing.x]\nsearch_velocity = -10\n";
  EXPECT_THAT(app::calibrate({"X", 100, 99, false}, text, "m.toml").doubt,
              HasSubstr("min and max and [homing] distances of axis X were not changed"));
}

}  // namespace
}  // namespace trammel::test
