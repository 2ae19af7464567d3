// A program that runs into a limit switch of the machine file, on the model's card: it stops as the machine file says,
// FAULT names the limit and the axis, the position is right, and the way back is free.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "clocks.hpp"
#include "steps.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/run/machine_position.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/sim/timed_bus.hpp"

namespace trammel::run {
namespace {

using ::testing::HasSubstr;

constexpr std::uint64_t kPressed = kSlowClock / 2;  // clocks: in the middle of the long lines below
constexpr double kPulsesOfAMm = 80;

class Limits : public testing::Test {
 protected:
  Limits() {
    engine_->set_sink(&steps_);
    machine::apply_override(machine_, "inputs.x_limit_plus=3");
    machine::apply_override(machine_, "inputs.y_limit_minus={input=4, normally=\"open\"}");
    machine::apply_override(machine_, "inputs.filter=0.5");
  }
  // Input 3 is normally closed and has a pull-up: it reads 1 when the switch is pressed.
  void press_at(std::uint64_t clock, std::uint32_t pins) {
    bus_.at(clock, [pins](sim::Engine& engine) { engine.set_inputs(pins); });
  }
  std::string fault_of(const std::string& text, const RunSettings& settings = {}) {
    const auto shared = std::make_shared<const std::string>(text);
    Runner runner([shared] { return std::make_unique<gcode::TextLines>(*shared, "p.ngc"); }, machine_,
                  planner::limits_of(card_.identification()), settings);
    runner.plan();
    try {
      runner.run(card_);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "no fault";
  }
  std::int64_t pulses_behind() const {
    std::int64_t behind = 0;
    for (const driver::PinStep& step : steps_.pins) {
      behind += step.axis == 0 && step.cycle > kPressed ? step.direction : 0;
    }
    return behind;
  }

  machine::Machine machine_ = machine::default_machine();
  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine(sim::EngineOptions{4, kSlowClock, false});
  sim::TimedBus bus_{*engine_, kSlowClock, 1e9};
  driver::Card card_ = driver::Card::open(bus_);
  test::Steps steps_;
};

// An unwired input of a simulated card has the level that a wired one has at rest: 0 for input 3, 1 for input 4.
TEST_F(Limits, NothingIsActiveOnACardThatIsNotWired) {
  EXPECT_EQ(fault_of("G1 X2 Y-2 F3000\n"), "no fault");
  EXPECT_EQ(card_.read_inputs(), 0U);
  EXPECT_EQ(card_.read_raw_inputs(), 0U);
  EXPECT_EQ(card_.read_roles().limit_plus | card_.read_roles().limit_minus, 0U);
  EXPECT_EQ(card_.read_role({driver::AxisRole::kLimitPlus, 0}), 8U);
  EXPECT_EQ(card_.read_role({driver::AxisRole::kLimitMinus, 1}), 16U);
}

// One input is wired; the normally open one beside it stays at rest.
TEST_F(Limits, OneWiredInputLeavesTheOthersAlone) {
  bus_.at(kPressed, [](sim::Engine& engine) { engine.set_input(3, true); });
  EXPECT_THAT(fault_of("G1 X100 Y-10 F3000\n"), HasSubstr("LIMIT (X plus)"));
  EXPECT_EQ(card_.read_inputs(), 8U);
}

TEST_F(Limits, StopsAtOnceWhereNoOvertravelIsDeclared) {
  press_at(kPressed, 0b11000);
  EXPECT_THAT(fault_of("G1 X100 F3000\n"), HasSubstr("LIMIT (X plus)"));
  EXPECT_EQ(card_.read_limit_state().plus, 1);
  // The travel at 50 mm/s during the filter's time and one scan, plus at most 4 pulses that are already on their way.
  EXPECT_LE(pulses_behind(), 4 + static_cast<std::int64_t>(50 * kPulsesOfAMm * (0.0005 + 256.0 / kSlowClock)));
  EXPECT_GE(pulses_behind(), 1);
  const driver::Snapshot now = card_.read_snapshot();
  EXPECT_EQ(now.position[0], steps_.position(0));
}

TEST_F(Limits, TheWayBackIsFreeAndTheWayOnIsNot) {
  press_at(kPressed, 0b11000);
  MachinePosition position(card_.read_snapshot(), machine_);
  ASSERT_THAT(fault_of("G1 X100 F3000\n"), HasSubstr("LIMIT"));
  card_.clear_faults();
  position.look(card_.read_snapshot());
  RunSettings there;
  there.start = position.millimetres();
  EXPECT_EQ(fault_of("G91\nG1 X-5 F3000\n", there), "no fault");
  position.look(card_.read_snapshot());
  there.start = position.millimetres();
  EXPECT_THAT(fault_of("G91\nG1 X1 F3000\n", there), HasSubstr("LIMIT (X plus)"));
  card_.clear_faults();
  // The switch is released: the way on is free.
  engine_->set_inputs(0b10000);
  position.look(card_.read_snapshot());
  there.start = position.millimetres();
  EXPECT_EQ(fault_of("G91\nG1 X1 F3000\n", there), "no fault");
}

// At 50 of 150 mm/s the slew is doubled once, so that the ramp takes 0.15 s. Half of that time at 50 mm/s, plus the
// filter, is about 4 mm.
TEST_F(Limits, StopsOnARampWhereTheOvertravelIsLongEnough) {
  machine::apply_override(machine_, "axis.x.overtravel=30");
  machine::apply_override(machine_, "axis.y.overtravel=30");
  press_at(kPressed, 0b11000);
  EXPECT_THAT(fault_of("G1 X100 F3000\n"), HasSubstr("LIMIT (X plus)"));
  engine_->wait(kSlowClock);  // the ramp continues after the fault
  EXPECT_GT(pulses_behind(), static_cast<std::int64_t>(3 * kPulsesOfAMm));
  EXPECT_LT(pulses_behind(), static_cast<std::int64_t>(5 * kPulsesOfAMm));
  const driver::Snapshot now = card_.read_snapshot();
  EXPECT_EQ(now.position[0], steps_.position(0));
  EXPECT_FALSE(now.status.busy);
}

// The switch at the other end is normally open: it reads 0 when it is pressed.
TEST_F(Limits, NormallyOpenAtTheNegativeEnd) {
  press_at(kPressed, 0b00000);
  EXPECT_THAT(fault_of("G1 Y-100 F3000\n"), HasSubstr("LIMIT (Y minus)"));
}

// The bounce is shorter than the filter.
TEST_F(Limits, ABounceStopsNothing) {
  press_at(kPressed, 0b11000);
  press_at(kPressed + kSlowClock / 2500, 0b10000);
  EXPECT_EQ(fault_of("G1 X50 F3000\n"), "no fault");
}

TEST_F(Limits, TheFeedHoldButtonHoldsUntilCycleStart) {
  machine::apply_override(machine_, "inputs.feed_hold=5");
  machine::apply_override(machine_, "inputs.cycle_start=6");
  // At rest the buttons, which are normally open, read 1.
  press_at(kPressed, 0b1010000);
  press_at(kPressed + kSlowClock / 10, 0b1110000);
  bool held = false;
  bus_.at(3 * kPressed, [&](sim::Engine&) { held = card_.read_status().button_hold; });
  press_at(4 * kPressed, 0b0110000);
  EXPECT_EQ(fault_of("G1 X50 F3000\n"), "no fault");
  EXPECT_TRUE(held);
  EXPECT_EQ(card_.read_snapshot().position[0], 50 * static_cast<std::int32_t>(kPulsesOfAMm));
}

// After a wrong polarity in the machine file is corrected, the input is inactive at once, without the filter's delay.
TEST_F(Limits, AnotherPolarityCountsAtOnce) {
  engine_->set_input(7, true);
  machine::apply_override(machine_, "inputs.x_drive_fault={input=7, filter=20, normally=\"closed\"}");
  configure(card_, machine_);
  engine_->wait(kSlowClock);
  EXPECT_THAT(driver::describe_faults(card_.read_faults(), 0), HasSubstr("DRIVE_FAULT"));
  machine::apply_override(machine_, "inputs.x_drive_fault={input=7, filter=20, normally=\"open\"}");
  configure(card_, machine_);
  card_.clear_faults();
  engine_->wait(kSlowClock);
  EXPECT_EQ(card_.read_faults(), 0U);
}

TEST_F(Limits, AnInputThatTheCardLacksIsNamed) {
  machine::apply_override(machine_, "inputs.z_home=20");
  try {
    configure(card_, machine_);
    FAIL();
  } catch (const driver::ArgumentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("input 20 of the machine file: the card has 16 inputs"));
  }
}

}  // namespace
}  // namespace trammel::run
