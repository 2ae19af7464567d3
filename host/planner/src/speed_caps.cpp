#include "speed_caps.hpp"

#include <algorithm>
#include <limits>

namespace trammel::planner {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

SpeedCaps::SpeedCaps(std::size_t spans) {
  spans_.reserve(spans);
  corners_.reserve(spans);
  caps_.reserve(2 * spans);
  open_.reserve(2 * spans);
}

int SpeedCaps::build(const SpeedWindow& window, double start) {
  spans_.clear();
  corners_.clear();
  caps_.clear();
  for (std::size_t i = 0; i < window.size(); ++i) spans_.push_back(window[i].speed);
  flatten(window, spans_, start);
  for (std::size_t i = 0; i + 1 < window.size(); ++i) {
    const double corner = window[i].exit_speed;
    corners_.push_back(corner < std::min(spans_[i], spans_[i + 1]) ? corner : kInfinite);
  }
  flatten(window, corners_, start);
  for (std::size_t i = 0; i < window.size(); ++i) {
    add(window.position(i), window.position(i + 1), spans_[i]);
    if (i + 1 == window.size() || corners_[i] == kInfinite) continue;
    add(window.position(i + 1), window.position(i + 1), corners_[i]);
  }
  return link();
}

void SpeedCaps::add(double begin, double end, double speed) {
  if (!caps_.empty() && caps_.back().speed == speed) {
    caps_.back().end = end;
    return;
  }
  caps_.push_back({begin, end, speed, -1, -1});
}

// Speeds of neighbours that are equal but for noise are made equal, where they last no longer than a ramp's bends:
// else each would have ramps of its own. Those above `start` stay above it.
void SpeedCaps::flatten(const SpeedWindow& window, std::vector<double>& speeds, double start) {
  constexpr double kNoise = 0x1p-11;
  double low = 0;
  double high = 0;
  std::size_t first = 0;
  const auto level = [&](std::size_t end) {
    for (; first < end; ++first) {
      double& speed = speeds[first];
      if (speed != kInfinite) speed = speed >= start ? std::max(low, start) : low;
    }
  };
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    const Span& span = window[i];
    const double speed = speeds[i];
    if (span.length * span.jerk > span.speed * span.acceleration) {
      level(i);
      first = i + 1;
      low = high = 0;
    } else if (speed != kInfinite) {
      if (std::max(high, speed) * (1 - kNoise) > std::min(low, speed)) {
        level(i);
        low = high = speed;
      }
      low = std::min(low, speed);
      high = std::max(high, speed);
    }
  }
  level(speeds.size());
}

int SpeedCaps::link() {
  open_.clear();
  for (std::size_t i = 0; i < caps_.size(); ++i) {
    int popped = -1;
    while (!open_.empty() && (*this)[open_.back()].speed > caps_[i].speed) {
      popped = open_.back();
      open_.pop_back();
    }
    caps_[i].before = popped;
    if (!open_.empty()) caps_[static_cast<std::size_t>(open_.back())].after = static_cast<int>(i);
    open_.push_back(static_cast<int>(i));
  }
  return open_.front();
}

}  // namespace trammel::planner
