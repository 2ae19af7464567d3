// The model of the wait timer: one tick in every `limit` clocks, regardless of the limit before.
#include "trammel/model/wait_timer.hpp"

#include <gtest/gtest.h>

#include "trammel/skip/axis.hpp"

namespace trammel::model {
namespace {

constexpr std::uint32_t kLimitAfterReset = 0xFFFF;

TEST(WaitTimer, TicksOnceInEachLimit) {
  for (const std::uint32_t limit : {1U, 2U, 3U, 300U, 65535U}) {
    WaitTimer timer;
    timer.clock({true, card_map::reg::kHoldLimit, limit});
    // The clock of the setting counts already, with the limit after reset.
    for (std::uint32_t clocks = 2; clocks <= 4 * limit; ++clocks) {
      timer.clock({});
      EXPECT_EQ(timer.tick(), clocks % limit == 0) << limit << " " << clocks;
    }
  }
}

TEST(WaitTimer, LimitBelowTheCountTicksAtOnce) {
  WaitTimer timer;
  for (int i = 0; i < 100; ++i) timer.clock({});
  timer.clock({true, card_map::reg::kHoldLimit, 7});
  EXPECT_FALSE(timer.tick());
  timer.clock({});
  EXPECT_TRUE(timer.tick());
}

TEST(WaitTimer, AdvanceIsAsManyClocks) {
  for (std::uint64_t n : {1U, 2U, 299U, 300U, 301U, 12345U}) {
    WaitTimer one_by_one;
    WaitTimer at_once;
    for (WaitTimer* timer : {&one_by_one, &at_once}) {
      for (int i = 0; i < 500; ++i) timer->clock({});
      timer->clock({true, card_map::reg::kHoldLimit, 300});
    }
    for (std::uint64_t i = 0; i < n; ++i) one_by_one.clock({});
    skip::pass(at_once, n);
    for (int i = 0; i < 600; ++i) {
      EXPECT_EQ(one_by_one.tick(), at_once.tick()) << n << " " << i;
      one_by_one.clock({});
      at_once.clock({});
    }
  }
  EXPECT_EQ(WaitTimer().limit(), kLimitAfterReset);
}

}  // namespace
}  // namespace trammel::model
