// The speed limits (caps) along a window, as a binary tree. The root is the lowest cap; on each side of a cap, its
// subtree holds the caps up to the next lower one. Internal to the planner.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "speed_window.hpp"

namespace trammel::planner {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Cap {
  double begin = 0;  // equal to `end`: a corner
  double end = 0;
  double speed = 0;
  // Roots of the subtrees: the lowest cap before this one, back to the last lower cap, and the same after it; -1: none.
  int before = -1;
  int after = -1;
};

// A sequence of speeds. Neighbours that differ only by noise and last no longer than the bends of a ramp become equal,
// because each would otherwise have its own ramps. A speed is lowered by at most one part in 2048. Later speeds change
// only the last run of equal speeds.
class LevelledSpeeds {
 public:
  explicit LevelledSpeeds(std::size_t most);

  // An infinite speed is no limit. `brief`: it lasts no longer than the bends of a ramp.
  void push(double speed, bool brief);
  void drop(std::size_t count);
  // Levelling does not lower a speed from above `start` to below it.
  double at(std::size_t i, double start) const;

 private:
  void close();

  std::vector<double> wanted_;
  std::vector<double> levelled_;
  std::size_t open_ = 0;  // number of equal speeds at the end, made of speeds from low_ to high_
  double low_ = 0;
  double high_ = 0;
};

class SpeedCaps {
 public:
  explicit SpeedCaps(std::size_t spans);

  // Call in step with the spans of the window.
  void push(const Span& span);
  void drop(std::size_t count);
  // Builds the caps of the window, which begins at the speed `start`. Returns the root.
  int build(const SpeedWindow& window, double start);
  const Cap& operator[](int i) const { return caps_[static_cast<std::size_t>(i)]; }

 private:
  void add(double begin, double end, double speed);
  int link();

  LevelledSpeeds spans_;
  LevelledSpeeds corners_;  // at the beginning of each span
  Span last_;
  std::vector<Cap> caps_;
  std::vector<int> open_;
};

}  // namespace trammel::planner
