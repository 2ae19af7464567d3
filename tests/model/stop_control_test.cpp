// The stop control's model against the page's sentences: what stops at once and what ramps, who wins, and that clearing
// never lets go while anything is left.
#include "trammel/model/stop_control.hpp"

#include <gtest/gtest.h>

namespace trammel::model {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

class Stop {
 public:
  const StopControl::Outputs& clock(const StopControl::Inputs& in = {}) {
    stop_.clock(in);
    cuts += stop_.outputs().cut ? 1 : 0;
    stops += stop_.outputs().stop ? 1 : 0;
    return stop_.outputs();
  }
  const StopControl::Outputs& set(std::uint32_t address, std::uint32_t data) {
    StopControl::Inputs in;
    in.setting = {true, address, data};
    return clock(in);
  }
  const StopControl::Outputs& step_fault(std::uint32_t axes) {
    StopControl::Inputs in;
    in.step_fault = axes;
    return clock(in);
  }
  const StopControl::Outputs& clear(std::uint32_t ones = ~0U, std::uint32_t step_fault = 0) {
    StopControl::Inputs in;
    in.clear = ones;
    in.step_fault = step_fault;
    return clock(in);
  }
  const StopControl::Outputs& abort() {
    StopControl::Inputs in;
    in.abort = true;
    return clock(in);
  }
  int cuts = 0;
  int stops = 0;

 private:
  StopControl stop_;
};

TEST(StopControl, AnEventCutsAtOnceAndAsksForOneSnapshot) {
  Stop stop;
  EXPECT_TRUE(stop.clock().go);
  const StopControl::Outputs out = stop.step_fault(4);
  EXPECT_EQ(out.fault, 4U);
  EXPECT_TRUE(out.cut && out.stop && !out.go && !out.stopping);
  EXPECT_FALSE(out.closed);  // a clock later
  EXPECT_TRUE(stop.clock().closed);
  stop.step_fault(1);
  EXPECT_EQ(stop.cuts, 1);
  EXPECT_EQ(stop.stops, 1);
}

TEST(StopControl, ARampedEventHoldsUntilTheRatioIsZero) {
  Stop stop;
  stop.set(reg::kStopReaction, 2);
  EXPECT_TRUE(stop.step_fault(2).stopping);
  const StopControl::Outputs ramp = stop.clock();
  EXPECT_TRUE(ramp.go && ramp.hold && ramp.closed && !ramp.cut);
  for (int i = 0; i < 50; ++i) EXPECT_FALSE(stop.clock().cut);
  StopControl::Inputs at_rest;
  at_rest.at_rest = true;
  const StopControl::Outputs out = stop.clock(at_rest);
  EXPECT_TRUE(out.cut && !out.go && !out.stopping);
  EXPECT_EQ(stop.stops, 1);
}

TEST(StopControl, AnImmediateEventOrAnAbortEndsTheRamp) {
  for (const bool abort : {false, true}) {
    Stop stop;
    stop.set(reg::kStopReaction, 2);
    stop.step_fault(2);
    const StopControl::Outputs out = abort ? stop.abort() : stop.step_fault(1);
    EXPECT_TRUE(out.cut && !out.go);
    EXPECT_EQ(stop.stops, 1);
  }
}

TEST(StopControl, MismatchAndIncompleteAreImmediateWhateverTheReactionIs) {
  for (const bool mismatch : {false, true}) {
    Stop stop;
    stop.set(reg::kStopReaction, ~0U);
    StopControl::Inputs in;
    in.mismatch = mismatch;
    in.incomplete = !mismatch;
    const StopControl::Outputs out = stop.clock(in);
    EXPECT_TRUE(out.cut);
    EXPECT_EQ(out.fault, mismatch ? field::kFaultTickMismatch : field::kFaultPathIncomplete);
  }
}

TEST(StopControl, AnAbortWithoutFaultCutsAndGoesOn) {
  Stop stop;
  const StopControl::Outputs out = stop.abort();
  EXPECT_TRUE(out.cut && out.go && !out.stop);
  EXPECT_FALSE(stop.clock().closed);
}

TEST(StopControl, ClearAndAbortInEitherOrderOpen) {
  for (const bool abort_first : {false, true}) {
    Stop stop;
    stop.step_fault(1);
    if (abort_first) stop.abort();
    stop.clear();
    if (!abort_first) stop.abort();
    for (int i = 0; i < 3; ++i) stop.clock();
    EXPECT_TRUE(stop.clock().go);
    EXPECT_FALSE(stop.clock().closed);
    EXPECT_EQ(stop.cuts, 2);
  }
}

TEST(StopControl, AnEventWinsOverAClearBesideIt) {
  Stop stop;
  stop.step_fault(3);
  EXPECT_EQ(stop.clear(~0U, 2).fault, 2U);
  EXPECT_EQ(stop.clear(1).fault, 2U);
  EXPECT_FALSE(stop.clock().go);
  stop.clear(2);
  EXPECT_TRUE(stop.clock().go);
}

TEST(StopControl, HoldHoldsWithoutClosing) {
  Stop stop;
  stop.set(reg::kHold, 1);
  const StopControl::Outputs out = stop.clock();
  EXPECT_TRUE(out.hold && out.go && !out.closed);
  stop.set(reg::kHold, 0);
  EXPECT_FALSE(stop.clock().hold);
}

}  // namespace
}  // namespace trammel::model
