// Bounds of the numbers in a machine file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "machine_texts.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::machine {
namespace {

using ::testing::HasSubstr;

// Each number is accepted at its bounds. Beyond them it is refused with its name, bounds and unit.
TEST(MachineBounds, EveryNumberOfAnAxisHasThem) {
  struct Bound {
    const char* entry;
    const char* least;
    const char* most;
    const char* below;
    const char* above;
  };
  for (const Bound& bound : std::initializer_list<Bound>{
           {"steps_per_mm", "0.001", "1e6", "1e-300", "1.1e6"},
           {"max_acceleration", "0.15", "1e9", "1e-300", "1.1e9"},
           {"max_jerk", "1", "1e13", "1e-300", "1.1e13"},
           {"step_length_ns", "0.001", "2000", "1e-300", "1e300"},
           {"direction_setup_ns", "0.0", "2000", "-1e-300", "1e300"},
           {"min", "-2e12", "0", "-1e300", "1e300"},
           {"home", "-2e12", "2e12", "-1e300", "1e300"},
           {"g54", "-2e12", "2e12", "-1e300", "1e300"},
       }) {
    const std::string set = std::string("axis.x.") + bound.entry + "=";
    EXPECT_EQ(override_error(set + bound.least), "no error") << bound.entry;
    EXPECT_EQ(override_error(set + bound.most), "no error") << bound.entry;
    for (const char* beyond : {bound.below, bound.above}) {
      EXPECT_THAT(override_error(set + beyond), HasSubstr(std::string("axis.x.") + bound.entry + " must be from "));
    }
  }
  EXPECT_THAT(override_error("axis.x.max_velocity=1e-300"), HasSubstr("must be from 0.001 to 1e+07 mm/s, not 1e-300"));
}

TEST(MachineBounds, ARampThatTakesLongerThanAnyMachineIsASlip) {
  EXPECT_EQ(override_error("axis.x.max_acceleration=0.14"),
            "--set axis.x.max_acceleration=0.14: axis X: max_velocity is reached after 1071.43 s; at most 1000 s are "
            "possible, which is the card's longest ramp at 1 MHz: is max_acceleration in mm/s^2?");
  EXPECT_EQ(override_error("axis.x.max_jerk=0.9"),
            "--set axis.x.max_jerk=0.9: axis X: max_acceleration is reached after 1111.11 s; at most 1000 s are "
            "possible, which is the card's longest ramp at 1 MHz: is max_jerk in mm/s^3?");
}

TEST(MachineBounds, ARampOfCoreXyMotorsIsHeldAgainstTheSameBound) {
  EXPECT_EQ(
      error_of(defaults() + "\n[kinematics]\nname = \"corexy\"\nmotor_acceleration = 0.14\n"),
      "m.toml:1: axis X with the limits of kinematics: max_velocity is reached after 1071.43 s; at most 1000 s are "
      "possible, which is the card's longest ramp at 1 MHz: is max_acceleration in mm/s^2?");
}

}  // namespace
}  // namespace trammel::machine
