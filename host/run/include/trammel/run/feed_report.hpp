// Gathers the feeds that a program does not reach: one entry a cause, however long the program. Not thread-safe.
#pragma once

#include <array>
#include <vector>

#include "trammel/planner/planner.hpp"

namespace trammel::run {

// Blocks that do not reach their programmed feed for one cause.
struct FeedNotReached {
  planner::SpeedLimit cause = planner::SpeedLimit::kNone;
  std::uint64_t count = 0;
  // The first block of those that reach the smallest share of it.
  std::size_t line = 0;
  double wanted = 0;   // mm/min, as F counts
  double reached = 0;  // mm/min
};

class FeedReport {
 public:
  void add(const planner::PlannedBlock& planned);
  // The cause of most blocks first.
  std::vector<FeedNotReached> entries() const;

 private:
  std::array<FeedNotReached, planner::kSpeedLimits> entries_{};
};

}  // namespace trammel::run
