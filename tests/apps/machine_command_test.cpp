// `trammel machine --check`: the distances that stops take, and the axis that prevents limit switches from using a
// ramp.
#include "machine/machine_command.hpp"

#include <gmock/gmock.h>

#include "trammel/machine/machine.hpp"

namespace trammel::test {
namespace {

using ::testing::HasSubstr;

machine::Machine machine_of(const std::string& inputs, const std::string& x, const std::string& a) {
  const std::string axis =
      "steps_per_mm = 80\nmax_velocity = 100\nmax_acceleration = 500\nstep_length_ns = 2000\nstep_space_ns = 2000\n"
      "direction_setup_ns = 1000\ndirection_hold_ns = 1000\ninverted = false\n";
  return machine::parse_machine(
      "[card]\nclock_hz = 64e6\n[axis.x]\n" + axis + x + "[axis.a]\n" + axis + a + "[inputs]\n" + inputs, "m.toml");
}

// v = 100 mm/s and T = 2 * 100 / 500 = 0.4 s give a ramp of 20 mm. A filter of 2 ms and a scan of 64 clocks give 0.2001
// mm.
TEST(MachineCheck, TellsEachWay) {
  const auto machine =
      machine_of("x_limit_plus = 0\nfilter = 2\n", "overtravel = 25\nmin = 0\nmax = 300\n", "endless = true\n");
  EXPECT_EQ(app::stop_text(machine),
            "T = 0.4 s from full speed to rest, for all axes\n"
            "axis X: stops from 100 mm/s in v * T/2 = 20 mm\n"
            "  limit switch: 0.2 mm in its filter time + 20 mm of ramp = 20.2 mm; overtravel 25 mm: a ramp fits\n"
            "  soft limits: 0 to 300 mm; jogs brake 20 mm before them, the card's own guard stops up to 20 mm behind "
            "them\n"
            "axis A: stops from 100 degrees/s in v * T/2 = 20 degrees\n"
            "  soft limits: none, the axis is endless\n"
            "limit switches: stop on a ramp\n");
}

TEST(MachineCheck, TellsOfSoftLimitsThatStopAtOnce) {
  EXPECT_THAT(
      app::stop_text(machine_of("on_soft_limit = \"immediate\"\n", "min = 0\nmax = 300\n", "endless = true\n")),
      HasSubstr("\n  soft limits: 0 to 300 mm; jogs brake 20 mm before them, the card's own guard stops immediately "
                "at them, as inputs.on_soft_limit says\n"));
}

TEST(MachineCheck, NamesTheAxisThatDoesNotFit) {
  const auto machine = machine_of("x_limit_plus = 0\na_limit_minus = 1\nfilter = 2\n", "overtravel = 25\n",
                                  "max = 90\novertravel = 12\n");
  const std::string text = app::stop_text(machine);
  EXPECT_THAT(text, HasSubstr("overtravel 12 degrees: a ramp does not fit, it needs 8.2 degrees more\n"));
  EXPECT_THAT(text, HasSubstr("soft limits: none to 90 degrees"));
  EXPECT_THAT(
      text,
      HasSubstr("limit switches: immediate stop at all of them, because a ramp does not fit behind those of axis A. "));
  EXPECT_THAT(app::stop_text(machine_of("", "", "endless = true\n")), HasSubstr("\nlimit switches: none\n"));
  EXPECT_THAT(app::stop_text(machine_of("x_limit = 0\non_limit = \"immediate\"\n", "", "endless = true\n")),
              HasSubstr("\nlimit switches: immediate stop, as inputs.on_limit says\n"));
}

}  // namespace
}  // namespace trammel::test
