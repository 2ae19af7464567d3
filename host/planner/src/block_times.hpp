// Durations and speeds of the blocks that feed pieces cover. Internal to the planner.
#pragma once

#include <cstdint>

#include "feed_motion.hpp"
#include "path_ring.hpp"

namespace trammel::planner {

// Ticks from the start of the program on.
struct TickRange {
  std::uint64_t begin;
  std::uint64_t end;
};

class BlockTimes {
 public:
  // `path` must outlive it; its blocks get their times.
  BlockTimes(PathRing& path, double clock_hz) : path_(path), clock_hz_(clock_hz) {}

  // The first block that moves and is not timed yet: the next piece begins in it.
  std::uint64_t next_moving();
  // Pieces in order, after next_moving(). The first `lead` ticks pass at the rate of the piece before; `stop`: the
  // piece ends at one; `short_sight`: of the phase (Phase::short_sight).
  void add(const FeedMotion& motion, double lead, const TickRange& piece, bool stop, bool short_sight);

 private:
  PathRing& path_;
  double clock_hz_;
  std::uint64_t next_ = 0;  // block that is not timed yet
  double clocks_ = 0;       // of it, so far
  double rate_ = 0;         // the highest in it, so far; ticks per clock
};

}  // namespace trammel::planner
