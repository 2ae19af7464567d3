// 128-bit integers against the laws of arithmetic, so that the test needs no 128-bit type of the compiler.
#include "trammel/driver/wide.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "trammel/driver/increment.hpp"

namespace trammel::driver {
namespace {

Uint128 any() { return {*rc::gen::arbitrary<std::uint64_t>(), *rc::gen::arbitrary<std::uint64_t>()}; }
// A number of any length in bits.
std::uint64_t any64() { return *rc::gen::arbitrary<std::uint64_t>() >> *rc::gen::inRange(0, 64); }

TEST(Wide, Examples) {
  const Uint128 square = Uint128::product(~std::uint64_t{0}, ~std::uint64_t{0});
  EXPECT_EQ(square.high(), ~std::uint64_t{0} - 1);
  EXPECT_EQ(square.low(), 1U);
  EXPECT_TRUE((Uint128(1) << 127) - Uint128(1) == Uint128(~std::uint64_t{0} >> 1, ~std::uint64_t{0}));
  EXPECT_TRUE(Uint128(7) / Uint128(2) == Uint128(3));
  EXPECT_TRUE(ceil_div(Uint128(7), Uint128(2)) == Uint128(4));
  EXPECT_TRUE(Uint128(~std::uint64_t{0}, ~std::uint64_t{0}) / Uint128(std::uint64_t{1} << 63, 0) == Uint128(1));
  EXPECT_TRUE(Int128(-3) * Int128(5) == Int128(-15));
  EXPECT_TRUE(Int128(-1) < Int128(0));
  EXPECT_EQ(Int128(-1).high(), -1);
  EXPECT_EQ(static_cast<double>(Int128(-1) << 70), -1180591620717411303424.0);
}

RC_GTEST_PROP(WideProperty, ProductsAddUpByDigits, ()) {
  const std::uint64_t a = any64();
  const std::uint64_t b = any64();
  // Multiplication by digits of 16 bits, a method that differs from that of the class.
  Uint128 sum;
  for (unsigned digit = 0; digit < 4; ++digit) {
    const std::uint64_t part = b >> (16 * digit) & 0xFFFF;
    const Uint128 low((a & 0xFFFFFFFF) * part);
    const Uint128 high((a >> 32) * part);
    sum = sum + ((low + (high << 32)) << (16 * digit));
  }
  RC_ASSERT(sum == Uint128::product(a, b));
}

RC_GTEST_PROP(WideProperty, DivisionLeavesARestBelowTheDivisor, ()) {
  const Uint128 a = any() >> static_cast<unsigned>(*rc::gen::inRange(0, 128));
  const Uint128 b = any() >> static_cast<unsigned>(*rc::gen::inRange(0, 128));
  RC_PRE(b != Uint128(0));
  const Uint128 quotient = a / b;
  const Uint128 rest = a - quotient * b;
  RC_ASSERT(rest < b);
  RC_ASSERT(quotient <= a);
  RC_ASSERT(ceil_div(a, b) == quotient + Uint128(rest == Uint128(0) ? 0 : 1));
}

RC_GTEST_PROP(WideProperty, ShiftsAndSumsAgree, ()) {
  const Uint128 a = any();
  const auto bits = static_cast<unsigned>(*rc::gen::inRange(0, 128));
  RC_ASSERT(a << bits == a * (Uint128(1) << bits));
  RC_ASSERT(a >> bits == a / (Uint128(1) << bits));
  const Uint128 b = any();
  RC_ASSERT(a + b - b == a);
  RC_ASSERT((a < b) == !(b <= a));
}

RC_GTEST_PROP(WideProperty, SignedNumbersKeepTheirSigns, ()) {
  const auto a = *rc::gen::arbitrary<std::int64_t>();
  const auto b = *rc::gen::arbitrary<std::int64_t>();
  const Int128 product = Int128(a) * b;
  RC_ASSERT((product < 0) == ((a < 0) != (b < 0) && a != 0 && b != 0));
  RC_ASSERT(-product == Int128(b) * -Int128(a));
  RC_ASSERT((Int128(a) < Int128(b)) == (a < b));
  RC_ASSERT(Int128(a) - b + b == Int128(a));
}

RC_GTEST_PROP(IncrementProperty, IsTheNearest, ()) {
  const auto ticks = *rc::gen::inRange<std::uint64_t>(1, std::uint64_t{1} << *rc::gen::inRange(1, 41));
  const auto pulses = *rc::gen::inRange<std::uint64_t>(0, ticks + 1);
  const std::uint64_t share = rounded_share(pulses, ticks);
  // 2^41 p + N >= 2 N share >= 2^41 p - N + 1: halves are rounded up.
  const Uint128 twice = Uint128::product(2 * share, ticks);
  const Uint128 exact = Uint128(pulses) << 41;
  RC_ASSERT(twice <= exact + Uint128(ticks));
  RC_ASSERT(exact < twice + Uint128(ticks));
  const auto signed_pulses = static_cast<std::int64_t>(pulses);
  RC_ASSERT(rounded_increment(signed_pulses, ticks) == static_cast<std::int64_t>(share));
  RC_ASSERT(rounded_increment(-signed_pulses, ticks) == -static_cast<std::int64_t>(share));
}

}  // namespace
}  // namespace trammel::driver
