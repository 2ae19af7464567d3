// Collects the motions that do not reach their programmed feed: one entry per cause, however long the program is. Not
// thread-safe.
#pragma once

#include <array>
#include <vector>

#include "trammel/planner/planner.hpp"

namespace trammel::run {

// Blocks that do not reach their programmed feed for the same cause.
struct FeedNotReached {
  planner::SpeedLimit cause = planner::SpeedLimit::kNone;
  std::uint64_t count = 0;
  // The block that reaches the smallest fraction of its feed; the first of them if several do.
  std::size_t line = 0;
  double wanted = 0;   // mm/min, as programmed by F
  double reached = 0;  // mm/min
};

class FeedReport {
 public:
  void add(const planner::PlannedBlock& planned);
  // Sorted by number of blocks, the most frequent cause first.
  std::vector<FeedNotReached> entries() const;

 private:
  std::array<FeedNotReached, planner::kSpeedLimits> entries_{};
};

}  // namespace trammel::run
