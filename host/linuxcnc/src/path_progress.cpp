#include "path_progress.hpp"

#include <algorithm>

namespace trammel::linuxcnc {

void PathProgress::sending(const planner::PlannedBlock& block) {
  any_sent_ = true;
  sent_.push_back({block.block.line, block.seconds, commands_ + 1});
  waiting_ += block.seconds;
}

void PathProgress::command(std::uint64_t /*number*/, const driver::Command& command) {
  const bool geometry = !std::holds_alternative<driver::FeedCommand>(command);
  if (geometry && driver::counts_as_begun(command)) ++commands_;
}

void PathProgress::look(const driver::Snapshot& now) {
  while (!sent_.empty() && static_cast<std::int32_t>(now.geometry_begun - sent_.front().first) >= 0) {
    line_ = sent_.front().line;
    block_ = sent_.front().seconds;
    begun_ = now.time;
    waiting_ -= sent_.front().seconds;
    sent_.pop_front();
  }
  if (sent_.empty()) waiting_ = 0;
  const double since = static_cast<double>(now.time - begun_) / clock_hz_;
  under_way_ = line_ == 0 ? 0 : std::max(0.0, block_ - since * most_override_);
}

}  // namespace trammel::linuxcnc
