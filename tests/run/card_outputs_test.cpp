// [outputs] of the machine file in the card: safe levels, drives, the emergency stop.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::run {
namespace {

using ::testing::HasSubstr;
namespace reg = card_map::reg;
namespace field = card_map::field;

class CardOutputs : public ::testing::Test {
 protected:
  // Configures the card with these overrides of [outputs]. Returns the register at `address`.
  std::uint32_t configured(std::uint32_t address, const std::vector<std::string>& entries) {
    machine::Machine machine = machine::default_machine();
    for (const std::string& entry : entries) machine::apply_override(machine, entry);
    configure(card_, machine);
    return engine_->read(address);
  }

  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine(sim::EngineOptions{6, 1'000'000, false});
  driver::Card card_ = driver::Card::open(*engine_);
};

TEST_F(CardOutputs, GoToTheirSafeLevels) {
  EXPECT_EQ(configured(reg::kOutputSafe, {"outputs.off_at_rest=1", "outputs.on_at_rest=[2,3]"}), 0x000E000CU);
  EXPECT_EQ(configured(reg::kOutputSafeCause, {"outputs.off_at_cause=1", "outputs.on_at_cause=2"}), 0x00060004U);
  EXPECT_EQ(configured(reg::kOutputSafeCause, {"outputs.on_at_cause=0"}), 0x00010001U);
}

TEST_F(CardOutputs, EnableTheDrivesOfTheAxesThatAreNamed) {
  EXPECT_EQ(configured(reg::kEnableAxes, {"outputs.enable=0"}), 0xFU);
  EXPECT_EQ(configured(reg::kEnableAxes, {"outputs.enable=0", "outputs.enable_axes=['x','z']"}), 5U);
  EXPECT_EQ(configured(reg::kEnableAxes, {"outputs.enable=0", "outputs.enable_axes=['y']", "axis.x.second_motor=true",
                                          "axis.y.second_motor=true"}),
            0x22U)
      << "both motors of Y";
  EXPECT_EQ(configured(reg::kEnableAxes, {"outputs.brake=0", "outputs.enable_axes=['x']", "kinematics.name='corexy'"}),
            3U)
      << "two motors move X";
}

TEST_F(CardOutputs, EnableTheDrivesByHand) {
  EXPECT_EQ(configured(reg::kEnable, {"outputs.enable=0", "outputs.enable_manual=true"}), field::kEnableManual);
  EXPECT_EQ(configured(reg::kEnable, {"outputs.enable=0"}), 0U);
}

TEST_F(CardOutputs, StopByTheEmergencyStopAsTheMachineSays) {
  const std::uint32_t before = engine_->read(reg::kStopReaction);
  constexpr std::uint32_t kRamp = field::kStopReactionEmergencyStop;
  EXPECT_EQ(configured(reg::kStopReaction, {"outputs.on_emergency_stop='ramp'"}), before | kRamp);
  EXPECT_EQ(configured(reg::kStopReaction, {}), before | kRamp) << "as the card has it";
  EXPECT_EQ(configured(reg::kStopReaction, {"outputs.on_emergency_stop='immediate'"}), before & ~kRamp);
}

TEST(CardOutputsOfAPlainCard, AreRefusedByName) {
  sim::ModelOptions options;
  options.engines = card_map::engines::kLines | card_map::engines::kJerk | card_map::engines::kPathCommands;
  const auto engine = sim::make_model_engine(options);
  driver::Card card = driver::Card::open(*engine);
  machine::Machine machine = machine::default_machine();
  machine::apply_override(machine, "outputs.on_emergency_stop='immediate'");
  try {
    configure(card, machine);
    ADD_FAILURE();
  } catch (const driver::ArgumentError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("outputs.on_emergency_stop of the machine file: the card has no emergency stop"));
  }
}

}  // namespace
}  // namespace trammel::run
