// The rules of the stop control: the effect of each event in each state, and the clock in which it shows.
#include "trammel/model/stop_control.hpp"

#include <gtest/gtest.h>

#include "trammel/skip/control.hpp"

namespace trammel::model {
namespace {

// True when nothing changes while these inputs stay.
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

// Clocks until the cut while nothing moves; 0 if the cut is already visible.
int clocks_to_cut(StopControl& stop) {
  int clocks = 0;
  for (; !stop.outputs().cut && clocks < 100; ++clocks) stop.clock(none());
  return clocks;
}
// Clocks from the first clock of a stop to the cut. The request of its snapshot restarts the count, and the cut comes
// one clock after the count ends.
constexpr int kToCut = StopControl::kSettleClocks + 2;

TEST(StopControl, AnImmediateEventShutsTheGateAClockLaterAndCutsWhenNothingMoves) {
  const std::pair<StopControl::Inputs, std::uint32_t> causes[] = {{step_fault(1), 1},
                                                                  {step_fault(0x82), 0x82},
                                                                  {mismatch(), field::kFaultTickMismatch},
                                                                  {incomplete(), field::kFaultPathIncomplete}};
  for (const auto& [event, bits] : causes) {
    StopControl stop;
    stop.clock(event);
    EXPECT_EQ(stop.outputs().fault, bits);
    EXPECT_TRUE(stop.shut() && stop.closing() && stop.outputs().stopping);
    EXPECT_FALSE(stop.outputs().cut);
    EXPECT_TRUE(stop.outputs().stop);
    EXPECT_FALSE(stop.outputs().closed);
    stop.clock(none());
    EXPECT_FALSE(stop.outputs().stop);
    EXPECT_TRUE(stop.outputs().closed);
    EXPECT_EQ(clocks_to_cut(stop), kToCut - 1);
    EXPECT_TRUE(stop.stopped() && stop.shut());
    EXPECT_FALSE(stop.outputs().stopping);
    stop.clock(none());
    EXPECT_FALSE(stop.outputs().cut);
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

TEST(StopControl, TheCutWaitsForTheLastPulseAndRestIsAskedForAClockBefore) {
  for (const int moving : {0, 1, 7, 500}) {
    StopControl stop;
    stop.clock(step_fault(1));
    for (int i = 0; i < moving; ++i) {
      StopControl::Inputs in;
      in.pulses = i % 2 == 0;
      in.quiet = i % 2 == 0;
      EXPECT_FALSE(stop.rests(in));
      stop.clock(in);
      EXPECT_FALSE(stop.outputs().cut);
    }
    const int expected = moving == 0 ? kToCut : kToCut - 1;
    for (int i = 1; i < expected; ++i) {
      EXPECT_FALSE(stop.rests(none()));
      stop.clock(none());
      EXPECT_FALSE(stop.outputs().cut);
    }
    EXPECT_TRUE(stop.rests(none())) << "its strobe is in the clock of the cut";
    EXPECT_TRUE(stop.settled());
    stop.clock(none());
    EXPECT_TRUE(stop.outputs().cut);
  }
}

TEST(StopControl, AnEventWinsOverAClearAndKeepsTheCardStopped) {
  StopControl stop;
  stop.clock(step_fault(1));
  clocks_to_cut(stop);
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

TEST(StopControl, ACauseWhileTheGateIsShutOnlySetsItsBit) {
  StopControl stop;
  stop.clock(step_fault(1));
  idle(stop, 10);
  StopControl::Inputs in = mismatch();
  in.abort = true;
  stop.clock(in);
  EXPECT_EQ(stop.outputs().fault, 1U | field::kFaultTickMismatch);
  EXPECT_FALSE(stop.outputs().cut || stop.outputs().stop);
  EXPECT_EQ(clocks_to_cut(stop), kToCut - 11) << "neither is the wait longer, nor does an abort shorten it";
}

TEST(StopControl, ARampHoldsUntilAtRest) {
  StopControl stop;
  stop.clock(set(reg::kStopReaction, 0x02));
  stop.clock(step_fault(2));
  EXPECT_FALSE(stop.shut());
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
  EXPECT_TRUE(!stop.shut() && stop.outputs().hold) << "neither a clear nor the same cause ends the ramp";
  StopControl::Inputs rest;
  rest.at_rest = true;
  stop.clock(rest);
  EXPECT_TRUE(stop.shut());
  EXPECT_FALSE(stop.outputs().stop) << "the first cause has asked for the snapshot";
  int clocks = 0;
  for (; !stop.outputs().cut && clocks < 100; ++clocks) {
    EXPECT_TRUE(stop.outputs().hold && stop.outputs().stopping) << "the ratio stays 0 until the cut";
    stop.clock(rest);
  }
  EXPECT_EQ(clocks, static_cast<int>(StopControl::kSettleClocks));
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
    EXPECT_TRUE(stop.shut());
    EXPECT_FALSE(stop.outputs().cut);
    EXPECT_EQ(clocks_to_cut(stop), kToCut - 1);
    EXPECT_TRUE(stop.stopped());
  }
  StopControl stop;
  stop.clock(set(reg::kStopReaction, 0x80));
  stop.clock(step_fault(0x81));
  EXPECT_TRUE(stop.shut()) << "ramped and immediate at once: immediate";
}

TEST(StopControl, AnAbortCutsAtOnceUnlessAFaultIsOnItsWayToACut) {
  StopControl stop;
  EXPECT_FALSE(stop.rests(abort_now())) << "there is nothing to drop";
  StopControl::Inputs busy = abort_now();
  busy.busy = true;
  EXPECT_TRUE(stop.rests(busy));
  stop.clock(abort_now());
  EXPECT_TRUE(stop.outputs().cut);
  EXPECT_FALSE(stop.shut());
  EXPECT_FALSE(stop.outputs().stop);
  stop.clock(mismatch());
  clocks_to_cut(stop);
  idle(stop, 2);
  EXPECT_FALSE(stop.rests(busy)) << "the fault's REST stands";
  stop.clock(abort_now());
  EXPECT_TRUE(stop.outputs().cut);
  EXPECT_TRUE(stop.stopped()) << "the fault stands";
  StopControl ramping;
  ramping.clock(set(reg::kStopReaction, 1));
  StopControl::Inputs both = step_fault(1);
  both.abort = true;
  ramping.clock(both);
  EXPECT_TRUE(!ramping.outputs().cut && ramping.shut()) << "an abort beside a ramped event shuts the gate";
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

// Clocks with these pieces; true when the card holds after the last one.
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
  stop.clock(set(reg::kHold, 1));  // nothing moves in this clock, but the hold is not active yet
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
    EXPECT_TRUE(holds(stop, rest, 40));
    EXPECT_TRUE(rests(stop, rest.moving, rest.fixed, rest.at_rest));
    EXPECT_TRUE(holds(stop, kFixedPiece, 50));
    // A hold that is cleared and set again starts again.
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
  EXPECT_TRUE(stop.shut());
}

}  // namespace
}  // namespace trammel::model
