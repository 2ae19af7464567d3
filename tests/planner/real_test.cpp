// Against the processor's numbers of 64 significant bits, where long double has them (x86); the laws everywhere.
#include "real.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace trammel::planner {
namespace {

constexpr bool kProcessorHasThem = std::numeric_limits<long double>::digits == 64;

class RealTest : public testing::Test {
 protected:
  // A number of 64 random bits, or of few, and the same as long double.
  struct Both {
    Real real;
    long double wide = 0;
  };
  Both random(int span) {
    std::uint64_t mantissa = random_();
    const auto kind = random_() % 4;
    if (kind == 0) mantissa &= ~std::uint64_t{0} << (random_() % 63);
    if (kind == 1) mantissa |= ~std::uint64_t{0} >> (random_() % 63);
    mantissa |= std::uint64_t{1} << 63;
    const int power = static_cast<int>(random_() % static_cast<unsigned>(2 * span + 1)) - span;
    return {Real::whole(mantissa).scaled(power), std::ldexp(static_cast<long double>(mantissa), power)};
  }
  static bool same(Real real, long double wide) {
    if (wide == 0) return real.floor() == 0 && real <= Real();
    int power = 0;
    const auto mantissa = static_cast<std::uint64_t>(std::ldexp(std::frexp(wide, &power), 64));
    const Real expected = Real::whole(mantissa).scaled(power - 64);
    return !(real < expected) && !(expected < real);
  }
  std::mt19937_64 random_{1};
};

TEST_F(RealTest, RoundsEveryOperationAsTheProcessorDoes) {
  if (!kProcessorHasThem) GTEST_SKIP() << "long double has other digits here";
  for (int i = 0; i < 300'000; ++i) {
    const Both a = random(i % 3 == 0 ? 140 : 2);
    const Both b = random(2);
    ASSERT_TRUE(same(a.real, a.wide));
    ASSERT_TRUE(same(a.real + b.real, a.wide + b.wide)) << i;
    ASSERT_TRUE(same(a.real * b.real, a.wide * b.wide)) << i;
    ASSERT_TRUE(same(a.real / b.real, a.wide / b.wide)) << i;
    ASSERT_TRUE(same(square_root(a.real), std::sqrt(a.wide))) << i;
    ASSERT_TRUE(b.real < a.real ? same(a.real - b.real, a.wide - b.wide) : same(b.real - a.real, b.wide - a.wide)) << i;
    ASSERT_EQ(a.real < b.real, a.wide < b.wide);
  }
}

TEST_F(RealTest, CeilingAndFloor) {
  if (!kProcessorHasThem) GTEST_SKIP() << "long double has other digits here";
  for (int i = 0; i < 100'000; ++i) {
    const Both a = random(80);
    ASSERT_TRUE(same(ceiling(a.real), std::ceil(a.wide)));
    if (a.wide < 0x1p64L) {
      ASSERT_EQ(a.real.floor(), static_cast<std::uint64_t>(a.wide));
    }
    if (a.wide < 1) {
      ASSERT_EQ(a.real.floor(64), static_cast<std::uint64_t>(std::ldexp(a.wide, 64)));
    }
  }
}

// Holds on every host.
TEST_F(RealTest, KeepsWhatIsExact) {
  for (int i = 0; i < 100'000; ++i) {
    const std::uint64_t a = random_() >> (33 + random_() % 20);
    const std::uint64_t b = 1 + (random_() >> (33 + random_() % 20));
    const Real x = Real::whole(a);
    const Real y = Real::whole(b);
    ASSERT_EQ((x * y).floor(), a * b);
    ASSERT_EQ((x + y).floor(), a + b);
    ASSERT_EQ((x + y - y).floor(), a);
    ASSERT_EQ((x * y / y).floor(), a);
    ASSERT_EQ(square_root(x * x).floor(), a);
    ASSERT_EQ(Real(static_cast<double>(a)).floor(), a);
    ASSERT_EQ(x.value(), static_cast<double>(a));
  }
}

TEST_F(RealTest, OfDoublesIsExact) {
  for (const double value : {1.0, 0.1, 3e-300, 2.5e200, 0.9, 1e8}) EXPECT_EQ(Real(value).value(), value);
  EXPECT_EQ(Real(0.0).value(), 0);
  EXPECT_EQ(Real(0.1).floor(64), static_cast<std::uint64_t>(0.1 * 0x1p64));
  EXPECT_EQ(ceiling(Real(0.25)).floor(), 1U);
  EXPECT_EQ(ceiling(Real(7.0)).floor(), 7U);
}

}  // namespace
}  // namespace trammel::planner
