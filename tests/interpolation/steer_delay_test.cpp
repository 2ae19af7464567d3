// The delay of STEER against the list in the paper, and its defects.
#include "trammel/interpolation/steer_delay.hpp"

#include <gtest/gtest.h>

namespace trammel::interpolation {
namespace {

TEST(SteerDelay, DragFallsAsListed) {
  SteerDelay delay(300);
  delay.arm();
  for (const std::int32_t drag : {100, 99, 99, 98, 94, 85, 69, 44, 8, 0, 0, 0}) {
    EXPECT_EQ(delay.drag(), drag);
    EXPECT_EQ(delay.delay(), (300 + drag) / 30);
  }
}

TEST(SteerDelay, LargerFeedrateIsALongerDelay) {
  SteerDelay slow(600);
  SteerDelay fast(300);
  EXPECT_GT(*slow.delay(), *fast.delay());
}

TEST(SteerDelay, BelowThirtyTheLoopRunsUntilItWraps) {
  for (const std::int32_t feedrate : {0, 1, 29}) {
    SteerDelay delay(feedrate);
    EXPECT_EQ(delay.passes(), 0);
    EXPECT_FALSE(delay.delay());
  }
  EXPECT_EQ(SteerDelay(30).delay(), 1);
  // On a line this does not show at first, because the drag fills up what is missing.
  SteerDelay line(20);
  line.arm();
  int steps = 0;
  while (line.delay()) ++steps;
  EXPECT_EQ(steps, 8);
}

TEST(SteerDelay, ACircleHasNoRampOrALinesLeftOvers) {
  SteerDelay circle(300);
  EXPECT_EQ(circle.drag(), 0);
  EXPECT_EQ(circle.delay(), 10);
  SteerDelay after_line(300);
  after_line.arm();
  for (int i = 0; i < 5; ++i) after_line.delay();
  EXPECT_EQ(after_line.drag(), 85);
}

}  // namespace
}  // namespace trammel::interpolation
