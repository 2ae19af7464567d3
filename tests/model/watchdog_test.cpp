// The rule of the watchdog: it expires a given time after the last write.
#include "trammel/model/watchdog.hpp"

#include <gtest/gtest.h>

namespace trammel::model {
namespace {

Setting units(std::uint32_t time) { return {true, card_map::reg::kWatchdog, time}; }

// Clocks from the write until it expires; `longest` if it has not expired by then.
std::uint64_t clocks_to_expiry(Watchdog& watchdog, std::uint64_t longest) {
  std::uint64_t clocks = 1;
  for (; clocks < longest && !watchdog.expired(); ++clocks) watchdog.clock({});
  return clocks;
}

TEST(Watchdog, ExpiresWhenItsTimeHasPassed) {
  for (const std::uint32_t time : {1U, 2U, 5U}) {
    Watchdog watchdog;
    watchdog.clock(units(time));
    EXPECT_EQ(clocks_to_expiry(watchdog, 1'000'000), time * 65'536 + 2);
  }
}

TEST(Watchdog, EachWriteStartsItAnew) {
  Watchdog watchdog;
  for (int i = 0; i < 5; ++i) {
    watchdog.clock(units(1));
    for (int clock = 0; clock < 65'536; ++clock) watchdog.clock({});
    EXPECT_FALSE(watchdog.expired()) << i;
  }
  EXPECT_EQ(clocks_to_expiry(watchdog, 10), 2U) << "the next clock, as no write came";
}

TEST(Watchdog, RunsOnlyWhenItIsGivenATime) {
  Watchdog watchdog;
  EXPECT_EQ(clocks_to_expiry(watchdog, 200'000), 200'000U) << "after reset";
  watchdog.clock(units(1));
  watchdog.clock(units(0));
  EXPECT_EQ(clocks_to_expiry(watchdog, 200'000), 200'000U);
  watchdog.clock({true, card_map::reg::kHoldLimit, 1});
  watchdog.clock({false, card_map::reg::kWatchdog, 1});
  EXPECT_EQ(clocks_to_expiry(watchdog, 200'000), 200'000U) << "another register, and no write";
}

TEST(Watchdog, StaysExpiredUntilItIsWritten) {
  for (const std::uint32_t time : {0U, 3U}) {
    Watchdog watchdog;
    watchdog.clock(units(1));
    clocks_to_expiry(watchdog, 100'000);
    for (int clock = 0; clock < 200'000; ++clock) watchdog.clock({});
    EXPECT_TRUE(watchdog.expired());
    watchdog.clock(units(time));
    EXPECT_FALSE(watchdog.expired());
  }
}

}  // namespace
}  // namespace trammel::model
