#include "trammel/run/feed_report.hpp"

#include <algorithm>

namespace trammel::run {

void FeedReport::add(const planner::PlannedBlock& planned) {
  if (planned.limit == planner::SpeedLimit::kNone) return;
  constexpr double kMinute = 60;
  FeedNotReached& entry = entries_[static_cast<std::size_t>(planned.limit)];
  entry.cause = planned.limit;
  const double wanted = planned.block.feed * kMinute;
  const double reached = wanted * planned.speed / planned.block.wanted;
  if (entry.count++ != 0 && reached * entry.wanted >= entry.reached * wanted) return;
  entry.line = planned.block.line;
  entry.wanted = wanted;
  entry.reached = reached;
}

std::vector<FeedNotReached> FeedReport::entries() const {
  std::vector<FeedNotReached> result;
  for (const FeedNotReached& entry : entries_) {
    if (entry.count != 0) result.push_back(entry);
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const FeedNotReached& a, const FeedNotReached& b) { return a.count > b.count; });
  return result;
}

}  // namespace trammel::run
