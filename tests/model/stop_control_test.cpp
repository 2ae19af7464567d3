// The stop control by its rules: what each event does in each state, and when it shows.
#include "trammel/model/stop_control.hpp"

#include <gtest/gtest.h>

#include "trammel/skip/control.hpp"

namespace trammel::model {
namespace {

// Nothing changes while these stay.
bool rests(const trammel::model::StopControl& stop, bool moving, bool fixed, bool at_rest) {
  trammel::model::StopControl::Inputs in;
  in.moving = moving;
  in.fixed = fixed;
  in.at_rest = at_rest;
  in.underrun = stop.made_to_hold();
  return trammel::skip::horizon(stop, in) == trammel::skip::kForever;
}

namespace reg = card_map::reg;
namespace field = card_map::field;

StopControl::Inputs none() { return {}; }
StopControl::Inputs step_fault(std::uint32_t axes) {
  StopControl::Inputs in;
  in.step_fault = axes;
  return in;
}
StopControl::Inputs mismatch() {
  StopControl::Inputs in;
  in.mismatch = true;
  return in;
}
StopControl::Inputs incomplete() {
  StopControl::Inputs in;
  in.incomplete = true;
  return in;
}
StopControl::Inputs abort_now() {
  StopControl::Inputs in;
  in.abort = true;
  return in;
}
StopControl::Inputs clear(std::uint32_t bits) {
  StopControl::Inputs in;
  in.clear = bits;
  return in;
}
StopControl::Inputs set(std::uint32_t address, std::uint32_t data) {
  StopControl::Inputs in;
  in.setting = {true, address, data};
  return in;
}

void idle(StopControl& stop, int clocks) {
  for (; clocks != 0; --clocks) stop.clock(none());
}

TEST(StopControl, NothingHappensByItself) {
  StopControl stop;
  for (int i = 0; i < 20; ++i) {
    const auto& o = stop.outputs();
    EXPECT_TRUE(!stop.stopped() && !o.hold && !o.cut && !o.stop && !o.closed && !o.stopping && o.fault == 0);
    EXPECT_TRUE(rests(stop, false, false, false));
    stop.clock(none());
  }
}

TEST(StopControl, AnImmediateEventStopsAClockLater) {
  const std::pair<StopControl::Inputs, std::uint32_t> causes[] = {{step_fault(1), 1},
                                                                  {step_fault(0x82), 0x82},
                                                                  {mismatch(), field::kFaultTickMismatch},
                                                                  {incomplete(), field::kFaultPathIncomplete}};
  for (const auto& [event, bits] : causes) {
    StopControl stop;
    stop.clock(event);
    EXPECT_EQ(stop.outputs().fault, bits);
    EXPECT_TRUE(stop.stopped());
    EXPECT_TRUE(stop.outputs().cut);
    EXPECT_TRUE(stop.outputs().stop);
    EXPECT_FALSE(stop.outputs().closed);
    stop.clock(none());
    EXPECT_FALSE(stop.outputs().cut);
    EXPECT_FALSE(stop.outputs().stop);
    EXPECT_TRUE(stop.outputs().closed);
    idle(stop, 50);
    EXPECT_TRUE(stop.stopped()) << "for as long as the fault stands";
    stop.clock(clear(~bits));
    idle(stop, 3);
    EXPECT_EQ(stop.outputs().fault, bits);
    stop.clock(clear(bits));
    EXPECT_EQ(stop.outputs().fault, 0U);
    EXPECT_TRUE(stop.stopped());
    stop.clock(none());
    EXPECT_FALSE(stop.stopped());
    EXPECT_TRUE(stop.outputs().closed);
    stop.clock(none());
    EXPECT_FALSE(stop.outputs().closed);
  }
}

TEST(StopControl, AnEventWinsOverAClearAndKeepsTheCardStopped) {
  StopControl stop;
  stop.clock(step_fault(1));
  StopControl::Inputs both = step_fault(1);
  both.clear = 1;
  stop.clock(both);
  EXPECT_EQ(stop.outputs().fault, 1U);
  EXPECT_FALSE(stop.outputs().cut) << "in STOPPED an event only sets its bit";
  EXPECT_FALSE(stop.outputs().stop);
  stop.clock(clear(1));
  stop.clock(step_fault(2));  // in the clock in which it would have gone to RUN
  EXPECT_TRUE(stop.stopped());
  idle(stop, 5);
  EXPECT_TRUE(stop.stopped());
  EXPECT_EQ(stop.outputs().fault, 2U);
}

TEST(StopControl, ARampHoldsUntilAtRest) {
  StopControl stop;
  stop.clock(set(reg::kStopReaction, 0x02));
  stop.clock(step_fault(2));
  EXPECT_FALSE(stop.stopped());
  EXPECT_TRUE(stop.outputs().stop);
  EXPECT_TRUE(stop.outputs().stopping);
  EXPECT_FALSE(stop.outputs().cut);
  EXPECT_FALSE(stop.outputs().hold);
  stop.clock(none());
  EXPECT_TRUE(stop.outputs().hold);
  EXPECT_TRUE(stop.outputs().closed);
  stop.clock(clear(2));
  stop.clock(step_fault(2));
  idle(stop, 10);
  EXPECT_TRUE(!stop.stopped() && stop.outputs().hold) << "neither a clear nor the same cause ends the ramp";
  StopControl::Inputs rest;
  rest.at_rest = true;
  stop.clock(rest);
  EXPECT_TRUE(stop.outputs().cut);
  EXPECT_FALSE(stop.outputs().stop) << "the first cause has asked for the snapshot";
  EXPECT_TRUE(stop.stopped());
  EXPECT_FALSE(stop.outputs().stopping);
  stop.clock(none());
  EXPECT_FALSE(stop.outputs().hold);
}

TEST(StopControl, AnImmediateEventOrAnAbortEndsARamp) {
  for (const auto& event : {step_fault(1), mismatch(), incomplete(), abort_now()}) {
    StopControl stop;
    stop.clock(set(reg::kStopReaction, 0xFE));
    stop.clock(step_fault(0x80));
    idle(stop, 3);
    stop.clock(event);
    EXPECT_TRUE(stop.outputs().cut);
    EXPECT_TRUE(stop.stopped());
  }
  StopControl stop;
  stop.clock(set(reg::kStopReaction, 0x80));
  stop.clock(step_fault(0x81));
  EXPECT_TRUE(stop.stopped()) << "ramped and immediate at once: immediate";
}

TEST(StopControl, AnAbortCutsInAnyState) {
  StopControl stop;
  stop.clock(abort_now());
  EXPECT_TRUE(stop.outputs().cut);
  EXPECT_FALSE(stop.stopped());
  EXPECT_FALSE(stop.outputs().stop);
  stop.clock(mismatch());
  idle(stop, 2);
  stop.clock(abort_now());
  EXPECT_TRUE(stop.outputs().cut);
  EXPECT_TRUE(stop.stopped()) << "the fault stands";
  StopControl ramping;
  ramping.clock(set(reg::kStopReaction, 1));
  StopControl::Inputs both = step_fault(1);
  both.abort = true;
  ramping.clock(both);
  EXPECT_TRUE(ramping.outputs().cut && ramping.outputs().stopping) << "an abort beside a ramped event cuts and ramps";
}

TEST(StopControl, HoldFollowsItsSettingTwoClocksLater) {
  StopControl stop;
  stop.clock(set(reg::kHold, 1));
  EXPECT_FALSE(stop.outputs().hold);
  stop.clock(none());
  EXPECT_TRUE(stop.outputs().hold);
  EXPECT_FALSE(stop.stopped());
  EXPECT_FALSE(stop.outputs().closed);
  stop.clock(set(reg::kHold, 0));
  stop.clock(none());
  EXPECT_FALSE(stop.outputs().hold);
}

struct Course {
  bool moving;
  bool fixed;
  bool at_rest;
};
constexpr Course kNothing{false, false, false};
constexpr Course kFeedPiece{true, false, false};
constexpr Course kFixedPiece{true, true, false};
constexpr Course kFixedAtRest{true, true, true};

// Clocks with these pieces; whether it holds after the last.
bool holds(StopControl& stop, const Course& course, int clocks = 2) {
  for (; clocks != 0; --clocks) {
    StopControl::Inputs in;
    in.moving = course.moving;
    in.fixed = course.fixed;
    in.at_rest = course.at_rest;
    stop.clock(in);
  }
  return stop.outputs().hold;
}

TEST(StopControl, AHoldWaitsForTheEndOfFixedPieces) {
  StopControl stop;
  EXPECT_FALSE(holds(stop, kFixedPiece));
  stop.clock(set(reg::kHold, 1));  // nothing moves in this clock, but the hold is not there yet
  EXPECT_FALSE(holds(stop, kFixedPiece, 1000));
  EXPECT_TRUE(rests(stop, true, true, false));
  EXPECT_FALSE(rests(stop, true, false, false));
  EXPECT_TRUE(holds(stop, kFeedPiece, 1)) << "in the clock after the piece's end";
  EXPECT_FALSE(holds(stop, kFixedPiece, 1)) << "on the way down another one is let end";
  EXPECT_TRUE(holds(stop, kNothing, 1));
  EXPECT_TRUE(holds(stop, kFixedPiece, 100)) << "once nothing moved, the hold stays";
  stop.clock(set(reg::kHold, 0));
  EXPECT_FALSE(holds(stop, kFixedPiece));
}

TEST(StopControl, AHoldAtRestStaysWhateverBegins) {
  for (const Course& rest : {kFixedAtRest, Course{true, false, true}, kNothing}) {
    StopControl stop;
    stop.clock(set(reg::kHold, 1));
    EXPECT_TRUE(holds(stop, rest));
    EXPECT_TRUE(rests(stop, rest.moving, rest.fixed, rest.at_rest));
    EXPECT_TRUE(holds(stop, kFixedPiece, 50));
    // Taken back and set again it begins anew.
    stop.clock(set(reg::kHold, 0));
    EXPECT_FALSE(holds(stop, kFixedPiece));
    stop.clock(set(reg::kHold, 1));
    EXPECT_TRUE(holds(stop, kNothing)) << "the setting's clock had nothing moving in it";
  }
}

TEST(StopControl, ARampedFaultAndAnAbortDoNotWaitForAFixedPiece) {
  StopControl stop;
  stop.clock(set(reg::kStopReaction, 1));
  holds(stop, kFixedPiece);
  StopControl::Inputs in = step_fault(1);
  in.moving = in.fixed = true;
  stop.clock(in);
  EXPECT_TRUE(holds(stop, kFixedPiece, 1));
  in = abort_now();
  in.moving = in.fixed = true;
  stop.clock(in);
  EXPECT_TRUE(stop.outputs().cut);
}

}  // namespace
}  // namespace trammel::model
