// The machine file's min and max in the card: which axes have them there, at which pulses, and when they are removed.
#include <gtest/gtest.h>

#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::run {
namespace {

namespace reg = card_map::reg;

class SoftLimitsInTheCard : public ::testing::Test {
 protected:
  SoftLimitsInTheCard() {
    machine::apply_override(machine_, "axis.x.min = -10");
    machine::apply_override(machine_, "axis.x.max = 200.006");  // 80 steps/mm
    machine::apply_override(machine_, "axis.z.max = 50");
  }
  // Sets machine zero of all axes to the position-counter value `zero`. The axes in `valid` (bit n: axis n) get a valid
  // place.
  void set_place(std::int32_t zero, std::uint8_t valid = 0xF) {
    CardPlace place = read_card_place(card_);
    keep_place(card_, place, scales_of(machine_), motors_of(machine_));
    for (unsigned n = 0; n < 4; ++n) card_.set_machine_zero(n, zero);
    card_.set_place(0xF, false, false);
    if (valid != 0) card_.set_place(valid, true, true);
  }
  std::uint32_t has() { return engine_->read(reg::kSoftLimits); }
  std::int32_t minus(unsigned axis) { return static_cast<std::int32_t>(engine_->read(reg::soft_minus(axis))); }
  std::int32_t plus(unsigned axis) { return static_cast<std::int32_t>(engine_->read(reg::soft_plus(axis))); }

  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine(sim::EngineOptions{4, 1'000'000, false});
  driver::Card card_ = driver::Card::open(*engine_);
  machine::Machine machine_ = machine::default_machine();
};

TEST_F(SoftLimitsInTheCard, OfAxesThatHaveSomeInPulsesFromMachineZero) {
  set_place(1000);
  guard_soft_limits(card_, machine_, read_card_place(card_));
  EXPECT_EQ(has(), 5U) << "X and Z";
  EXPECT_EQ(minus(0), 1000 - 800);
  EXPECT_EQ(plus(0), 1000 + 16000) << "rounded as the path is";
  const double steps = machine_.axes[2].steps_per_mm;
  EXPECT_EQ(plus(2), 1000 + static_cast<std::int32_t>(50 * steps));
  EXPECT_EQ(static_cast<std::uint32_t>(plus(2)) - static_cast<std::uint32_t>(minus(2)), 0x7FFFFFFFU) << "no end";
}

TEST_F(SoftLimitsInTheCard, NoneWithoutAPlace) {
  set_place(0, 1U << 2);
  guard_soft_limits(card_, machine_, read_card_place(card_));
  EXPECT_EQ(has(), 4U) << "Z alone has a valid place";
  set_place(0, 0);
  guard_soft_limits(card_, machine_, read_card_place(card_));
  EXPECT_EQ(has(), 0U);
}

TEST_F(SoftLimitsInTheCard, StopAsTheMachineSays) {
  set_place(0);
  constexpr std::uint32_t kSoft = card_map::field::kStopReactionSoftLimit;
  const std::uint32_t before = engine_->read(reg::kStopReaction);
  machine::apply_override(machine_, "inputs.on_soft_limit = 'immediate'");
  guard_soft_limits(card_, machine_, read_card_place(card_));
  EXPECT_EQ(engine_->read(reg::kStopReaction), before & ~kSoft);
  machine::apply_override(machine_, "inputs.on_soft_limit = 'ramp'");
  guard_soft_limits(card_, machine_, read_card_place(card_));
  EXPECT_EQ(engine_->read(reg::kStopReaction), before) << "what another machine file said ends";
  EXPECT_NE(before & kSoft, 0U);
}

TEST_F(SoftLimitsInTheCard, OfHomedAxesAloneBesideALine) {
  set_place(0);
  card_.set_place(1, true, false);
  guard_homed_axes(card_, machine_, read_card_place(card_));
  EXPECT_EQ(has(), 4U) << "X was not homed";
  guard_soft_limits(card_, machine_, read_card_place(card_));
  EXPECT_EQ(has(), 5U);
}

TEST_F(SoftLimitsInTheCard, OfTheAxesThatASmallerCardHas) {
  const auto engine = sim::make_model_engine(sim::EngineOptions{2, 1'000'000, false});
  driver::Card card = driver::Card::open(*engine);
  card.set_place(3, true, true);
  guard_homed_axes(card, machine_, read_card_place(card));
  EXPECT_EQ(engine->read(reg::kSoftLimits), 1U) << "X; the card has no Z";
}

TEST_F(SoftLimitsInTheCard, GoWithTheZeroTheyWereCountedFrom) {
  set_place(0);
  guard_soft_limits(card_, machine_, read_card_place(card_));
  EXPECT_NE(has(), 0U);
  set_zero(card_, machine_, "X", true);
  EXPECT_EQ(has(), 0U);
}

TEST_F(SoftLimitsInTheCard, NoneOfMotorsThatMoveTwoAxes) {
  machine::apply_override(machine_, "kinematics.name = 'corexy'");
  set_place(0);
  guard_soft_limits(card_, machine_, read_card_place(card_));
  EXPECT_EQ(has(), 4U) << "Z has a motor of its own";
}

}  // namespace
}  // namespace trammel::run
