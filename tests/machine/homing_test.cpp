// The tables [homing.<axis>] of a machine file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "trammel/machine/machine.hpp"

namespace trammel::machine {
namespace {

using ::testing::HasSubstr;

// The default machine followed by `more`, whose first line has the number first_homing_line().
std::string homing_text(const std::string& more) { return default_machine_text() + "\n" + more; }
int first_homing_line() {
  const std::string text = homing_text("");
  return static_cast<int>(std::count(text.begin(), text.end(), '\n')) + 1;
}
std::string homing_error(const std::string& more) {
  try {
    parse_machine(homing_text(more), "m.toml");
  } catch (const MachineError& error) {
    return error.what();
  }
  return "";
}
const std::string kHomeInput = "[inputs]\nx_home = 0\n";

TEST(MachineHoming, IsReadWhole) {
  const Machine machine = parse_machine(
      homing_text("[inputs]\nx_home = 0\nx_index = 3\n[homing.x]\nsearch_velocity = -40\nlatch_velocity = 2\n"
                  "final_velocity = 50\noffset = -1.5\nfinal_position = 5\nsearch_distance = 300\nsquaring = 4\n"
                  "use_index = true\nignore_limits = true\nshared = true\nsequence = 3\n"),
      "m.toml");
  ASSERT_TRUE(machine.axes[0].homing);
  const AxisHoming& homing = *machine.axes[0].homing;
  EXPECT_EQ(homing.search_velocity, -40);
  EXPECT_EQ(homing.direction(), -1);
  EXPECT_EQ(homing.latch_velocity, 2);
  EXPECT_EQ(homing.final_velocity, 50);
  EXPECT_EQ(homing.offset, -1.5);
  EXPECT_EQ(homing.final_position, 5);
  EXPECT_EQ(homing.search_distance, 300);
  EXPECT_EQ(homing.squaring, 4);
  EXPECT_TRUE(homing.use_index && homing.ignore_limits && homing.shared);
  EXPECT_FALSE(homing.at_speed);
  EXPECT_EQ(homing.sequence, 3U);
  EXPECT_FALSE(machine.axes[1].homing);
}

TEST(MachineHoming, ASecondMotorHasASwitchOfItsOwn) {
  Machine machine = default_machine();
  apply_override(machine, "axis.x.second_motor=true");
  apply_override(machine, "inputs.x_second_home=7");
  EXPECT_EQ(machine.inputs.roles[2 * 8 + 4].inputs, 1U << 7) << "home of the card's axis 4";
  EXPECT_THROW(apply_override(machine, "inputs.y_second_home=7"), MachineError);
}

TEST(MachineHoming, SaysWhatIsWrongAndWhere) {
  const std::string at = "m.toml:" + std::to_string(first_homing_line() + 2) + ": ";
  const auto wrong = [&](const std::string& entries) { return homing_error(kHomeInput + "[homing.x]\n" + entries); };
  EXPECT_EQ(wrong("latch_velocity = 2\n").substr(0, at.size()), at) << wrong("latch_velocity = 2\n");
  EXPECT_THAT(wrong("latch_velocity = 2\n"), HasSubstr("homing.x: search_velocity is missing"));
  EXPECT_THAT(wrong("search_velocity = 900\n"),
              HasSubstr("search_velocity is 900 mm/s, and the axis's max_velocity 150"));
  EXPECT_THAT(wrong("search_velocity = 5\nlatch_velocity = -6\n"), HasSubstr("latch_velocity, 6 mm/s, is above"));
  EXPECT_THAT(wrong("search_velocity = 5\nfinal_velocity = 151\n"), HasSubstr("final_velocity is 151 mm/s"));
  EXPECT_THAT(wrong("search_velocity = 5\nlatch_velocity = 1\nat_speed = true\n"),
              HasSubstr("leave latch_velocity out"));
  EXPECT_THAT(wrong("search_velocity = 5\nuse_index = true\n"), HasSubstr("give x_index in [inputs]"));
  EXPECT_THAT(wrong("search_velocity = 5\n"), HasSubstr("give search_distance, mm, or min and max of the axis"));
  EXPECT_THAT(wrong("search_velocity = 5\nsequence = 32\n"),
              HasSubstr("homing.x.sequence must be a whole number from 0 to 31"));
  EXPECT_THAT(wrong("serch_velocity = 5\n"), HasSubstr("did you mean search_velocity?"));
  EXPECT_THAT(homing_error("[homing.x]\nsearch_velocity = 5\n"),
              HasSubstr("no input has the role: give x_home in [inputs]"));
  EXPECT_THAT(homing_error(kHomeInput + "[homing.w]\nsearch_velocity = 5\n"), HasSubstr("homing.w"));
  EXPECT_THAT(homing_error("[inputs]\nx_home = [0, 1]\n[homing.x]\nsearch_velocity = 5\n"),
              HasSubstr("x_home must be one input"));
  EXPECT_THAT(homing_error(kHomeInput + "x_limit_minus = 0\n[homing.x]\nsearch_velocity = 5\n"),
              HasSubstr("x_home is a limit as well, which would stop the search: give ignore_limits = true"));
}

}  // namespace
}  // namespace trammel::machine
