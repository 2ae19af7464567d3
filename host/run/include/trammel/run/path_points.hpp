// Points of a path for a picture, few enough however long the path is. Not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace trammel::run {

using Point = std::array<double, 3>;  // the first three axes, in the picture's unit

struct PathPoint {
  Point at{};
  bool rapid = false;  // of the way that leads here
};

// Keeps at most 2 * `limit` points, and the very last one: each at least a distance from the one kept before it, or the
// first of another kind of way. The distance begins with 0 and grows as points come in.
class PathPoints {
 public:
  explicit PathPoints(std::size_t limit) : limit_(limit) {}
  void add(const PathPoint& point);
  std::vector<PathPoint> points() const;
  // Points were left out.
  bool thinned() const { return distance_ > 0; }

 private:
  // Whether a point is kept after another one.
  bool keeps(const PathPoint& before, const PathPoint& point) const;
  void thin();

  std::size_t limit_;
  double distance_ = 0;
  std::vector<PathPoint> kept_;
  PathPoint last_;
};

}  // namespace trammel::run
