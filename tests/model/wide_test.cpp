// TwoWords, for hosts without a 128-bit type, against the 128-bit type of the compiler.
#include "trammel/model/wide.hpp"

#include <gtest/gtest.h>

#include <random>

namespace trammel::model {
namespace {

#ifdef __SIZEOF_INT128__

uint128 native(TwoWords words) {
  return uint128{static_cast<std::uint64_t>(words >> 64)} << 64 | static_cast<std::uint64_t>(words);
}

// Numbers of every length, and numbers around the borders of the words.
struct Numbers {
  std::mt19937_64 random{1};
  TwoWords next() {
    const TwoWords any{random(), random()};
    const TwoWords some = any >> static_cast<unsigned>(random() % 128);
    switch (random() % 4) {
      case 0:
        return ~some;
      case 1:
        return TwoWords{random() % 2, 0} - random() % 3;
      default:
        return some;
    }
  }
};

TEST(TwoWords, ComputesAsTheCompilersOwn) {
  Numbers numbers;
  for (int i = 0; i < 20'000; ++i) {
    const TwoWords a = numbers.next();
    const TwoWords b = numbers.next();
    const uint128 x = native(a);
    const uint128 y = native(b);
    ASSERT_TRUE(native(a + b) == x + y);
    ASSERT_TRUE(native(a - b) == x - y);
    ASSERT_TRUE(native(a * b) == x * y);
    ASSERT_TRUE(native(a & b) == (x & y));
    ASSERT_TRUE(native(a | b) == (x | y));
    ASSERT_TRUE(native(~a) == ~x);
    ASSERT_EQ(a < b, x < y);
    ASSERT_EQ(a > b, x > y);
    ASSERT_EQ(a <= b, x <= y);
    ASSERT_EQ(a >= b, x >= y);
    ASSERT_EQ(a == b, x == y);
    ASSERT_EQ(a != b, x != y);
    ASSERT_TRUE(a == a && a <= a && a >= a);
  }
}

TEST(TwoWords, ShiftsAsTheCompilersOwn) {
  Numbers numbers;
  for (unsigned bits = 0; bits < 128; ++bits) {
    const TwoWords a = numbers.next();
    ASSERT_TRUE(native(a << bits) == native(a) << bits) << bits;
    ASSERT_TRUE(native(a >> bits) == native(a) >> bits) << bits;
  }
}

TEST(TwoWords, ConvertsAsTheCompilersOwn) {
  EXPECT_TRUE(native(TwoWords{-1}) == static_cast<uint128>(-1));
  EXPECT_TRUE(native(TwoWords{std::int64_t{-7}}) == static_cast<uint128>(-7));
  EXPECT_TRUE(native(TwoWords{~std::uint64_t{0}}) == uint128{~std::uint64_t{0}});
  const TwoWords number{0x0123456789ABCDEF, 0xFEDCBA9876543210};
  EXPECT_EQ(static_cast<std::uint64_t>(number), static_cast<std::uint64_t>(native(number)));
  EXPECT_EQ(static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(native(number)));
}

#endif

}  // namespace
}  // namespace trammel::model
