// Outputs for the drives and the card, safe levels, and the emergency stop: writes of the driver, its rounding, and its
// refusals before any write.
#include "trammel/driver/drives.hpp"

#include <gmock/gmock.h>

#include "error_message.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
namespace reg = card_map::reg;
namespace field = card_map::field;

// A card at 1 MHz: the unit of delays is 4.096 ms, the unit of idle times 1.05 s.
class Drives : public ::testing::Test {
 protected:
  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine({});
  Card card_ = Card::open(*engine_);
};

TEST_F(Drives, TheSequenceIsRoundedUp) {
  EnableSequence sequence;
  sequence.axes = 0b101;
  sequence.brake_release = 1ns;
  sequence.before_first_step = 4096us;
  sequence.after_last_step = 4097us;
  sequence.brake_set = 100ms;
  sequence.idle = 60s;
  sequence.disable_causes = field::kFaultLimit;
  card_.set_enable_sequence(sequence);
  EXPECT_EQ(engine_->read(reg::kBrakeReleaseDelay), 1U);
  EXPECT_EQ(engine_->read(reg::kEnableDelay), 1U);
  EXPECT_EQ(engine_->read(reg::kStopDelay), 2U);
  EXPECT_EQ(engine_->read(reg::kBrakeSetDelay), 25U);
  EXPECT_EQ(engine_->read(reg::kEnableIdle), 58U);
  EXPECT_EQ(engine_->read(reg::kDisableCauses), field::kFaultLimit);
  EXPECT_EQ(engine_->read(reg::kEnableAxes), 0b101U);
  EXPECT_EQ(engine_->read(reg::kEnable), 0U);
  sequence.brake_set = 300s;
  EXPECT_THAT(argument_error([&] { card_.set_enable_sequence(sequence); }),
              HasSubstr("delay behind the brake's setting: 300000 ms: this card takes up to 268431 ms"));
  sequence = {};
  sequence.axes = 0x10;
  EXPECT_THAT(argument_error([&] { card_.set_enable_sequence(sequence); }), HasSubstr("the card has 4 axes"));
}

TEST_F(Drives, TheOrderAndTheMannerStandApart) {
  EnableSequence sequence;
  sequence.axes = 1;
  sequence.manual = true;
  card_.enable(true);
  card_.set_enable_sequence(sequence);
  EXPECT_EQ(engine_->read(reg::kEnable), field::kEnableOn | field::kEnableManual);
  engine_->wait(100);
  EXPECT_TRUE(card_.read_status().enabled);
  card_.enable(false);
  EXPECT_EQ(engine_->read(reg::kEnable), field::kEnableManual);
  engine_->wait(100);
  EXPECT_FALSE(card_.read_status().enabled);
}

TEST_F(Drives, RolesOfOutputs) {
  card_.set_output_roles({1, 2, 4, 8});
  EXPECT_EQ(engine_->read(reg::kOutputRoles), 2U << 16 | 1U);
  EXPECT_EQ(engine_->read(reg::kHealthRoles), 8U << 16 | 4U);
  EXPECT_THAT(argument_error([&] { card_.set_output_roles({0x10, 0, 0, 0}); }), HasSubstr("the card has 4 outputs"));
  EXPECT_THAT(argument_error([&] { card_.set_output_roles({1, 0, 1, 0}); }), HasSubstr("0x1 have more than one"));
  Health health;
  health.causes = field::kFaultWatchdog;
  health.needs_watchdog = true;
  health.pump_half_period = 500us;
  card_.set_health(health);
  EXPECT_EQ(engine_->read(reg::kHealthCauses), field::kFaultWatchdog | field::kHealthCausesNoWatchdog);
  EXPECT_EQ(engine_->read(reg::kChargePump), 500U);
  health.needs_watchdog = false;
  card_.set_health(health);
  EXPECT_EQ(engine_->read(reg::kHealthCauses), field::kFaultWatchdog);
  health.pump_half_period = 65'536us;
  EXPECT_THAT(argument_error([&] { card_.set_health(health); }),
              HasSubstr("charge pump: half a period of 65536000 ns is not up to 65535 clocks at 1000000 Hz"));
}

TEST_F(Drives, SafeLevelsAndTheReactionToTheEmergencyStop) {
  card_.set_output_safe_cause(1, 3);
  EXPECT_EQ(engine_->read(reg::kOutputSafeCause), 3U << 16 | 1U);
  const std::uint32_t before = engine_->read(reg::kStopReaction);
  card_.set_emergency_stop_ramps(true);
  EXPECT_EQ(engine_->read(reg::kStopReaction), before | field::kStopReactionEmergencyStop);
  card_.set_emergency_stop_ramps(false);
  EXPECT_EQ(engine_->read(reg::kStopReaction), before);
}

TEST_F(Drives, AnEmergencyStopStandsUntilItIsClearedAfterItsRelease) {
  EXPECT_TRUE(card_.has_emergency_stop());
  EXPECT_FALSE(card_.read_emergency_stop());
  engine_->set_emergency_stop(true);
  engine_->wait(100);
  EXPECT_TRUE(card_.read_emergency_stop());
  card_.clear_faults();
  engine_->wait(100);
  EXPECT_TRUE(card_.read_emergency_stop()) << "the button is still pressed";
  engine_->set_emergency_stop(false);
  engine_->wait(100);
  EXPECT_TRUE(card_.read_emergency_stop()) << "nobody has cleared it";
  card_.clear_faults();
  engine_->wait(100);
  EXPECT_FALSE(card_.read_emergency_stop());
}

TEST(DrivesOfAPlainCard, AreRefused) {
  sim::ModelOptions options;
  options.engines = card_map::engines::kLines | card_map::engines::kJerk | card_map::engines::kPathCommands;
  const auto engine = sim::make_model_engine(options);
  Card card = Card::open(*engine);
  EXPECT_THAT(argument_error([&] { card.enable(true); }), HasSubstr("engine enables"));
  EXPECT_THAT(argument_error([&] { card.set_output_roles({}); }), HasSubstr("engine enables"));
  EXPECT_THAT(argument_error([&] { card.set_enable_sequence({}); }), HasSubstr("engine enables"));
  EXPECT_THAT(argument_error([&] { card.set_health({}); }), HasSubstr("engine enables"));
  EXPECT_FALSE(card.has_emergency_stop());
  EXPECT_THAT(argument_error([&] { card.read_emergency_stop(); }), HasSubstr("the card has none"));
  EXPECT_THAT(argument_error([&] { card.set_emergency_stop_ramps(true); }), HasSubstr("the card has none"));
}

}  // namespace
}  // namespace trammel::driver
