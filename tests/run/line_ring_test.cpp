#include "line_ring.hpp"

#include <gtest/gtest.h>

namespace trammel::run {
namespace {

TEST(LineRing, NamesTheLineBegunLast) {
  LineRing ring(4);
  EXPECT_EQ(ring.current(), 0U) << "nothing was put";
  ring.put(11);
  ring.put(12);
  EXPECT_EQ(ring.current(), 11U) << "nothing has begun: the first";
  ring.begun(1);
  EXPECT_EQ(ring.current(), 11U);
  ring.begun(2);
  EXPECT_EQ(ring.current(), 12U);
}

TEST(LineRing, HoldsAsManyAsAreOnTheirWay) {
  LineRing ring(4);
  for (std::size_t line = 1; line <= 100; ++line) ring.put(line);
  ring.begun(98);
  EXPECT_EQ(ring.current(), 98U);
  ring.begun(97 + 0xFFFFFFFFU + 1U);
  EXPECT_EQ(ring.current(), 100U) << "97 again is 2^32 - 1 more: beyond what was put";
}

TEST(LineRing, ClampsToWhatItHas) {
  LineRing ring(4);
  for (std::size_t line = 1; line <= 100; ++line) ring.put(line);
  EXPECT_EQ(ring.current(), 97U) << "the oldest";
}

// The card's counter has 32 bits, but a program may have more commands.
TEST(LineRing, CountsBeyond32Bits) {
  LineRing ring(2);
  ring.put(1);
  ring.put(2);
  ring.begun(0x80000000U);
  ring.begun(0xFFFFFFFFU);
  ring.begun(1);  // 2^32 + 1
  EXPECT_EQ(ring.current(), 2U);
}

}  // namespace
}  // namespace trammel::run
