#include "elementary.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

#include "trammel/driver/trigonometry.hpp"

namespace trammel::gcode {
namespace {

// ln 2 in two parts. The first ends in 21 zero bits, so that its products with exponents are exact.
constexpr double kLn2High = 0x1.62e42fee00000p-1;
constexpr double kLn2Low = 0x1.a39ef35793c76p-33;
constexpr double kRootHalf = 0.7071067811865476;
constexpr double kMaxMultiplied = 1024;

double whole_power(double base, std::int64_t exponent) {
  double result = 1;
  for (std::int64_t left = exponent < 0 ? -exponent : exponent; left != 0; left /= 2) {
    if (left % 2 != 0) result *= base;
    base *= base;
  }
  return exponent < 0 ? 1 / result : result;
}

// Reduced to one turn: -180 < result <= 180, exact.
double reduced(double angle) { return std::remainder(angle, 360.0); }

double radians(double degrees) { return degrees * (driver::kPi / 180); }

}  // namespace

double exponential(double x) {
  constexpr double kLargest = 709.78;
  constexpr double kSmallest = -745.2;
  if (x > kLargest) return std::numeric_limits<double>::infinity();
  if (x < kSmallest) return 0;
  const double twos = std::floor(x / (kLn2High + kLn2Low) + 0.5);
  const double rest = (x - twos * kLn2High) - twos * kLn2Low;
  // |rest| <= 0.35: 17 terms of the series leave an error below 1e-23.
  double sum = 1;
  for (int n = 17; n > 0; --n) sum = 1 + sum * rest / n;
  return std::ldexp(sum, static_cast<int>(twos));
}

// ln x = k ln 2 + 2 artanh s, s = (m - 1) / (m + 1), x = m 2^k, |s| < 0.172.
double natural_logarithm(double x) {
  int twos = 0;
  double m = std::frexp(x, &twos);
  if (m < kRootHalf) {
    m *= 2;
    --twos;
  }
  const double s = (m - 1) / (m + 1);
  const double square = s * s;
  double sum = 0;  // 1/3 s^2 + 1/5 s^4 + ...: 12 terms leave an error below 1e-20
  for (int n = 12; n > 0; --n) sum = square * (sum + 1.0 / (2 * n + 1));
  return twos * kLn2High + (2 * s + (2 * s * sum + twos * kLn2Low));
}

double power(double base, double exponent) {
  if (exponent == std::floor(exponent) && std::abs(exponent) <= kMaxMultiplied) {
    return whole_power(base, static_cast<std::int64_t>(exponent));
  }
  if (base == 0 && exponent > 0) return 0;
  if (!(base > 0)) return std::numeric_limits<double>::quiet_NaN();
  return exponential(exponent * natural_logarithm(base));
}

double sine_of_degrees(double angle) {
  const double turned = reduced(angle);
  if (turned == 0 || std::abs(turned) == 180) return 0;
  return std::abs(turned) == 90 ? turned / 90 : driver::sine_cosine(radians(turned)).sine;
}

double cosine_of_degrees(double angle) {
  const double turned = std::abs(reduced(angle));
  if (turned == 90) return 0;
  return turned == 0 ? 1 : turned == 180 ? -1 : driver::sine_cosine(radians(turned)).cosine;
}

double degrees_of(double y, double x) { return driver::arc_tangent(y, x) * (180 / driver::kPi); }

}  // namespace trammel::gcode
