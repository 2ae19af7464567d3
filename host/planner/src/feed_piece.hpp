// A feed piece as the card gets it, from its motion. Internal to the planner; pure.
//
// The feed generator holds a rate for one update (32 clocks) and then adds the acceleration, and to that the jerk: the
// rates of a piece are the means of the planned rate over each update, so that positions at whole updates are the
// plan's.
#pragma once

#include <cstdint>

#include "feed_motion.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"

namespace trammel::planner {

inline constexpr double kUpdate = card_map::constant::kUpdateClocks;
// The card goes on at a piece's last rate for so many clocks after its last tick; these ticks are the next piece's.
inline constexpr double kSwapClocks = 6;

struct FeedPiece {
  driver::FeedCommand command;
  double highest_rate = 0;  // ticks per clock
  double clocks = 0;
  std::uint64_t block = 0;  // where it begins
  std::uint64_t begin = 0;  // tick
  bool stop = false;
};

// Of `ticks`, the first `lead` of which pass before `motion` begins. `smooth`: acceleration has no jumps.
FeedPiece feed_piece(const FeedMotion& motion, std::uint64_t ticks, double lead, bool smooth);

// Ticks, and the part of one, that the card goes beyond the piece's last one before the next piece's rate is in force,
// when `motion` began `lead` ticks into it: rate, acceleration and jerk as they are sent, update by update.
double overshoot(const driver::FeedCommand& command, const FeedMotion& motion, double lead);

}  // namespace trammel::planner
