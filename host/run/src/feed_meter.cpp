#include "trammel/run/feed_meter.hpp"

#include <variant>

namespace trammel::run {

void FeedMeter::sending(const planner::PlannedBlock& planned) {
  const planner::Block& block = planned.block;
  block_ = !planner::moves(block) ? Kind::kBarrier : (block.wanted > 0 ? Kind::kFeed : Kind::kRapid);
  if (block_ != Kind::kFeed) return;
  length_ += block.length;
  wanted_seconds_ += block.length / block.wanted;
}

void FeedMeter::command(std::uint64_t number, const driver::Command& command) {
  const bool moves_or_waits = driver::counts_as_begun(command) && !std::holds_alternative<driver::FeedCommand>(command);
  if (moves_or_waits) sent_.push_back({number, block_});
}

void FeedMeter::path_step(const driver::PathStep& step) {
  while (sent_.size() > 1 && sent_.front().number < step.command) {
    if (sent_.front().kind == Kind::kBarrier) last_.reset();
    sent_.pop_front();
  }
  if (last_ && !sent_.empty() && sent_.front().kind == Kind::kFeed) clocks_ += step.cycle - *last_;
  last_ = step.cycle;
}

std::optional<double> FeedMeter::per_minute(double seconds) const {
  constexpr double kMinute = 60;
  if (!(length_ > 0) || !(seconds > 0)) return std::nullopt;
  return length_ / seconds * kMinute;
}

}  // namespace trammel::run
