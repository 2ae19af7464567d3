#include "trammel/run/path_points.hpp"

#include <algorithm>
#include <cmath>

namespace trammel::run {

bool PathPoints::keeps(const PathPoint& before, const PathPoint& point) const {
  double square = 0;
  for (std::size_t i = 0; i < point.at.size(); ++i) square += std::pow(point.at[i] - before.at[i], 2);
  // A change between rapid and feed needs only an eighth of the distance, but not none, so the number of points stays
  // bounded.
  const double least = point.rapid == before.rapid ? distance_ : distance_ / 8;
  return square >= least * least;
}

void PathPoints::add(const PathPoint& point) {
  if (kept_.empty() || keeps(kept_.back(), point)) kept_.push_back(point);
  last_ = point;
  if (kept_.size() > 2 * limit_) thin();
}

void PathPoints::thin() {
  if (distance_ == 0) {
    // Starts at an eighth of the mean distance that `limit` points would have along the whole path; the loop doubles
    // it.
    double way = 0;
    for (std::size_t i = 1; i < kept_.size(); ++i) {
      const Point& a = kept_[i - 1].at;
      const Point& b = kept_[i].at;
      way += std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    }
    distance_ = std::max(way, 1e-9) / static_cast<double>(8 * limit_);
  }
  while (kept_.size() > limit_) {
    distance_ *= 2;
    std::vector<PathPoint> fewer{kept_.front()};
    for (const PathPoint& point : kept_) {
      if (keeps(fewer.back(), point)) fewer.push_back(point);
    }
    kept_ = std::move(fewer);
  }
}

std::vector<PathPoint> PathPoints::points() const {
  std::vector<PathPoint> all = kept_;
  if (!all.empty() && all.back().at != last_.at) all.push_back(last_);
  return all;
}

}  // namespace trammel::run
