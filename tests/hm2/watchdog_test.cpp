// The watchdog: a bite ends the motion at once, the counter stays equal to the pins, and nothing moves until the driver
// has cleared the bite and commands again. Other cards go on counting after a bite while their pins are silent.
#include "trammel/hm2/watchdog.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "bench.hpp"

namespace trammel::hm2 {
namespace {

constexpr std::uint32_t kFiveMilliseconds = kClock / 200 - 1;  // expires after timer + 1 clocks

TEST(Hm2Watchdog, ItsTimeIsTheTimerAndOneClock) {
  Watchdog watchdog;
  EXPECT_EQ(watchdog.deadline(), Watchdog::kNever) << "off after a reset";
  watchdog.set_timer(99, 1000);
  EXPECT_EQ(watchdog.deadline(), 1100U);
  watchdog.reset(kPet, 1050);
  EXPECT_EQ(watchdog.deadline(), 1150U);
  watchdog.reset(0, 1060);
  EXPECT_EQ(watchdog.deadline(), 1150U) << "without its key";
  watchdog.set_timer(0x80000000, 1070);
  EXPECT_EQ(watchdog.deadline(), Watchdog::kNever);
}

TEST(Hm2Watchdog, OnlyZeroClearsABite) {
  Watchdog watchdog;
  watchdog.set_timer(99, 0);
  EXPECT_FALSE(watchdog.set_status(0, 10)) << "nothing to clear";
  watchdog.bite();
  EXPECT_EQ(watchdog.deadline(), Watchdog::kNever);
  watchdog.reset(kPet, 20);
  EXPECT_FALSE(watchdog.set_status(1, 30));
  EXPECT_TRUE(watchdog.bitten());
  EXPECT_TRUE(watchdog.set_status(0, 40));
  EXPECT_FALSE(watchdog.bitten());
  EXPECT_EQ(watchdog.deadline(), 140U);
}

void move_under_watchdog(Bench& bench, double pulses_per_second, int milliseconds) {
  bench.write(map_at::kWatchdogTimer, {kFiveMilliseconds});
  bench.pet();
  for (int n = 0; n < milliseconds; ++n) {
    bench.set_rate(0, rate_of(pulses_per_second));
    bench.set_rate(1, -rate_of(pulses_per_second / 3));
    bench.pet();
    bench.run(0.001);
  }
}

TEST(Hm2Watchdog, ABiteEndsTheMotionAtOnceAndTheCounterIsThatOfThePins) {
  for (const double speed : {500.0, 20'000.0, 200'000.0}) {
    Bench bench;
    move_under_watchdog(bench, speed, 20);
    EXPECT_EQ(bench.read(map_at::kWatchdogStatus), 0U);
    const std::uint64_t last_pet = bench.engine->cycles() - kClock / 1000;
    bench.run(0.1);
    EXPECT_EQ(bench.read(map_at::kWatchdogStatus), 1U);
    EXPECT_EQ(bench.hostmot2.bites(), 1U);
    ASSERT_FALSE(bench.steps.pins.empty());
    const double late = (static_cast<double>(bench.steps.pins.back().cycle - last_pet) / kClock) - 0.005;
    EXPECT_LT(late, 100e-6) << "from the end of its time to the last pulse";
    EXPECT_GT(late, -100e-6 - 1 / speed) << "it moved until then";
    for (unsigned n = 0; n < 2; ++n) {
      EXPECT_EQ(bench.pins(n), bench.counter(n));
      EXPECT_EQ(bench.place(n), static_cast<double>(bench.pins(n)));
    }
  }
}

TEST(Hm2Watchdog, AfterABiteNothingMovesUntilItIsClearedAndCommandedAnew) {
  Bench bench;
  move_under_watchdog(bench, 20'000, 10);
  bench.run(0.02);
  ASSERT_EQ(bench.read(map_at::kWatchdogStatus), 1U);
  const std::int64_t stood = bench.pins(0);
  for (int n = 0; n < 50; ++n) {  // a driver that has not noticed the bite
    bench.set_rate(0, rate_of(20'000));
    bench.pet();
    bench.run(0.001);
  }
  EXPECT_EQ(bench.read(map_at::kWatchdogStatus), 1U) << "writing the watchdog clears nothing";
  EXPECT_EQ(bench.pins(0), stood);
  bench.write(map_at::kWatchdogStatus, {0});
  bench.pet();
  bench.run(0.004);
  EXPECT_EQ(bench.pins(0), stood) << "clearing starts nothing";
  bench.set_rate(0, rate_of(20'000));
  bench.pet();
  bench.run(0.004);
  EXPECT_GT(bench.pins(0), stood + 50);
  EXPECT_EQ(bench.pins(0), bench.counter(0));
}

// The way in which hm2_eth ends: a timer of two clocks.
TEST(Hm2Watchdog, ADriverThatLeavesInOrderStopsTheMotion) {
  Bench bench;
  move_under_watchdog(bench, 20'000, 10);
  bench.write(map_at::kWatchdogTimer, {1});
  const std::uint64_t left = bench.engine->cycles();
  bench.run(0.01);
  EXPECT_EQ(bench.hostmot2.bites(), 1U);
  EXPECT_LT(bench.steps.pins.back().cycle, left + kClock / 10'000);
}

// A fault of the card ends the motion. The driver sees it as a bite.
TEST(Hm2Watchdog, AFaultOfTheCardShowsAsABiteUntilItsCauseHasGone) {
  Bench bench;
  bench.set_rate(0, rate_of(20'000));
  bench.run(0.01);
  bench.engine->set_emergency_stop(true);
  bench.run(0.01);
  EXPECT_EQ(bench.read(map_at::kWatchdogStatus), 1U);
  const std::int64_t stood = bench.pins(0);
  EXPECT_EQ(stood, bench.counter(0));
  bench.write(map_at::kWatchdogStatus, {0});
  bench.run(0.01);
  EXPECT_EQ(bench.read(map_at::kWatchdogStatus), 1U) << "the button is still pressed";
  bench.engine->set_emergency_stop(false);
  bench.run(0.001);
  bench.write(map_at::kWatchdogStatus, {0});
  bench.set_rate(0, rate_of(20'000));
  bench.run(0.01);
  EXPECT_EQ(bench.read(map_at::kWatchdogStatus), 0U);
  EXPECT_GT(bench.pins(0), stood + 100);
}

}  // namespace
}  // namespace trammel::hm2
