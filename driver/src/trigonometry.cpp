#include "trammel/driver/trigonometry.hpp"

#include <array>
#include <cmath>
#include <cstdint>

namespace trammel::driver {
namespace {

// pi/2 in two parts. The first has 33 bits, so that its product with up to 2^20 quarter turns is exact.
constexpr double kQuarterHigh = 0x1.921fb544p+0;
constexpr double kQuarterLow = 0x1.0b4611a626331p-34;

// Taylor series for |x| <= pi/4. The first omitted terms are below 2^-54: x^17/17! and x^18/18!.
double sine_series(double x) {
  const double square = x * x;
  double sum = -1.0 / 1307674368000.0;
  sum = sum * square + 1.0 / 6227020800.0;
  sum = sum * square - 1.0 / 39916800.0;
  sum = sum * square + 1.0 / 362880.0;
  sum = sum * square - 1.0 / 5040.0;
  sum = sum * square + 1.0 / 120.0;
  sum = sum * square - 1.0 / 6.0;
  return x + x * square * sum;
}

double cosine_series(double x) {
  const double square = x * x;
  double sum = 1.0 / 20922789888000.0;
  sum = sum * square - 1.0 / 87178291200.0;
  sum = sum * square + 1.0 / 479001600.0;
  sum = sum * square - 1.0 / 3628800.0;
  sum = sum * square + 1.0 / 40320.0;
  sum = sum * square - 1.0 / 720.0;
  sum = sum * square + 1.0 / 24.0;
  return 1.0 - (0.5 * square - square * square * sum);
}

// arctan(k / 8)
constexpr std::array<double, 9> kEighths = {0.0,
                                            0.12435499454676144,
                                            0.24497866312686414,
                                            0.35877067027057225,
                                            0.4636476090008061,
                                            0.5585993153435624,
                                            0.6435011087932844,
                                            0.7188299996216245,
                                            0.7853981633974483};

// For |x| <= 1/15; the first omitted term is x^15/15.
double arc_tangent_series(double x) {
  const double square = x * x;
  double sum = 1.0 / 13.0;
  sum = sum * square - 1.0 / 11.0;
  sum = sum * square + 1.0 / 9.0;
  sum = sum * square - 1.0 / 7.0;
  sum = sum * square + 1.0 / 5.0;
  sum = sum * square - 1.0 / 3.0;
  return x + x * square * sum;
}

// arctan(low / high), 0 <= low <= high, high > 0: arctan t = arctan c + arctan((t - c) / (1 + t c)), where c is the
// multiple of 1/8 nearest to t.
double first_octant(double low, double high) {
  const auto eighths = static_cast<std::size_t>(8 * (low / high) + 0.5);
  const double near = static_cast<double>(eighths) / 8;
  return kEighths[eighths] + arc_tangent_series((low - near * high) / (high + near * low));
}

}  // namespace

SineCosine sine_cosine(double angle) {
  const double scaled = angle * (2 / kPi);
  const auto quarters = static_cast<std::int32_t>(scaled < 0 ? scaled - 0.5 : scaled + 0.5);
  const double rest = (angle - quarters * kQuarterHigh) - quarters * kQuarterLow;
  const double sine = sine_series(rest);
  const double cosine = cosine_series(rest);
  switch (static_cast<std::uint32_t>(quarters) & 3U) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

double arc_tangent(double y, double x) {
  const double width = std::abs(x);
  const double height = std::abs(y);
  if (width == 0 && height == 0) return 0;
  double angle = height <= width ? first_octant(height, width) : kPi / 2 - first_octant(width, height);
  if (x < 0) angle = kPi - angle;
  return y < 0 ? -angle : angle;
}

double arc_sine(double x) { return arc_tangent(x, std::sqrt((1 - x) * (1 + x))); }

}  // namespace trammel::driver
