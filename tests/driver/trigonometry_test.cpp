#include "trammel/driver/trigonometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace trammel::driver {
namespace {

// The reference is the mathematics library's long double functions, if long double has more digits than double.
long double wide(double x) { return static_cast<long double>(x); }

// False: long double has no more digits than double, so there is no reference.
bool is_judge() { return std::numeric_limits<long double>::digits > std::numeric_limits<double>::digits; }

double error(double is, long double wanted) { return static_cast<double>(std::abs(wide(is) - wanted)); }

TEST(Trigonometry, SineAndCosineKeepTheirBound) {
  if (!is_judge()) GTEST_SKIP() << "long double is double";
  double largest = 0;
  const auto look = [&](double angle) {
    const SineCosine at = sine_cosine(angle);
    largest = std::max({largest, error(at.sine, std::sin(wide(angle))), error(at.cosine, std::cos(wide(angle)))});
  };
  for (int i = -400'000; i <= 400'000; ++i) look(i * 3.1e-5);
  for (int i = -1000; i <= 1000; ++i) look(i * 0.99999);
  for (int i = -600; i <= 600; ++i) look(i * (kPi / 2));
  for (int i = -1000; i <= 1000; ++i) look(i * 999.9999);
  EXPECT_LE(largest, 0x1p-52);
  EXPECT_GT(largest, 0x1p-56) << "nothing was compared";
}

TEST(Trigonometry, ArcTangentKeepsItsBound) {
  if (!is_judge()) GTEST_SKIP() << "long double is double";
  double largest = 0;
  for (int i = -300; i <= 300; ++i) {
    for (int k = -300; k <= 300; ++k) {
      for (const double stretch : {1.0, 1e-9, 3.7e5}) {
        const double y = i * 0.37;
        const double x = k * stretch;
        if (y == 0 && x <= 0) continue;
        largest = std::max(largest, error(arc_tangent(y, x), std::atan2(wide(y), wide(x))));
      }
    }
  }
  EXPECT_LE(largest, 0x1p-50);
  EXPECT_GT(largest, 0x1p-56);
}

TEST(Trigonometry, ArcSineKeepsItsBound) {
  if (!is_judge()) GTEST_SKIP() << "long double is double";
  double largest = 0;
  for (int i = 0; i <= 100'000; ++i) largest = std::max(largest, error(arc_sine(i * 5e-6), std::asin(wide(i * 5e-6))));
  EXPECT_LE(largest, 0x1p-50);
  EXPECT_DOUBLE_EQ(arc_sine(1), kPi / 2);
}

TEST(Trigonometry, WholeQuartersAreExact) {
  EXPECT_EQ(arc_tangent(0, 5), 0);
  EXPECT_EQ(arc_tangent(0, -5), kPi);
  EXPECT_EQ(arc_tangent(-0.0, -5), kPi);
  EXPECT_EQ(arc_tangent(3, 0), kPi / 2);
  EXPECT_EQ(arc_tangent(-3, 0), -kPi / 2);
  EXPECT_EQ(arc_tangent(2, 2), kPi / 4);
  EXPECT_EQ(arc_tangent(0, 0), 0);
  EXPECT_EQ(sine_cosine(0).sine, 0);
  EXPECT_EQ(sine_cosine(0).cosine, 1);
}

// A hash of the bits for a range of angles, computed on x86-64. Other hosts must get the same value.
TEST(Trigonometry, GivesTheSameBitsOnEveryHost) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  const auto add = [&](double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 0x100000001B3U;
    hash ^= hash >> 29U;
  };
  for (int i = -20'000; i <= 20'000; ++i) {
    const double angle = i * 0x1.91p-12;
    const SineCosine at = sine_cosine(angle);
    add(at.sine);
    add(at.cosine);
    add(arc_tangent(at.sine * 3, at.cosine * 5));
    add(arc_sine(std::abs(at.sine) / 2));
  }
  EXPECT_EQ(hash, 765831208837380632U);
}

}  // namespace
}  // namespace trammel::driver
