#include "trammel/run/path_identity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace trammel::run {

std::string PathIdentity::text() const { return fmt::format("{:016x}", hash_); }

std::string PathIdentity::unnumbered_text() const { return fmt::format("{:016x}", unnumbered_); }

std::string PathIdentity::order_text() const { return fmt::format("{:016x}", order_); }

void ShaperDelay::pin_step(const driver::PinStep& step) {
  std::deque<driver::PathStep>& waiting = waiting_[step.axis];
  if (waiting.empty() || waiting.front().direction != step.direction || waiting.front().cycle > step.cycle) {
    throw std::runtime_error(
        fmt::format("axis {}: a pulse in clock {} that no step of the path asked for", step.axis, step.cycle));
  }
  const std::uint64_t delay = step.cycle - waiting.front().cycle;
  waiting.pop_front();
  if (!range_) range_ = Range{delay, delay};
  range_->least = std::min(range_->least, delay);
  range_->most = std::max(range_->most, delay);
}

void ShaperDelay::finish() const {
  for (std::size_t axis = 0; axis < waiting_.size(); ++axis) {
    if (waiting_[axis].empty()) continue;
    throw std::runtime_error(
        fmt::format("axis {}: {} steps of the path have made no pulse", axis, waiting_[axis].size()));
  }
}

}  // namespace trammel::run
