// [inputs] of a machine file: roles, polarities, filters, and how limits stop.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "machine_texts.hpp"
#include "trammel/driver/roles.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::machine {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string with_inputs(const std::string& entries) { return defaults() + "\n[inputs]\n" + entries; }

using driver::AxisRole;
using driver::CardRole;
using driver::Role;

const InputRole& role_of(const Machine& machine, Role role) { return machine.inputs.roles[role.number()]; }

TEST(Inputs, ADefaultMachineHasNone) {
  EXPECT_EQ(default_machine().inputs.used(), 0U);
  EXPECT_EQ(default_machine().inputs.inverted(), 0U);
}

TEST(Inputs, RolesPolaritiesAndFilters) {
  const Machine machine = parse_machine(
      with_inputs("x_limit_minus = 0\ny_limit = [1, 2]\nx_home = {input = 3, filter = 4.5}\nfeed_hold = 31\n"
                  "z_limit_plus = {input = 5, normally = \"open\"}\nfilter = 2\n"),
      "m.toml");
  EXPECT_EQ(role_of(machine, {AxisRole::kLimitMinus, 0}).inputs, 1U);
  EXPECT_EQ(role_of(machine, {AxisRole::kLimitMinus, 1}).inputs, 6U);
  EXPECT_EQ(role_of(machine, {AxisRole::kLimitPlus, 1}).inputs, 6U);
  EXPECT_EQ(role_of(machine, {AxisRole::kHome, 0}).inputs, 8U);
  EXPECT_EQ(role_of(machine, CardRole::kFeedHold).inputs, 1U << 31);
  EXPECT_EQ(machine.inputs.used(), 0x8000002FU);
  // With a pull-up an open switch reads 1. Limit switches are normally closed, so that a broken wire stops the machine.
  EXPECT_EQ(machine.inputs.inverted(), 0x80000028U);
  EXPECT_EQ(machine.inputs.filter_of(3), 4.5);
  EXPECT_EQ(machine.inputs.filter_of(0), 2);
  Machine other = machine;
  apply_override(other, "inputs.closed_level=1");
  EXPECT_EQ(other.inputs.inverted(), 0x00000007U);
  // y_home shares input 1 with a limit and declares it normally open; that polarity then applies to the input.
  apply_override(other, "inputs.y_home={input=1, normally=\"open\"}");
  EXPECT_EQ(other.inputs.inverted(), 0x00000005U);
}

TEST(Inputs, WrongEntriesAreNamedByFileAndLine) {
  const auto line = std::to_string(std::count(defaults().begin(), defaults().end(), '\n') + 3);
  const auto error = [&](const std::string& entry) { return error_of(with_inputs(entry)); };
  const std::string at = "m.toml:" + line + ": ";
  EXPECT_THAT(error("x_limit_minus = 32\n"),
              StartsWith(at + "inputs.x_limit_minus must be an input's number, 0 to 31"));
  EXPECT_THAT(error("x_limit_minsu = 1\n"), StartsWith(at + "unknown entry inputs.x_limit_minsu"));
  EXPECT_THAT(error("w_home = 1\n"), StartsWith(at + "unknown entry inputs.w_home"));
  EXPECT_THAT(error("filter = 21\n"), HasSubstr(at));
  EXPECT_THAT(error("on_limit = 3\n"), StartsWith(at + "inputs.on_limit must be"));
  EXPECT_THAT(error("on_soft_limit = \"nothing\"\n"),
              StartsWith(at + "inputs.on_soft_limit must be \"ramp\" or \"immediate\""));
  EXPECT_THAT(error("on_soft_limits = \"ramp\"\n"),
              StartsWith(at + "unknown entry inputs.on_soft_limits; did you mean on_soft_limit?"));
  EXPECT_THAT(error("closed_level = 2\n"), StartsWith(at + "inputs.closed_level must be 0 or 1"));
  EXPECT_THAT(error("x_home = {normally = \"open\"}\n"), StartsWith(at + "inputs.x_home names no input"));
  EXPECT_THAT(error("x_home = {input = 1, normaly = \"open\"}\n"), StartsWith(at + "unknown entry"));
  EXPECT_THAT(error("x_home = {input = 1, normally = \"open\"}\ny_home = {input = 1, normally = \"closed\"}\n"),
              HasSubstr("input 1 is normally open for one of its roles and closed for another"));
}

TEST(Inputs, SoftLimitsStopOnARampUnlessToldOtherwise) {
  EXPECT_EQ(default_machine().inputs.on_soft_limit, OnInput::kRamp);
  const Machine machine = parse_machine(with_inputs("on_soft_limit = \"immediate\"\n"), "m.toml");
  EXPECT_EQ(machine.inputs.on_soft_limit, OnInput::kImmediate);
  EXPECT_EQ(machine.inputs.used(), 0U) << "it needs no input";
  Machine other = machine;
  apply_override(other, "inputs.on_soft_limit='ramp'");
  EXPECT_EQ(other.inputs.on_soft_limit, OnInput::kRamp);
}

// X at 150 mm/s. A hold uses half of the acceleration and takes T = 0.3 s. The filter takes 1 ms, and the scan of the
// inputs 64 clocks.
TEST(Inputs, ARampNeedsTheOvertravelThatItTakes) {
  EXPECT_EQ(hold_seconds(default_machine()), 0.3);
  const double way = 150 * (0.001 + 64e-8 + 0.15);
  const auto with = [&](double overtravel, const std::string& more) {
    return replaced(with_inputs("x_limit = 0\n" + more), "steps_per_mm = 80",
                    "overtravel = " + std::to_string(overtravel) + "\nsteps_per_mm = 80");
  };
  const LimitStop short_one = limit_stop(parse_machine(with(way - 0.01, ""), "m.toml"));
  EXPECT_FALSE(short_one.ramps);
  const LimitStop long_one = limit_stop(parse_machine(with(way + 0.01, ""), "m.toml"));
  EXPECT_TRUE(long_one.ramps);
  EXPECT_EQ(long_one.overtravel[0], static_cast<unsigned>((way + 0.01 - 150 * (0.001 + 64e-8)) * 80));
  EXPECT_FALSE(limit_stop(parse_machine(with(way + 0.01, "on_limit = \"immediate\"\n"), "m.toml")).ramps);
  EXPECT_THAT(error_of(with(way - 0.01, "on_limit = \"ramp\"\n")),
              HasSubstr("inputs.on_limit: axis X: a ramp needs 22.7 mm behind the switch"));
  EXPECT_EQ(error_of(with(way + 0.01, "on_limit = \"ramp\"\n")), "no error");
}

}  // namespace
}  // namespace trammel::machine
