// Makes the command of a feed piece from its motion. Internal to the planner; pure.
//
// The feed generator holds a rate for one update (32 clocks). Then it adds the acceleration to the rate, and the jerk
// to the acceleration. So the rates of a piece are the means of the planned rate over each update, and the positions at
// whole updates are those of the plan.
#pragma once

#include <cstdint>

#include "feed_motion.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/driver/feed_ramp.hpp"

namespace trammel::planner {

inline constexpr double kUpdate = card_map::constant::kUpdateClocks;
using driver::kFeedSwapDelay;

struct FeedPiece {
  driver::FeedCommand command;
  double highest_rate = 0;  // ticks per clock
  double clocks = 0;
  std::uint64_t block = 0;  // block in which it begins
  std::uint64_t begin = 0;  // tick at which it begins
  bool stop = false;
};

// A piece of `ticks`, of which the first `lead` pass before `motion` begins. `smooth`: acceleration has no jumps.
FeedPiece feed_piece(const FeedMotion& motion, std::uint64_t ticks, double lead, bool smooth);

// Ticks, with fraction, that the card makes after the piece's last tick until the next piece's rate is in force.
// Computed update by update, with rate, acceleration and jerk as sent. `motion` begins `lead` ticks into the piece.
double overshoot(const driver::FeedCommand& command, const FeedMotion& motion, double lead);

}  // namespace trammel::planner
