// Sections of a machine file other than the axes: outputs, tools, probe; also homes and coordinate systems.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "machine_texts.hpp"
#include "trammel/card_map.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::machine {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(MachineFile, Outputs) {
  EXPECT_EQ(default_machine().outputs.all(), 0) << "none by default";
  const std::string text = default_machine_text() + "[outputs]\nm3 = 0\nm4 = [0, 15]\nm8 = []\n";
  const MachineOutputs outputs = parse_machine(text, "m.toml").outputs;
  EXPECT_EQ(outputs.m3, 1);
  EXPECT_EQ(outputs.m4, 0x8001);
  EXPECT_EQ(outputs.coolant(), 0);
  Machine machine = parse_machine(text, "m.toml");
  apply_override(machine, "outputs.m4=2");
  EXPECT_EQ(machine.outputs.all(), 5) << "instead of what it had";
  apply_override(machine, "outputs.m3=[]");
  EXPECT_EQ(machine.outputs.all(), 4);

  const auto error = [](const std::string& entry) { return error_of(default_machine_text() + "[outputs]\n" + entry); };
  for (const char* value : {"16", "-1", "1.0", "true", "\"0\"", "[0, 16]", "[[0]]"}) {
    EXPECT_THAT(error(std::string("m7 = ") + value), HasSubstr("outputs.m7 must be an output's number, 0 to 15"))
        << value;
  }
  EXPECT_THAT(error("m5 = 1"), HasSubstr("unknown entry outputs.m5"));
  EXPECT_THAT(error("m3 = 1\nm7 = 1"), HasSubstr("output 1 is named for the spindle (m3, m4) and for coolant"));
  EXPECT_THAT(error("m3 = 1\np4 = 1"),
              HasSubstr("output 1 is named for the spindle or for coolant and for M62 to M65"));
  EXPECT_THAT(error("p16 = 1"), HasSubstr("unknown entry outputs.p16"));
  EXPECT_EQ(parse_machine(default_machine_text() + "[outputs]\np0 = 7\np15 = [0, 7]\n", "m").outputs.numbered[15], 129);
  EXPECT_THAT(override_error("outputs.m9=1"), HasSubstr("unknown entry outputs.m9"));
}

TEST(MachineFile, OutputsThatTheCardSwitches) {
  EXPECT_EQ(default_machine().outputs.roles(), 0) << "none by default";
  const std::string text = default_machine_text() +
                           "[outputs]\nm3 = 0\noff_at_rest = 0\noff_at_cause = [1]\nenable = 2\nbrake = 3\n"
                           "charge_pump = 4\nhealthy = 5\nenable_delay_ms = 12.5\nenable_idle_s = 60\n"
                           "disable_on = [\"drive_fault\", \"watchdog\"]\n";
  const MachineOutputs outputs = parse_machine(text, "m.toml").outputs;
  EXPECT_EQ(outputs.off_at_cause, 2);
  EXPECT_EQ(outputs.roles(), 0x3C);
  EXPECT_EQ(outputs.of_words(), 1);
  EXPECT_EQ(outputs.all(), 0x3F);
  EXPECT_EQ(outputs.enable_delay_ms, 12.5);
  EXPECT_EQ(outputs.disable_on, card_map::field::kFaultDriveFault | card_map::field::kFaultWatchdog);

  const auto error = [](const std::string& entry) { return error_of(default_machine_text() + "[outputs]\n" + entry); };
  EXPECT_THAT(error("brake_set_ms = 2681"), HasSubstr("2680 ms"));
  EXPECT_THAT(error("enable_idle_s = -1"), HasSubstr("680 s"));
  EXPECT_THAT(error("charge_pump_hz = 5"), HasSubstr("Hz"));
  EXPECT_THAT(error("disable_on = \"limit\""), HasSubstr("outputs.disable_on must be a list of limit, emergency_stop"));
  EXPECT_THAT(error("disable_on = [\"limits\"]"), HasSubstr("must be a list of limit"));
  EXPECT_THAT(error("m3 = 1\nenable = 1"), HasSubstr("output 1 is named for the drives or the card"));
  EXPECT_THAT(error("enable = 1\nbrake = 1"), HasSubstr("output 1 is named for enable and for brake"));
  EXPECT_THAT(error("brake = 1\nhealthy = 1"), HasSubstr("output 1 is named for the drives"));
}

std::string with_outputs(const std::string& entries) { return defaults() + "\n[outputs]\n" + entries; }
// Beginning of the message about the n-th entry of [outputs].
std::string line_of_output(int n) {
  return "m.toml:" + std::to_string(std::count(defaults().begin(), defaults().end(), '\n') + 2 + n) + ": outputs.";
}

TEST(MachineFile, SafeLevelsOtherThanZero) {
  const MachineOutputs outputs =
      parse_machine(with_outputs("on_at_cause = [1, 2]\noff_at_cause = 0\non_at_rest = 3\noff_at_rest = 1\n"), "m.toml")
          .outputs;
  EXPECT_EQ(outputs.on_at_cause, 6);
  EXPECT_EQ(outputs.safe_at_cause(), 7);
  EXPECT_EQ(outputs.on_at_rest, 8);
  EXPECT_EQ(outputs.safe_at_rest(), 10) << "another level than at the cause";
  EXPECT_EQ(outputs.all(), 15);
  EXPECT_THAT(error_of(with_outputs("m3 = 1\non_at_rest = 16\n")),
              StartsWith(line_of_output(2) + "on_at_rest must be an output's number, 0 to 15"));
  EXPECT_THAT(error_of(with_outputs("off_at_rest = [0, 4]\non_at_rest = 4\n")),
              StartsWith(line_of_output(2) + "on_at_rest: output 4 is named by off_at_rest too, and goes to one level: "
                                             "take it out of one of them"));
  EXPECT_THAT(error_of(with_outputs("on_at_cause = 0\noff_at_cause = 0\n")),
              StartsWith(line_of_output(1) + "on_at_cause: output 0 is named by off_at_cause too"));
  EXPECT_THAT(error_of(with_outputs("enable = 1\non_at_cause = 1\n")), HasSubstr("output 1 is named for the drives"));
  Machine machine = parse_machine(with_outputs("on_at_rest = 4\n"), "m.toml");
  try {
    apply_override(machine, "outputs.off_at_rest=4");
    ADD_FAILURE();
  } catch (const MachineError& error) {
    EXPECT_THAT(error.what(), StartsWith("--set outputs.off_at_rest=4: outputs.on_at_rest: output 4"));
  }
}

TEST(MachineFile, EnableByHandAndItsAxes) {
  EXPECT_FALSE(default_machine().outputs.enable_manual);
  EXPECT_EQ(default_machine().outputs.enable_axes, "");
  const MachineOutputs outputs =
      parse_machine(with_outputs("enable_manual = true\nenable_axes = [\"z\", \"x\"]\nbrake = 2\n"), "m.toml").outputs;
  EXPECT_TRUE(outputs.enable_manual);
  EXPECT_EQ(outputs.enable_axes, "XZ");
  EXPECT_THAT(error_of(with_outputs("enable = 1\nenable_manual = 1\n")),
              StartsWith(line_of_output(2) + "enable_manual must be true or false"));
  const std::string known =
      "enable_axes must be a list of axes of the machine: \"x\", \"y\", \"z\", \"e\"; leave it out "
      "for all of them";
  for (const char* value :
       {"\"x\"", "[]", "[\"w\"]", "[\"X\"]", "[\"x\", 1]", "[\"xy\"]", "[\"x\", \"xy\"]", "[\"x\", \"X\"]", "[\"\"]"}) {
    EXPECT_THAT(error_of(with_outputs(std::string("enable = 1\nenable_axes = ") + value)),
                StartsWith(line_of_output(2) + known))
        << value;
  }
  EXPECT_THAT(error_of(with_outputs("healthy = 1\nenable_manual = true\n")),
              StartsWith(line_of_output(2) + "enable_manual: no output is named for enable or brake: name one, or take "
                                             "this entry out"));
  EXPECT_THAT(error_of(with_outputs("enable_axes = [\"x\"]\n")),
              StartsWith(line_of_output(1) + "enable_axes: no output is named for enable or brake"));
}

TEST(MachineFile, ReactionToTheEmergencyStop) {
  EXPECT_FALSE(default_machine().outputs.emergency_stop_ramps) << "as the card has it";
  const auto reaction = [](const std::string& word) {
    return parse_machine(with_outputs("on_emergency_stop = \"" + word + "\"\n"), "m.toml").outputs.emergency_stop_ramps;
  };
  EXPECT_EQ(reaction("ramp"), true);
  EXPECT_EQ(reaction("immediate"), false);
  EXPECT_THAT(error_of(with_outputs("on_emergency_stop = \"nothing\"\n")),
              StartsWith(line_of_output(1) + "on_emergency_stop must be \"ramp\" or \"immediate\""));
  EXPECT_THAT(error_of(with_outputs("on_emergency_stop = true\n")), HasSubstr("must be \"ramp\" or \"immediate\""));
  EXPECT_THAT(
      error_of(with_outputs("m3 = 3\nenable = 1\non_emergency_stop = \"ramp\"\n")),
      StartsWith(line_of_output(3) + "on_emergency_stop: no ramp can be made, since the card disables the drives "
                                     "of enable and brake at once: choose \"immediate\", or take enable and "
                                     "brake out"));
  EXPECT_EQ(error_of(with_outputs("enable = 1\non_emergency_stop = \"immediate\"\n")), "no error");
}

TEST(MachineFile, Tools) {
  EXPECT_TRUE(default_machine().tools.empty());
  Machine machine = parse_machine(default_machine_text() + "[tools.2]\nz = 42.5\nx = -1\n[tools.31]\n", "m.toml");
  ASSERT_EQ(machine.tools.size(), 2U);
  ASSERT_NE(machine.tool(2), nullptr);
  EXPECT_EQ(machine.tool(2)->offsets[0], -1);
  EXPECT_EQ(machine.tool(2)->offsets[2], 42.5);
  EXPECT_EQ(machine.tool(31)->offsets[2], 0);
  EXPECT_EQ(machine.tool(3), nullptr);
  apply_override(machine, "tools.2.z=40");
  apply_override(machine, "tools.3.e=1");
  EXPECT_EQ(machine.tool(2)->offsets[2], 40);
  EXPECT_EQ(machine.tool(2)->offsets[0], -1) << "the rest stays";
  EXPECT_EQ(machine.tool(3)->offsets[3], 1);
  EXPECT_THAT(override_error("tools.0.z=1"), HasSubstr("[tools.0]: a tool has a number from 1 to 999999"));
  EXPECT_THAT(override_error("tools.drill.z=1"), HasSubstr("[tools.drill]: a tool has a number"));
  EXPECT_THAT(override_error("tools.1.a=1"), HasSubstr("unknown entry tools.1.a"));
  EXPECT_THAT(override_error("tools.1=1"), HasSubstr("tools.1 must be a table"));
  EXPECT_THAT(override_error("tools.1.z=true"), HasSubstr("tools.1.z must be a number"));
}

TEST(MachineFile, Probe) {
  EXPECT_FALSE(default_machine().probe.input);
  Machine machine = parse_machine(default_machine_text() + "[probe]\ninput = 3\ntouched_level = 0\n", "m.toml");
  EXPECT_EQ(machine.probe.input, 3U);
  EXPECT_FALSE(machine.probe.touched_level);
  apply_override(machine, "probe.touched_level=1");
  EXPECT_TRUE(machine.probe.touched_level);
  EXPECT_THAT(override_error("probe.input=32"), HasSubstr("probe.input must be an input's number, 0 to 31"));
  EXPECT_THAT(override_error("probe.touched_level=2"), HasSubstr("probe.touched_level must be 0 or 1"));
  EXPECT_THAT(override_error("probe.pin=2"), HasSubstr("unknown entry probe.pin"));
}

TEST(MachineFile, HomesAndNineCoordinateSystems) {
  Machine machine = default_machine();
  apply_override(machine, "axis.x.second_home=7");
  apply_override(machine, "axis.x.g59_3=9");
  EXPECT_EQ(machine.axes[0].second_home, 7);
  EXPECT_EQ(machine.axes[0].offsets[8], 9);
  EXPECT_THAT(override_error("axis.x.g59_4=9"), HasSubstr("did you mean g59_"));
}

}  // namespace
}  // namespace trammel::machine
