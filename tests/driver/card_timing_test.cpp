#include "trammel/driver/card_timing.hpp"

#include <gmock/gmock.h>

#include "trammel/driver/errors.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

TEST(CardTiming, NanosecondsAreRoundedUpExactly) {
  EXPECT_EQ(clocks_of(0ns, 1'000'000, "time"), 0U);
  EXPECT_EQ(clocks_of(1ns, 1'000'000, "time"), 1U);
  EXPECT_EQ(clocks_of(1us, 1'000'000, "time"), 1U);
  EXPECT_EQ(clocks_of(1001ns, 1'000'000, "time"), 2U);
  EXPECT_EQ(clocks_of(15ns, 66'666'666, "time"), 1U);
  EXPECT_EQ(clocks_of(15ns, 66'666'667, "time"), 2U) << "a clock is a hair shorter than 15 ns";
  EXPECT_THROW(clocks_of(-1ns, 1, "time"), ArgumentError);
  EXPECT_THROW(clocks_of(std::chrono::nanoseconds::max(), 4'000'000'000, "time"), ArgumentError);
}

TEST(CardTiming, ClocksComeBackAsTheTimeThatTheyTake) {
  EXPECT_EQ(time_of(3, 1'000'000), 3us);
  EXPECT_EQ(time_of(1, 66'666'667), 15ns);
  EXPECT_EQ(time_of(2, 3), 666'666'667ns);
  EXPECT_EQ(time_of(~std::uint64_t{0}, 1), std::chrono::nanoseconds::max());
}

TEST(CardTiming, StepTimesFitTheirRegister) {
  EXPECT_EQ(step_time_clocks(65535us, 1'000'000, "space"), 65535U);
  try {
    step_time_clocks(65536us, 1'000'000, "space");
    FAIL();
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("space: 65536000 ns, 65536 clocks at 1000000 Hz, is outside 0 .. 65535"));
  }
}

TEST(CardTiming, MoreAxesTakeLongerToDecode) {
  EXPECT_EQ(decode_clocks(4), 20U);
  EXPECT_EQ(decode_clocks(8), 32U);
  EXPECT_EQ(gap_free_ticks(4), 22U);
  EXPECT_EQ(gap_free_ticks(8), 34U);
}

}  // namespace
}  // namespace trammel::driver
