// One feed piece from its motion.
#include "feed_piece.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace trammel::planner {
namespace {

// A smooth piece shorter than an update has an acceleration, which the card does not add. It may be beyond the field,
// which holds -0.5 to 0.5 ticks per clock and update; it then has the field's end on its own side of 0.
TEST(FeedPiece, AnAccelerationBeyondTheFieldKeepsItsSign) {
  for (const double sign : {1.0, -1.0}) {
    FeedMotion motion;
    motion.clocks = 20;
    motion.rate = 0.1;
    motion.acceleration = sign * 0.1 / 4;
    motion.end_rate = 0.1;
    const FeedPiece piece = feed_piece(motion, 2, 0, true);
    EXPECT_NEAR(static_cast<double>(piece.command.acceleration) * 0x1p-64, sign * 0.5, 1e-12);
  }
}

}  // namespace
}  // namespace trammel::planner
