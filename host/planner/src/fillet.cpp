#include "fillet.hpp"

#include <algorithm>
#include <cmath>

#include "trammel/driver/trigonometry.hpp"

namespace trammel::planner {
namespace {

// The corner is the origin, w the centre of the arc and r its radius; s is 1 for a turn to the left, else -1; n is the
// normal of a side to its left, c its curvature. The arc touches a side, which may be a line or an arc, on the inside
// of the turn: w n = s r + c m / 2, with m = w w - r r. The equations of the two sides give w as a linear function of r
// and m. Then w w = m + r r is a quadratic equation for m alone.
class FilletCorner {
 public:
  FilletCorner(const Side& from, const Side& to, double sine)
      : from_(from), to_(to), tangent_square_(sine * sine / (1 - sine * sine)) {
    const double cross = from.x * to.y - from.y * to.x;
    turn_ = cross < 0 ? -1 : 1;
    angle_ = 2 * driver::arc_tangent(sine, std::sqrt(1 - sine * sine));
    const auto solve = [&](double first, double second, double& x, double& y) {
      x = (to.x * first - from.x * second) / cross;
      y = (to.y * first - from.y * second) / cross;
    };
    solve(turn_, turn_, radial_x_, radial_y_);
    solve(from.curvature / 2, to.curvature / 2, bent_x_, bent_y_);
  }

  std::optional<Fillet> of_radius(double radius) const {
    // The smaller root is that of a corner of two lines.
    const double a = bent_x_ * bent_x_ + bent_y_ * bent_y_;
    const double b = 1 - 2 * radius * (radial_x_ * bent_x_ + radial_y_ * bent_y_);
    const double c = radius * radius * tangent_square_;
    const double square = b * b - 4 * a * c;
    if (!(b > 0) || !(square >= 0)) return std::nullopt;
    const double m = 2 * c / (b + std::sqrt(square));
    Fillet found;
    found.radius = radius;
    found.distance = m / (std::sqrt(radius * radius + m) + radius);
    found.centre_x = radius * radial_x_ + m * bent_x_;
    found.centre_y = radius * radial_y_ + m * bent_y_;
    found.clockwise = turn_ < 0;
    // If an arc turns the same way as the corner, the radius must be smaller than that of the arc.
    if (!(turn_ * from_.curvature * radius < 1) || !(turn_ * to_.curvature * radius < 1)) return std::nullopt;
    found.before = -along(from_, found);
    found.behind = along(to_, found);
    found.sweep = angle_ + turn_ * (from_.curvature * found.before + to_.curvature * found.behind);
    return found;
  }

 private:
  // Distance along the side from the corner to the point of contact.
  static double along(const Side& side, const Fillet& at) {
    const double way = at.centre_x * side.x + at.centre_y * side.y;
    if (side.curvature == 0) return way;
    const double inward = at.centre_y * side.x - at.centre_x * side.y;
    const double bend = std::abs(side.curvature);
    return driver::arc_tangent(bend * way, 1 - side.curvature * inward) / bend;
  }

  Side from_;
  Side to_;
  double tangent_square_;  // tan^2 of half the angle
  double turn_;
  double angle_ = 0;
  double radial_x_ = 0;  // w = radius * radial + m * bent
  double radial_y_ = 0;
  double bent_x_ = 0;
  double bent_y_ = 0;
};

}  // namespace

std::optional<Fillet> fillet(const Side& from, const Side& to, double sine, double tolerance) {
  constexpr double kMinSweep = 1e-4;
  constexpr int kHalvings = 50;
  const double cosine = std::sqrt(1 - sine * sine);
  const FilletCorner corner(from, to, sine);
  const auto fits = [&](const std::optional<Fillet>& one) {
    return one && one->distance <= tolerance && one->before > 0 && one->before <= from.most && one->behind > 0 &&
           one->behind <= to.most && one->sweep > kMinSweep && one->sweep < driver::kPi;
  };
  // Two lines: a closed form, and the first guess for arcs.
  const double taken = std::min({tolerance * (1 + cosine) / sine, from.most, to.most});
  double low = taken * cosine / sine;
  if (from.curvature == 0 && to.curvature == 0) {
    std::optional<Fillet> found = corner.of_radius(low);
    found->distance = taken * sine / (1 + cosine);
    found->before = found->behind = taken;
    return found;
  }
  double high = low;
  int steps = 0;
  for (; steps < kHalvings && !fits(corner.of_radius(low)); ++steps) {
    high = low;
    low /= 2;
  }
  for (; steps < kHalvings && high == low; ++steps) {
    if (!fits(corner.of_radius(2 * low)))
      high = 2 * low;
    else
      high = low = 2 * low;
  }
  for (; steps < 2 * kHalvings; ++steps) {
    const double middle = (low + high) / 2;
    (fits(corner.of_radius(middle)) ? low : high) = middle;
  }
  const std::optional<Fillet> found = corner.of_radius(low);
  return fits(found) ? found : std::nullopt;
}

}  // namespace trammel::planner
