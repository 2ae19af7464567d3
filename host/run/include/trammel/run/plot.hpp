// The picture of a run: the commanded path with the pulses on it, in one plane or in three views; a magnified stretch
// that shows single pulses; and the speed along the path over time. Thread-safe: a pure function.
#pragma once

#include <string>
#include <vector>

#include "trammel/run/path_points.hpp"
#include "trammel/run/path_speed.hpp"

namespace trammel::run {

struct Plot {
  std::string title;
  std::string unit = "mm";  // unit of the points
  std::vector<PathPoint> commanded;
  std::vector<PathPoint> executed;
  bool executed_thinned = false;
  std::vector<Point> detail_commanded;  // the magnified stretch
  std::vector<Point> detail_executed;
  std::vector<PathSpeed::Sample> speed;
};

// As SVG. The size is below 5 MB for points of PathPoints with a limit of 20,000.
std::string svg(const Plot& plot);

}  // namespace trammel::run
