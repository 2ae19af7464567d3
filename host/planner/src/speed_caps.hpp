// The most speed at each place of a window, as a tree: above each cap stands the next lower one on either side.
// Internal to the planner.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "speed_window.hpp"

namespace trammel::planner {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Cap {
  double begin = 0;  // = end: a corner
  double end = 0;
  double speed = 0;
  int before = -1;  // the lowest of those before it, back to the last lower one; -1: none
  int after = -1;
};

// A row of speeds, with those made equal that are but for noise, where they last no longer than a ramp's bends: else
// each would have ramps of its own. Each is lowered by at most one part in 2048, and what comes later changes only the
// last equal ones.
class LevelledSpeeds {
 public:
  explicit LevelledSpeeds(std::size_t most);

  // Infinite: none.
  void push(double speed, bool brief);
  void drop(std::size_t count);
  // Not below `start` where the speed pushed was not.
  double at(std::size_t i, double start) const;

 private:
  void close();

  std::vector<double> wanted_;
  std::vector<double> levelled_;
  std::size_t open_ = 0;  // equal ones at the end, between low_ and high_
  double low_ = 0;
  double high_ = 0;
};

class SpeedCaps {
 public:
  explicit SpeedCaps(std::size_t spans);

  // As the window's spans.
  void push(const Span& span);
  void drop(std::size_t count);
  // Caps of the window, which begins at the speed `start`. Returns the lowest.
  int build(const SpeedWindow& window, double start);
  const Cap& operator[](int i) const { return caps_[static_cast<std::size_t>(i)]; }

 private:
  void add(double begin, double end, double speed);
  int link();

  LevelledSpeeds spans_;
  LevelledSpeeds corners_;  // before each span
  Span last_;
  std::vector<Cap> caps_;
  std::vector<int> open_;
};

}  // namespace trammel::planner
