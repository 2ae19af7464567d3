#include "walks.hpp"

namespace trammel::interpolation {

double from_ellipse(double semi_x, double semi_y, const Position& p) {
  double x = std::fabs(static_cast<double>(p[0]));
  double y = std::fabs(static_cast<double>(p[1]));
  if (semi_x < semi_y) {
    std::swap(semi_x, semi_y);
    std::swap(x, y);
  }
  if (y == 0) {
    const double focal = semi_x * semi_x - semi_y * semi_y;
    const double foot = semi_x * x / focal;
    if (focal <= 0 || foot >= 1) return std::fabs(x - semi_x);
    return std::hypot(semi_x * foot - x, semi_y * std::sqrt(1 - foot * foot));
  }
  if (x == 0) return std::fabs(y - semi_y);
  // The foot of the perpendicular is (r x / (s + r), y / (s + 1)) with r = (a / b)^2; s puts it on the ellipse.
  const double r = (semi_x / semi_y) * (semi_x / semi_y);
  const double z0 = x / semi_x;
  const double z1 = y / semi_y;
  double low = z1 - 1;
  double high = std::hypot(r * z0, z1) - 1;
  if (high < low) high = low;
  for (int i = 0; i < 60; ++i) {
    const double s = (low + high) / 2;
    const double u = r * z0 / (s + r);
    const double v = z1 / (s + 1);
    (u * u + v * v > 1 ? low : high) = s;
  }
  const double s = (low + high) / 2;
  return std::hypot(r * x / (s + r) - x, y / (s + 1) - y);
}

}  // namespace trammel::interpolation
