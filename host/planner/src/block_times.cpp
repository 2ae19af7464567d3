#include "block_times.hpp"

#include <algorithm>

#include "feed_piece.hpp"

namespace trammel::planner {

std::uint64_t BlockTimes::next_moving() {
  while (!moves(path_[next_].block)) ++next_;
  return next_;
}

void BlockTimes::add(const FeedMotion& motion, double lead, const TickRange& piece, bool stop, bool short_sight) {
  const double swap = lead > 0 ? kFeedSwapDelay : 0;
  const double ticks = static_cast<double>(piece.end - piece.begin);
  double before = -swap;
  rate_ = std::max(rate_, motion.rate);
  for (bool more = true; more;) {
    PathEntry& block = path_[next_];
    block.short_sight = short_sight || (clocks_ != 0 && block.short_sight);
    const bool ends = block.end_ticks <= piece.end;
    const double share = ends ? static_cast<double>(block.end_ticks - piece.begin) : ticks;
    FeedInstant at{motion.clocks, motion.end_rate};
    if (share <= lead) {
      at = {swap * (share / lead - 1), motion.rate};
    } else if (share < ticks) {
      at = instant(motion, share - lead, ticks - lead);
    }
    rate_ = std::max(rate_, at.rate);
    const double turning = motion.acceleration + before * motion.jerk > 0 ? turning_rate(motion) : 0;
    if (motion.acceleration + at.clocks * motion.jerk < 0) rate_ = std::max(rate_, turning);
    clocks_ += at.clocks - before;
    before = at.clocks;
    if (!ends) break;
    block.seconds = clocks_ / clock_hz_;
    block.speed = rate_ * clock_hz_ / block.density;
    block.end_speed = block.stop ? 0 : at.rate * clock_hz_ / block.density;
    block.timed = true;
    clocks_ = 0;
    rate_ = block.stop ? 0 : at.rate;
    more = share < ticks && !block.stop;
    ++next_;
  }
  if (stop) rate_ = 0;
}

}  // namespace trammel::planner
