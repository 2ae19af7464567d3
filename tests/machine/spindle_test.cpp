// The table [spindle] of a machine file.
#include <gtest/gtest.h>

#include <string>

#include "trammel/machine/machine.hpp"

namespace trammel::machine {
namespace {

std::string spindle_refusal(const std::string& one, const std::string& two = "") {
  Machine machine = default_machine();
  try {
    apply_override(machine, one);
    if (!two.empty()) apply_override(machine, two);
  } catch (const MachineError& error) {
    return error.what();
  }
  return "";
}

TEST(Spindle, IsReadAndServesM3AndM4) {
  Machine machine = default_machine();
  EXPECT_EQ(machine.outputs.pwm, 0);
  apply_override(machine, "spindle.output=3");
  apply_override(machine, "spindle.pwm_hz=25000");
  apply_override(machine, "spindle.max_s=24000");
  apply_override(machine, "spindle.spin_up_s=4");
  EXPECT_EQ(machine.outputs.at_speed_s, 30);
  apply_override(machine, "spindle.at_speed_s=7");
  EXPECT_EQ(machine.outputs.pwm, 8);
  EXPECT_EQ(machine.outputs.spindle(), 8);
  EXPECT_EQ(machine.outputs.pwm_hz, 25000);
  EXPECT_EQ(machine.outputs.max_s, 24000);
  EXPECT_EQ(machine.outputs.spin_up_s, 4);
  EXPECT_EQ(machine.outputs.at_speed_s, 7);
  EXPECT_FALSE(machine.outputs.laser);
  EXPECT_EQ(machine.outputs.safe_at_cause(), 0);
}

TEST(Spindle, ALaserIsOffAtTheCauseOfAStop) {
  Machine machine = default_machine();
  apply_override(machine, "spindle.output=3");
  apply_override(machine, "spindle.laser=true");
  EXPECT_EQ(machine.outputs.safe_at_cause(), 8);
  EXPECT_EQ(machine.outputs.on_at_cause, 0);
}

TEST(Spindle, WhatIsWrongIsSaid) {
  EXPECT_NE(spindle_refusal("spindle.output=16").find("spindle.output"), std::string::npos);
  EXPECT_NE(spindle_refusal("spindle.pwm_hz=10").find("spindle.output is missing"), std::string::npos);
  EXPECT_NE(spindle_refusal("spindle.output=1", "spindle.pwm_hz=2e6").find("spindle.pwm_hz"), std::string::npos);
  EXPECT_NE(spindle_refusal("spindle.output=1", "spindle.speed=2").find("spindle.speed"), std::string::npos);
  EXPECT_NE(spindle_refusal("spindle.output=1", "outputs.m8=1").find("coolant"), std::string::npos);
}

}  // namespace
}  // namespace trammel::machine
