// Filters, roles and stops of the card's inputs: writes of the driver, its rounding, and its refusals before any write.
#include <gmock/gmock.h>

#include "error_message.hpp"
#include "register_stub.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using test::RegisterStub;
using ::testing::HasSubstr;
namespace reg = card_map::reg;
namespace field = card_map::field;

TEST(CardInputs, FiltersRoundUpToScansOf64Clocks) {
  EXPECT_EQ(Card::filter_scans(0ns, 100'000'000), 0U);
  EXPECT_EQ(Card::filter_scans(1ns, 100'000'000), 1U);
  EXPECT_EQ(Card::filter_scans(640ns, 100'000'000), 1U);
  EXPECT_EQ(Card::filter_scans(641ns, 100'000'000), 2U);
  EXPECT_EQ(Card::filter_scans(20ms, 100'000'000), 31'250U);
  EXPECT_EQ(Card::filter_scans(20ms, 209'000'000), 65'313U);
  EXPECT_THAT(argument_error([] { Card::filter_scans(20ms, 210'000'000); }), HasSubstr("at most 65535"));
  EXPECT_THAT(argument_error([] { Card::filter_scans(-1ns, 1'000'000); }), HasSubstr("input filter"));
}

class CardInputsOnModel : public ::testing::Test {
 protected:
  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine({});
  Card card_ = Card::open(*engine_);
};

TEST_F(CardInputsOnModel, WhatIsWrittenReadsBack) {
  card_.set_input_filter(15, 100us);
  EXPECT_EQ(engine_->read(reg::input_filter(15)), 2U);
  EXPECT_EQ(card_.read_input_filter(15), 128us);
  card_.set_role({AxisRole::kDriveFault, 3}, 0x8001);
  EXPECT_EQ(engine_->read(reg::role(35)), 0x8001U);
  EXPECT_EQ(card_.read_role({AxisRole::kDriveFault, 3}), 0x8001U);
  card_.set_role(CardRole::kCycleStart, 2);
  EXPECT_EQ(engine_->read(reg::role(51)), 2U);
  card_.set_overtravel(2, 77);
  EXPECT_EQ(engine_->read(reg::overtravel(2)), 77U);
  InputStops stops;
  stops.any_step = 3;
  stops.shared = 4;
  stops.tool_setter = true;
  stops.limit_ramps = true;
  stops.drive_fault_ramps = false;
  card_.set_input_stops(stops);
  EXPECT_EQ(engine_->read(reg::kStopCauses), 0x40403U);
  constexpr std::uint32_t kUntouched =
      field::kStopReactionWatchdog | field::kStopReactionLinkLoss | field::kStopReactionSoftLimit;
  EXPECT_EQ(engine_->read(reg::kStopReaction),
            kUntouched | field::kStopReactionLimit | field::kStopReactionProbe | field::kStopReactionToolSetter);
  stops = {};
  stops.probe = true;
  stops.probe_ramps = false;
  stops.tool_setter_ramps = false;
  card_.set_input_stops(stops);
  EXPECT_EQ(engine_->read(reg::kStopCauses), field::kStopCausesProbe);
  EXPECT_EQ(engine_->read(reg::kStopReaction), kUntouched | field::kStopReactionDriveFault);
  card_.set_role({AxisRole::kDriveFault, 3}, 0);
  EXPECT_EQ(engine_->read(reg::role(35)), 0U) << "no input has it";
}

// The override applies to a limit that is active. This limit then stops nothing until it is released.
TEST_F(CardInputsOnModel, AnOverrideIsOfOneEnd) {
  card_.set_role({AxisRole::kLimitMinus, 1}, 4);
  card_.set_role({AxisRole::kLimitPlus, 1}, 8);
  engine_->set_inputs(12);
  engine_->wait(200);
  card_.override_limits(0, 2);
  EXPECT_EQ(engine_->read(reg::kLimitOverride), 2U << field::kLimitOverridePlusShift);
  start_line(card_, {0, 5}, 10ms);
  card_.wait_until_idle(1s);
  EXPECT_EQ(engine_->positions()[1], 5);
  start_line(card_, {0, -5}, 10ms);
  EXPECT_THROW(card_.wait_until_idle(1s), FaultError);
  EXPECT_EQ(card_.read_fault_text(), "LIMIT (axis 1 minus)");
  card_.name_axes({"X", "Y"});
  EXPECT_EQ(card_.read_fault_text(), "LIMIT (Y minus)");
  try {
    card_.wait_until_idle(1s);
    ADD_FAILURE() << "the fault is still there";
  } catch (const FaultError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("LIMIT (Y minus)"));
  }
}

TEST(CardInputs, RolesHaveNames) {
  EXPECT_EQ(role_name({AxisRole::kLimitMinus, 0}), "limit minus of axis 0");
  EXPECT_EQ(role_name({AxisRole::kInPosition, 7}), "in position of axis 7");
  EXPECT_EQ(role_name(CardRole::kProbe), "probe");
  EXPECT_EQ(role_name(CardRole::kSpindleAtSpeed), "spindle at speed");
  EXPECT_EQ(role_name(static_cast<CardRole>(53)), "role 53");
}

// This card has no LIMIT_STATE, so it must not be read.
TEST(CardInputs, FaultsOfACardWithoutThemHaveATextToo) {
  RegisterStub bus;
  Card card = Card::open(bus);
  bus.values[reg::kFault] = field::kFaultTickMismatch | 1U;
  bus.values[reg::kLimitState] = 0xFFFFFF;
  bus.forget();
  card.name_axes({"X"});
  EXPECT_EQ(card.read_fault_text(), "step fault of X, TICK_MISMATCH");
  EXPECT_THAT(bus.log, ::testing::ElementsAre(test::was_read(reg::kFault)));
}

TEST_F(CardInputsOnModel, RolesFollowTheirInputs) {
  card_.set_role({AxisRole::kLimitMinus, 1}, 4);
  card_.set_role(CardRole::kFeedHold, 8);
  engine_->set_inputs(4);
  engine_->wait(200);
  EXPECT_EQ(card_.read_roles().limit_minus, 2);
  EXPECT_FALSE(card_.read_roles().feed_hold);
  engine_->set_inputs(8);
  engine_->wait(200);
  EXPECT_EQ(card_.read_roles().limit_minus, 0);
  EXPECT_TRUE(card_.read_roles().feed_hold);
  // Other roles of the card, one at a time.
  card_.set_role(CardRole::kCycleStart, 0x10);
  card_.set_role(CardRole::kToolSetter, 0x20);
  card_.set_role(CardRole::kProbe, 0x40);
  for (const std::uint32_t input : {0x10U, 0x20U, 0x40U}) {
    engine_->set_inputs(8 | input);
    engine_->wait(200);
    const ActiveRoles active = card_.read_roles();
    EXPECT_EQ(active.cycle_start, input == 0x10);
    EXPECT_EQ(active.tool_setter, input == 0x20);
    EXPECT_EQ(active.probe, input == 0x40);
    EXPECT_TRUE(active.feed_hold);
  }
  engine_->set_inputs(8);
  engine_->wait(200);
  // A filter of 10 scans.
  card_.set_input_filter(3, 640us);
  engine_->set_inputs(0);
  engine_->wait(600);
  EXPECT_EQ(card_.read_raw_inputs(), 0U);
  EXPECT_EQ(card_.read_inputs(), 8U);
  engine_->wait(200);
  EXPECT_EQ(card_.read_inputs(), 0U);
}

TEST_F(CardInputsOnModel, BadArgumentsAreNamed) {
  EXPECT_THAT(argument_error([&] { card_.set_input_filter(16, 0ns); }), HasSubstr("the card has 16 inputs"));
  EXPECT_THAT(argument_error([&] {
                card_.set_role({AxisRole::kHome, 4}, 1);
              }),
              HasSubstr("home of axis 4: the card has 4 axes"));
  EXPECT_THAT(argument_error([&] { card_.set_role(CardRole::kToolSetter, 0x10000); }),
              HasSubstr("inputs of tool setter: 0x10000: the card has 16 inputs"));
  EXPECT_THAT(argument_error([&] { card_.read_input_filter(32); }), HasSubstr("filter of input 32: there are 32"));
  EXPECT_THAT(argument_error([&] { card_.set_overtravel(0, 65'536); }), HasSubstr("0 .. 65535"));
  EXPECT_THAT(argument_error([&] { card_.set_overtravel(4, 0); }),
              HasSubstr("overtravel of axis 4: the card has 4 axes"));
  EXPECT_THAT(argument_error([&] { card_.override_limits(0, 0x10); }), HasSubstr("the card has 4 axes"));
}

TEST(CardInputs, ACardWithoutThemSaysSo) {
  sim::ModelOptions options;
  options.engines = 0x6F3;
  const auto engine = sim::make_model_engine(options);
  Card card = Card::open(*engine);
  EXPECT_THAT(argument_error([&] { card.set_role(CardRole::kFeedHold, 1); }), HasSubstr("machine_inputs"));
  EXPECT_THAT(argument_error([&] { card.read_raw_inputs(); }), HasSubstr("machine_inputs"));
}

}  // namespace
}  // namespace trammel::driver
