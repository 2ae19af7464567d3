#include "path_progress.hpp"

#include <algorithm>

#include "trammel/driver/feed_time.hpp"

namespace trammel::linuxcnc {

void QueuedTime::put(std::uint32_t first, std::size_t line, double seconds) {
  entries_.push_back({first, line, seconds});
  waiting_ += seconds;
}

void QueuedTime::look(std::uint32_t begun, double now) {
  while (!entries_.empty() && static_cast<std::int32_t>(begun - entries_.front().first) >= 0) {
    line_ = entries_.front().line;
    seconds_ = entries_.front().seconds;
    begun_ = now;
    waiting_ -= seconds_;
    entries_.pop_front();
  }
  if (entries_.empty()) waiting_ = 0;
  under_way_ = std::max(0.0, seconds_ - (now - begun_));
}

void PathProgress::sending(const planner::PlannedBlock& block) {
  any_sent_ = true;
  geometry_.put(geometry_commands_ + 1, block.block.line, block.seconds / most_override_);
}

void PathProgress::command(std::uint64_t /*number*/, const driver::Command& command) {
  if (!driver::counts_as_begun(command)) return;
  const card_map::Command& layout = driver::layout_of(command);
  if (layout.to_geometry) ++geometry_commands_;
  if (!layout.to_feed) return;
  const auto* piece = std::get_if<driver::FeedCommand>(&command);
  const auto* dwell = std::get_if<driver::DwellCommand>(&command);
  const double clocks = piece != nullptr   ? driver::feed_clocks(*piece)
                        : dwell != nullptr ? static_cast<double>(dwell->clocks)
                                           : 0;
  feed_.put(++feed_commands_, 0, clocks / clock_hz_);
}

void PathProgress::look(const driver::Snapshot& now) {
  const double seconds = static_cast<double>(now.time) / clock_hz_;
  geometry_.look(now.geometry_begun, seconds);
  feed_.look(now.feed_begun, seconds);
}

double PathProgress::seconds_left() const { return std::min(geometry_.seconds_left(), feed_.seconds_left()); }

}  // namespace trammel::linuxcnc
