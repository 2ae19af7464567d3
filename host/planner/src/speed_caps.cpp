#include "speed_caps.hpp"

#include <algorithm>

namespace trammel::planner {
LevelledSpeeds::LevelledSpeeds(std::size_t most) {
  wanted_.reserve(most);
  levelled_.reserve(most);
}

void LevelledSpeeds::push(double speed, bool brief) {
  constexpr double kNoise = 0x1p-11;
  wanted_.push_back(speed);
  levelled_.push_back(speed);
  if (!brief) {
    close();
    open_ = 0;
  } else if (speed == kInfinite) {
    if (open_ != 0) ++open_;
  } else if (open_ != 0 && std::max(high_, speed) * (1 - kNoise) <= std::min(low_, speed)) {
    ++open_;
    low_ = std::min(low_, speed);
    high_ = std::max(high_, speed);
  } else {
    close();
    open_ = 1;
    low_ = high_ = speed;
  }
}

// Ends the run of equal speeds. The last speed pushed does not belong to it.
void LevelledSpeeds::close() {
  const std::size_t end = levelled_.size() - 1;
  for (std::size_t i = end - std::min(open_, end); i < end; ++i) {
    if (levelled_[i] != kInfinite) levelled_[i] = low_;
  }
}

void LevelledSpeeds::drop(std::size_t count) {
  const auto passed = static_cast<std::ptrdiff_t>(count);
  wanted_.erase(wanted_.begin(), wanted_.begin() + passed);
  levelled_.erase(levelled_.begin(), levelled_.begin() + passed);
  open_ = std::min(open_, levelled_.size());
}

double LevelledSpeeds::at(std::size_t i, double start) const {
  const double wanted = wanted_[i];
  if (wanted == kInfinite) return wanted;
  const double levelled = i + open_ >= levelled_.size() ? low_ : levelled_[i];
  return wanted >= start ? std::max(levelled, start) : levelled;
}

SpeedCaps::SpeedCaps(std::size_t spans) : spans_(spans), corners_(spans) {
  caps_.reserve(2 * spans);
  open_.reserve(2 * spans);
}

void SpeedCaps::push(const Span& span) {
  const bool brief = span.length * span.jerk <= span.speed * span.acceleration;
  const bool corner = last_.exit_speed < std::min(last_.speed, span.speed);
  spans_.push(span.speed, brief);
  corners_.push(corner ? last_.exit_speed : kInfinite, brief);
  last_ = span;
}

void SpeedCaps::drop(std::size_t count) {
  spans_.drop(count);
  corners_.drop(count);
}

int SpeedCaps::build(const SpeedWindow& window, double start) {
  caps_.clear();
  for (std::size_t i = 0; i < window.size(); ++i) {
    const double begin = window.position(i);
    const double corner = i == 0 ? kInfinite : corners_.at(i, start);
    if (corner != kInfinite) add(begin, begin, corner);
    add(begin, window.position(i + 1), spans_.at(i, start));
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
