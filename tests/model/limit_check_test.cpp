// The rules of the limit check: which step is a cause, which side stays blocked, when an override and an overtravel
// end.
#include "trammel/model/limit_check.hpp"

#include <gtest/gtest.h>

#include <array>

#include "trammel/model/button_hold.hpp"
#include "trammel/skip/control.hpp"

namespace trammel::model {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr std::uint8_t kAxis = 1U << 2;  // the axis that moves
enum class Way : std::uint8_t { Minus, Plus };

// A limit check with inputs that keep their values until they are changed.
struct Limits {
  LimitCheck check{4};
  LimitCheck::Inputs in;

  void clock() { check.clock(in); }
  void set(std::uint32_t address, std::uint32_t data) {
    in.setting = {true, address, data};
    clock();
    in.setting.set = false;
  }
  // True when the step is a cause.
  bool step(Way way, std::uint8_t axes = kAxis) {
    in.step = axes;
    in.dir = way == Way::Minus ? static_cast<std::uint8_t>(in.dir | axes) : static_cast<std::uint8_t>(in.dir & ~axes);
    clock();
    in.step = 0;
    return check.causes().limit;
  }
  void press(bool minus, bool plus) {
    in.roles.limit_minus = minus ? kAxis : std::uint8_t{0};
    in.roles.limit_plus = plus ? kAxis : std::uint8_t{0};
    clock();
  }
};

TEST(LimitCheck, OnlyAStepIntoTheSwitchIsACause) {
  Limits limits;
  EXPECT_FALSE(limits.step(Way::Minus));
  limits.press(true, false);
  EXPECT_FALSE(limits.check.causes().limit) << "the switch alone is none";
  EXPECT_FALSE(limits.step(Way::Plus));
  EXPECT_FALSE(limits.step(Way::Minus, 1)) << "another axis";
  EXPECT_TRUE(limits.step(Way::Minus));
  EXPECT_TRUE(limits.step(Way::Minus)) << "the side stays blocked";
  limits.clock();
  EXPECT_FALSE(limits.check.causes().limit) << "an event: FAULT may be cleared while the switch is active";
  limits.press(false, true);
  EXPECT_FALSE(limits.step(Way::Minus));
  EXPECT_TRUE(limits.step(Way::Plus));
}

TEST(LimitCheck, LimitStateNamesTheSideUntilFaultIsCleared) {
  Limits limits;
  limits.press(true, false);
  limits.step(Way::Minus);
  EXPECT_EQ(limits.check.limit_state(), 0U) << "with FAULT, a clock later";
  limits.clock();
  EXPECT_EQ(limits.check.limit_state(), 0x04U);
  limits.press(false, true);
  limits.step(Way::Plus);
  limits.in.clear = field::kFaultWatchdog;
  limits.clock();
  EXPECT_EQ(limits.check.limit_state(), 0x0404U);
  limits.in.clear = field::kFaultLimit;
  limits.clock();
  EXPECT_EQ(limits.check.limit_state(), 0U);
  limits.in.clear = 0;
  limits.in.roles.drive_fault = 0x0A;
  limits.clock();
  limits.clock();
  EXPECT_TRUE(limits.check.causes().drive_fault);
  EXPECT_EQ(limits.check.limit_state(), 0x0A0000U);
  limits.in.clear = field::kFaultDriveFault;
  limits.clock();
  EXPECT_EQ(limits.check.limit_state(), 0x0A0000U) << "a drive's fault that lasts is not cleared";
  limits.in.roles.drive_fault = 0;
  limits.clock();
  limits.clock();
  EXPECT_EQ(limits.check.limit_state(), 0U);
}

TEST(LimitCheck, ASharedSwitchBlocksTheSideFromWhichItWasReached) {
  for (const bool both_roles : {true, false}) {
    for (const Way way : {Way::Minus, Way::Plus}) {
      const Way back = way == Way::Minus ? Way::Plus : Way::Minus;
      Limits limits;
      limits.set(reg::kStopCauses, std::uint32_t{kAxis} << field::kStopCausesSharedShift);
      limits.step(back);
      limits.step(way);
      limits.press(true, both_roles);
      EXPECT_FALSE(limits.step(back));
      EXPECT_TRUE(limits.step(way)) << "moving away does not change the side";
      EXPECT_FALSE(limits.step(back));
      limits.press(false, false);
      EXPECT_FALSE(limits.step(way));
    }
  }
}

TEST(LimitCheck, ASharedSwitchBlocksBothSidesWhereNoStepCameBefore) {
  for (const Way way : {Way::Minus, Way::Plus}) {
    Limits limits;
    limits.set(reg::kStopCauses, std::uint32_t{kAxis} << field::kStopCausesSharedShift);
    limits.press(true, true);
    EXPECT_TRUE(limits.step(way));
    EXPECT_TRUE(limits.step(way == Way::Minus ? Way::Plus : Way::Minus)) << "a step does not tell afterwards";
    limits.set(reg::kLimitOverride, way == Way::Minus ? kAxis : kAxis << 8);
    EXPECT_FALSE(limits.step(way));
  }
}

TEST(LimitCheck, TwoSwitchesThatAreBothActiveBlockBothSides) {
  Limits limits;
  limits.step(Way::Minus);
  limits.press(true, false);
  limits.press(true, true);
  EXPECT_TRUE(limits.step(Way::Minus));
  EXPECT_TRUE(limits.step(Way::Plus));
}

TEST(LimitCheck, AnOverrideEndsWithItsSwitch) {
  Limits limits;
  limits.set(reg::kLimitOverride, kAxis);
  limits.press(true, false);
  EXPECT_TRUE(limits.step(Way::Minus)) << "an override of a switch that is not active is none";
  limits.set(reg::kLimitOverride, kAxis);
  EXPECT_FALSE(limits.step(Way::Minus));
  limits.press(true, true);
  EXPECT_TRUE(limits.step(Way::Plus)) << "of one side";
  EXPECT_FALSE(limits.step(Way::Minus));
  limits.press(false, false);
  limits.press(true, false);
  EXPECT_TRUE(limits.step(Way::Minus));
}

TEST(LimitCheck, UnderTheRuleOfAnyStepEachStepOfTheAxesIsACause) {
  Limits limits;
  limits.set(reg::kStopCauses, 0x3 | kAxis);
  limits.press(true, false);
  for (const std::uint8_t axes : std::array<std::uint8_t, 3>{1, 2, 4}) {
    for (const Way way : {Way::Minus, Way::Plus}) EXPECT_TRUE(limits.step(way, axes));
  }
  limits.clock();
  EXPECT_EQ(limits.check.limit_state(), 0x04U) << "the switch, not the axis that stepped";
  EXPECT_FALSE(limits.step(Way::Plus, 8)) << "an axis that is not named";
  limits.set(reg::kLimitOverride, kAxis);
  EXPECT_FALSE(limits.step(Way::Plus, 1));
}

TEST(LimitCheck, OvertravelIsTheStepsThatARampMayMakeIntoTheLimit) {
  for (const unsigned overtravel : {0U, 1U, 5U}) {
    Limits limits;
    limits.set(reg::overtravel(2), overtravel);
    for (int stop = 0; stop < 2; ++stop) {
      limits.press(true, false);
      unsigned made = 0;
      for (; made < 20; ++made) {
        EXPECT_TRUE(limits.step(Way::Minus));
        if (limits.check.causes().beyond) break;
        limits.in.stopping = true;
        limits.step(Way::Plus);  // a step away from the switch does not count
      }
      EXPECT_EQ(made, overtravel);
      limits.in.stopping = false;
      limits.press(false, false);
    }
  }
}

TEST(LimitCheck, ProbeAndToolSetterCountByTheirEdgeInAMoveWhereTheyAreSwitchedOn) {
  Limits limits;
  const auto edges = [&] {
    limits.in.roles.probe = limits.in.roles.tool_setter = false;
    limits.clock();
    limits.in.roles.probe = limits.in.roles.tool_setter = true;
    limits.clock();
    return std::pair(limits.check.causes().probe, limits.check.causes().tool_setter);
  };
  limits.in.runs = true;
  EXPECT_EQ(edges(), std::pair(false, false)) << "by default neither";
  limits.set(reg::kStopCauses, field::kStopCausesProbe | field::kStopCausesToolSetter);
  EXPECT_EQ(edges(), std::pair(true, true));
  limits.clock();
  EXPECT_FALSE(limits.check.causes().any()) << "while they stay active the machine may move away";
  limits.in.probing = true;
  EXPECT_EQ(edges(), std::pair(false, true));
  limits.in.probing = limits.in.runs = false;
  EXPECT_EQ(edges(), std::pair(false, false));
}

TEST(LimitCheck, RestsOnlyWhereNothingChanges) {
  Limits limits;
  const auto rests = [&] { return skip::horizon(limits.check, limits.in) != 0; };
  limits.clock();
  limits.in.roles.probe = limits.in.roles.tool_setter = false;
  limits.clock();
  EXPECT_TRUE(rests());
  limits.in.roles.limit_minus = kAxis;
  EXPECT_FALSE(rests());
  limits.clock();
  EXPECT_TRUE(rests());
  limits.step(Way::Minus);
  EXPECT_FALSE(rests());
  limits.clock();
  EXPECT_TRUE(rests());
  limits.in.roles.drive_fault = 1;
  EXPECT_FALSE(rests());
  limits.clock();
  EXPECT_FALSE(rests());
  limits.clock();
  EXPECT_TRUE(rests());
}

// An override ends one clock after its switch is released, at either end.
TEST(LimitCheck, AnOverrideRestsWhileItsSwitchIsActive) {
  for (const bool plus : {false, true}) {
    Limits limits;
    const auto rests = [&] { return skip::horizon(limits.check, limits.in) != 0; };
    limits.press(true, true);
    limits.clock();
    limits.set(reg::kLimitOverride, plus ? kAxis << 8 : kAxis);
    EXPECT_TRUE(rests());
    // The other switch stays active, so that only the override changes.
    (plus ? limits.in.roles.limit_plus : limits.in.roles.limit_minus) = 0;
    EXPECT_FALSE(rests());
    limits.clock();
    EXPECT_TRUE(rests());
    limits.press(true, true);
    EXPECT_TRUE(limits.step(plus ? Way::Plus : Way::Minus)) << "it has gone";
  }
}

// During its ramp the axis keeps the rest of its overtravel; after the ramp it has all of it again.
TEST(LimitCheck, OvertravelThatIsUsedRestsOnTheRampAlone) {
  Limits limits;
  const auto rests = [&] { return skip::horizon(limits.check, limits.in) != 0; };
  limits.set(reg::overtravel(2), 3);
  limits.press(false, true);
  EXPECT_TRUE(limits.step(Way::Plus));
  EXPECT_FALSE(rests()) << "the end that it has come into is to be told yet";
  limits.in.stopping = true;
  limits.clock();
  EXPECT_TRUE(rests());
  limits.in.stopping = false;
  EXPECT_FALSE(rests());
  limits.clock();
  EXPECT_TRUE(rests());
}

TEST(ButtonHold, FeedHoldHoldsUntilCycleStartIsPressed) {
  ButtonHold buttons;
  InputRoles in;
  const auto holds = [&](bool feed_hold, bool cycle_start) {
    in.feed_hold = feed_hold;
    in.cycle_start = cycle_start;
    buttons.clock(in);
    return buttons.hold();
  };
  EXPECT_FALSE(holds(false, false));
  EXPECT_FALSE(holds(false, true)) << "cycle start starts nothing";
  EXPECT_TRUE(holds(true, true));
  EXPECT_TRUE(holds(false, true)) << "held down since before";
  EXPECT_TRUE(holds(false, false));
  EXPECT_TRUE(holds(true, true)) << "both pressed: held";
  EXPECT_TRUE(holds(false, false));
  EXPECT_FALSE(holds(false, true));
  EXPECT_FALSE(holds(false, false));
}

}  // namespace
}  // namespace trammel::model
