#include "speed_window.hpp"

#include <algorithm>

namespace trammel::planner {
namespace {

RampLimits limits_of(const Span& span) { return {span.acceleration, span.jerk}; }

// Whether `limits` became lower.
bool lower(RampLimits& limits, RampLimits other) {
  const bool lowers = other.acceleration < limits.acceleration || other.jerk < limits.jerk;
  limits = {std::min(limits.acceleration, other.acceleration), std::min(limits.jerk, other.jerk)};
  return lowers;
}

}  // namespace

SpeedWindow::SpeedWindow(std::size_t spans) : most_(spans) {
  spans_.reserve(spans);
  positions_.reserve(spans + 1);
  blocks_.reserve(spans / kBlock + 1);
}

std::size_t SpeedWindow::drop_before(double position) {
  // What rounding leaves of a span is not a span.
  const double nearly = position + length() * 0x1p-44;
  const auto border = std::upper_bound(positions_.begin() + 1, positions_.end(), nearly);
  const auto passed = border - positions_.begin() - 1;
  spans_.erase(spans_.begin(), spans_.begin() + passed);
  if (!spans_.empty()) spans_.front().length = std::min(spans_.front().length, *border - position);
  return static_cast<std::size_t>(passed);
}

void SpeedWindow::index() {
  positions_.assign(1, 0);
  blocks_.clear();
  lowest_ = highest_ = limits_of(spans_.front());
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    positions_.push_back(positions_.back() + spans_[i].length);
    const RampLimits limits = limits_of(spans_[i]);
    if (i % kBlock == 0) blocks_.push_back(limits);
    lower(blocks_.back(), limits);
    lower(lowest_, limits);
    highest_ = {std::max(highest_.acceleration, limits.acceleration), std::max(highest_.jerk, limits.jerk)};
  }
  uniform_ = lowest_.acceleration == highest_.acceleration && lowest_.jerk == highest_.jerk;
}

template <typename Length>
SpeedWindow::Fit SpeedWindow::forwards(double begin, Length wanted) const {
  if (uniform_) return {wanted(lowest_), lowest_};
  std::size_t i = static_cast<std::size_t>(std::upper_bound(positions_.begin() + 1, positions_.end() - 1, begin) -
                                           positions_.begin()) -
                  1;
  Fit fit;
  fit.limits = limits_of(spans_[i]);
  fit.length = wanted(fit.limits);
  while (positions_[i + 1] - begin < fit.length && ++i < spans_.size()) {
    RampLimits next = limits_of(spans_[i]);
    if (i % kBlock == 0 && i + kBlock <= spans_.size() && positions_[i + kBlock] - begin < fit.length) {
      next = blocks_[i / kBlock];
      i += kBlock - 1;
    }
    if (lower(fit.limits, next)) fit.length = wanted(fit.limits);
  }
  return fit;
}

template <typename Length>
SpeedWindow::Fit SpeedWindow::backwards(double end, Length wanted) const {
  if (uniform_) return {wanted(lowest_), lowest_};
  std::size_t i = static_cast<std::size_t>(std::lower_bound(positions_.begin() + 1, positions_.end() - 1, end) -
                                           positions_.begin()) -
                  1;
  Fit fit;
  fit.limits = limits_of(spans_[i]);
  fit.length = wanted(fit.limits);
  while (end - positions_[i] < fit.length && i > 0) {
    --i;
    RampLimits next = limits_of(spans_[i]);
    if ((i + 1) % kBlock == 0 && end - positions_[i + 1 - kBlock] < fit.length) {
      next = blocks_[i / kBlock];
      i -= kBlock - 1;
    }
    if (lower(fit.limits, next)) fit.length = wanted(fit.limits);
  }
  return fit;
}

RampLimits SpeedWindow::limits(double begin, double end) const {
  return forwards(begin, [=](RampLimits) { return end - begin; }).limits;
}

SpeedWindow::Fit SpeedWindow::rising(double begin, double low, double high) const {
  return forwards(begin, [=](RampLimits limits) { return ramp_length(low, high, limits); });
}

SpeedWindow::Fit SpeedWindow::falling(double end, double high, double low) const {
  return backwards(end, [=](RampLimits limits) { return ramp_length(low, high, limits); });
}

double SpeedWindow::reach_rising(double begin, double low, double high) const {
  return forwards(begin, [=](RampLimits limits) { return reach_length(low, high, limits); }).length;
}

double SpeedWindow::reach_falling(double end, double high, double low) const {
  return backwards(end, [=](RampLimits limits) { return reach_length(low, high, limits); }).length;
}

}  // namespace trammel::planner
