// Points of a path for a picture; their number is bounded for any length of path. Not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace trammel::run {

using Point = std::array<double, 3>;  // the first three axes, in the picture's unit

struct PathPoint {
  Point at{};
  bool rapid = false;  // the motion to this point is a rapid
};

// Keeps at most 2 * `limit` points, and the very last one. A point is kept if it is at least a certain distance from
// the previous kept one. Between a rapid and a feed motion an eighth of this distance is enough. The distance begins at
// 0 and grows with the number of points.
class PathPoints {
 public:
  explicit PathPoints(std::size_t limit) : limit_(limit) {}
  void add(const PathPoint& point);
  std::vector<PathPoint> points() const;
  // Whether points were left out.
  bool thinned() const { return distance_ > 0; }

 private:
  // Whether `point` is kept when `before` is the last kept one.
  bool keeps(const PathPoint& before, const PathPoint& point) const;
  void thin();

  std::size_t limit_;
  double distance_ = 0;
  std::vector<PathPoint> kept_;
  PathPoint last_;
};

}  // namespace trammel::run
