// Durations and speeds of the blocks that feed pieces cover. Internal to the planner.
#pragma once

#include <cstdint>

#include "feed_motion.hpp"
#include "path_ring.hpp"

namespace trammel::planner {

// Ticks count from the start of the program.
struct TickRange {
  std::uint64_t begin;
  std::uint64_t end;
};

class BlockTimes {
 public:
  // `path` must outlive it. Its blocks get their times here.
  BlockTimes(PathRing& path, double clock_hz) : path_(path), clock_hz_(clock_hz) {}

  // The first block that moves and is not timed yet: the next piece begins in it.
  std::uint64_t next_moving();
  // Adds the next piece, after next_moving(). Its first `lead` ticks pass at the rate of the piece before. `stop`: the
  // piece ends at a stop; `short_sight`: Phase::short_sight of its phase.
  void add(const FeedMotion& motion, double lead, const TickRange& piece, bool stop, bool short_sight);

 private:
  PathRing& path_;
  double clock_hz_;
  std::uint64_t next_ = 0;  // first block that is not timed yet
  double clocks_ = 0;       // clocks of that block so far
  double rate_ = 0;         // highest rate in that block so far, ticks per clock
};

}  // namespace trammel::planner
