#include "queued_paths.hpp"

#include <algorithm>

namespace trammel::planner {

// The commands of a block count as equally long in ticks. A piece may begin anywhere in a block.
double QueuedPaths::held(std::uint64_t index, std::uint64_t tick) {
  const auto fit = static_cast<double>(halfwords_);
  const PathEntry& begin = path_[index];
  const std::uint64_t ticks = begin.end_ticks - begin.begin_ticks;
  const double share = ticks > 0 ? static_cast<double>(tick - begin.begin_ticks) / static_cast<double>(ticks) : 0;
  const double gone = share * static_cast<double>(begin.halfwords);
  const auto before = [&](const PathEntry& block) { return static_cast<double>(block.queued - begin.queued) - gone; };
  last_ = std::max(last_, index);
  while (last_ + 1 != path_.end() && before(path_[last_ + 1]) < fit) ++last_;
  const PathEntry& end = path_[last_];
  const double part = (fit - before(end)) / static_cast<double>(end.halfwords);
  if (part >= 1 && last_ + 1 == path_.end() && ended_) return kUnlimited;
  return static_cast<double>(end.begin_ticks) +
         std::min(part, 1.0) * static_cast<double>(end.end_ticks - end.begin_ticks);
}

}  // namespace trammel::planner
