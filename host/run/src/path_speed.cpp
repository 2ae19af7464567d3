#include "trammel/run/path_speed.hpp"

#include <algorithm>
#include <cmath>

namespace trammel::run {

void PathSpeed::spread(Bins& bins, double bin_width, const Waiting& step, std::size_t axis, double after) {
  constexpr double kStoodStill = 4;
  double before = step.interval > 0 ? step.interval : after;
  if (after == 0) after = before;
  if (before > kStoodStill * after) before = after;
  if (after > kStoodStill * before) after = before;
  const double from = std::max(0.0, step.cycle - before / 2);
  const double to = std::max(from + 1, step.cycle + after / 2);
  const double density = step.way / (to - from);
  const auto last = std::min(bins.size() - 1, static_cast<std::size_t>(to / bin_width));
  for (auto bin = static_cast<std::size_t>(from / bin_width); bin <= last; ++bin) {
    const double begin = std::max(from, static_cast<double>(bin) * bin_width);
    const double end = std::min(to, static_cast<double>(bin + 1) * bin_width);
    if (end > begin) bins[bin][axis] += density * (end - begin);
  }
}

void PathSpeed::widen(double end) {
  while (end >= bin_width_ * kBins) {
    for (std::size_t i = 0; i < kBins / 2; ++i) {
      for (std::size_t a = 0; a < kAxes; ++a) bins_[i][a] = bins_[2 * i][a] + bins_[2 * i + 1][a];
    }
    std::fill(bins_.begin() + kBins / 2, bins_.end(), std::array<double, kAxes>{});
    bin_width_ *= 2;
  }
}

void PathSpeed::add(std::uint64_t cycle, std::size_t axis, double way) {
  Waiting& step = waiting_[axis];
  const auto now = static_cast<double>(cycle);
  const double interval = step.any ? std::max(1.0, now - step.cycle) : 0;
  // The step is spread over at most half of the interval after it, so it does not extend beyond this step.
  widen(now + 1);
  if (step.any) spread(bins_, bin_width_, step, axis, interval);
  step = {true, now, way, interval};
}

std::vector<PathSpeed::Sample> PathSpeed::samples() const {
  Bins bins = bins_;
  for (std::size_t a = 0; a < kAxes; ++a) {
    if (waiting_[a].any) spread(bins, bin_width_, waiting_[a], a, 0);
  }
  std::vector<Sample> result;
  // A short run has bins of about a clock: fewer bins are combined, so that there are enough samples.
  std::size_t used = kBins;
  while (used > 0 && bins[used - 1] == std::array<double, kAxes>{}) --used;
  const std::size_t together = std::max<std::size_t>(1, (used + kBins / kFine - 1) / (kBins / kFine));
  const double width = bin_width_ * static_cast<double>(together) / clock_hz_;
  for (std::size_t i = 0; i < used; i += together) {
    double way = 0;
    for (std::size_t j = i; j < i + together && j < kBins; ++j) way += std::hypot(bins[j][0], bins[j][1], bins[j][2]);
    result.push_back({(static_cast<double>(i / together) + 0.5) * width, way / width});
  }
  return result;
}

}  // namespace trammel::run
