// The most speed at each place of a window, as a tree: above each cap stands the next lower one on either side.
// Internal to the planner.
#pragma once

#include <cstddef>
#include <vector>

#include "speed_window.hpp"

namespace trammel::planner {

struct Cap {
  double begin = 0;  // = end: a corner
  double end = 0;
  double speed = 0;
  int before = -1;  // the lowest of those before it, back to the last lower one; -1: none
  int after = -1;
};

class SpeedCaps {
 public:
  explicit SpeedCaps(std::size_t spans);

  // Caps of the window, which begins at the speed `start`. Returns the lowest.
  int build(const SpeedWindow& window, double start);
  const Cap& operator[](int i) const { return caps_[static_cast<std::size_t>(i)]; }

 private:
  void add(double begin, double end, double speed);
  void flatten(const SpeedWindow& window, std::vector<double>& speeds, double start);
  int link();

  std::vector<double> spans_;    // most speed in span i
  std::vector<double> corners_;  // and at its end; infinite: that of the spans
  std::vector<Cap> caps_;
  std::vector<int> open_;
};

}  // namespace trammel::planner
