// PWM commands: before the block to which they apply, with the scale of its ticks, and none if nothing changes.
#include <gtest/gtest.h>

#include <cmath>

#include "plan.hpp"

namespace trammel::planner {
namespace {

constexpr std::uint32_t kPulseClock = 1'000'000;

CardLimits card_for_pulses(bool pwm) {
  CardLimits card;
  card.clock_hz = kPulseClock;
  card.outputs = 4;
  card.pwm = pwm;
  return card;
}

machine::Machine laser_machine() {
  machine::Machine machine = machine::default_machine();
  machine::apply_override(machine, "spindle.output=1");
  machine::apply_override(machine, "spindle.laser=true");
  return machine;
}

std::vector<driver::PwmCommand> pwm_commands_of(const Planned& block) { return commands<driver::PwmCommand>(block); }

TEST(Pulses, StandWhereTheyChange) {
  const Plan plan =
      plan_text("M3 S500\nG0 X5\nG1 X10 F1200\nX20\nX30 S1000\nG0 X0\nM2\n", laser_machine(), card_for_pulses(true));
  ASSERT_FALSE(plan.error);
  ASSERT_EQ(plan.blocks.size(), 6U);
  const int duties[] = {0, 32768, -1, 65535, 0, -1};
  for (std::size_t i = 0; i < std::size(duties); ++i) {
    const auto pulses = pwm_commands_of(plan.blocks[i]);
    EXPECT_EQ(plan.blocks[i].planned.commands, plan.blocks[i].commands.size()) << i;
    ASSERT_EQ(pulses.size(), duties[i] < 0 ? 0U : 1U) << i;
    if (pulses.empty()) continue;
    EXPECT_EQ(pulses[0].duty, duties[i]) << i;
    EXPECT_FALSE(pulses[0].follows) << i;
  }
}

// The gain by which the card multiplies the rate gives the programmed duty at the programmed feed.
TEST(Pulses, TheScaleIsThatOfThePathsTicks) {
  const Plan plan =
      plan_text("M4 S500\nG1 X10 F1200\nY10 F600\nG1 X0 Y0 Z5\nM2\n", laser_machine(), card_for_pulses(true));
  ASSERT_FALSE(plan.error);
  std::size_t followed = 0;
  driver::PwmCommand in_force;
  for (const Planned& block : plan.blocks) {
    for (const driver::PwmCommand& pulses : pwm_commands_of(block)) in_force = pulses;
    if (!moves(block.planned.block)) continue;
    ++followed;
    ASSERT_TRUE(in_force.follows);
    const auto lines = commands<driver::LineCommand>(block);
    ASSERT_EQ(lines.size(), 1U);
    const Block& b = block.planned.block;
    const double rate = b.wanted * static_cast<double>(lines[0].ticks) / b.length / kPulseClock;  // ticks per clock
    const double duty = std::floor(rate * 0x1p31 * std::ldexp(1.0, in_force.shift)) * in_force.gain / 0x1p30;
    EXPECT_NEAR(duty, 32768, 32768 * 2e-3) << followed;
    EXPECT_EQ(in_force.duty, 32768);
  }
  EXPECT_EQ(followed, 3U);
}

// A duty that follows the speed is 0 at rest, so a dwell needs no command. A new feed needs a new scale.
TEST(Pulses, ThatFollowTheSpeedChangeWithTheFeedAlone) {
  const Plan plan = plan_text("M4 S500\nG1 X10 F1200\nX20\nG4 P1\nX30\nX40 F1300\nM3 X50\nM4 S0 X60\nM2\n",
                              laser_machine(), card_for_pulses(true));
  ASSERT_FALSE(plan.error);
  std::vector<std::size_t> lines;
  for (const Planned& block : plan.blocks) {
    EXPECT_LE(pwm_commands_of(block).size(), 1U);
    for (const driver::PwmCommand& pulses : pwm_commands_of(block)) {
      lines.push_back(block->line);
      EXPECT_EQ(pulses.follows, block->line < 7) << block->line;
      EXPECT_EQ(pulses.duty, block->line < 8 ? 32768 : 0) << block->line;
    }
  }
  EXPECT_EQ(lines, (std::vector<std::size_t>{2, 6, 7, 8}));
}

TEST(Pulses, AMachineWithoutASpindlesOutputHasNone) {
  const Plan plan = plan_text("M3 S500\nG1 X10 F1200\nM2\n", machine::default_machine(), card_for_pulses(true));
  ASSERT_FALSE(plan.error);
  for (const Planned& block : plan.blocks) EXPECT_TRUE(pwm_commands_of(block).empty());
}

TEST(Pulses, ACardWithoutPwmGetsNone) {
  const Plan plan = plan_text("M4 S500\nG1 X10 F1200\nM2\n", laser_machine(), card_for_pulses(false));
  ASSERT_FALSE(plan.error);
  for (const Planned& block : plan.blocks) EXPECT_TRUE(pwm_commands_of(block).empty());
}

}  // namespace
}  // namespace trammel::planner
