// Feed pieces from speeds, on the golden model: the time of every tick against the closed form, and refusals.
#include "trammel/driver/feed_ramp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "error_message.hpp"
#include "steps.hpp"
#include "trammel/driver/increment.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kRampHz = 1'000'000;

FeedRamp ramp_of(std::uint64_t ticks, double speed, double end_speed) { return {ticks, speed, end_speed, 0, 0ns}; }

// Clocks from the beginning of the ramp to a distance of `ticks`, by v^2 = v0^2 + 2 a s.
double clocks_to(const FeedRamp& ramp, double ticks) {
  const double a = (ramp.end_speed * ramp.end_speed - ramp.speed * ramp.speed) / (2 * static_cast<double>(ramp.ticks));
  const double speed = std::sqrt(std::max(0.0, ramp.speed * ramp.speed + 2 * a * ticks));
  return 2 * ticks / (ramp.speed + speed) * kRampHz;
}

// Clocks per tick at the speed that the ramp has half a tick before rest.
double tick_at_rest(const FeedRamp& ramp) {
  return kRampHz / ramp.speed * std::sqrt(2 * static_cast<double>(ramp.ticks));
}

// The clock of each tick of the pieces. A line with one pulse per tick makes the ticks visible.
std::vector<std::uint64_t> ticks_of(const std::vector<FeedRamp>& ramps) {
  const auto engine = sim::make_model_engine({});
  test::Steps steps;
  engine->set_sink(&steps);
  Card card = Card::open(*engine);
  Stream stream(card);
  LineCommand line;
  line.mask = 1;
  for (const FeedRamp& ramp : ramps) {
    stream.put(feed_for_ramp(ramp, kRampHz));
    line.ticks += ramp.ticks;
  }
  line.increment[0] = rounded_increment(static_cast<std::int64_t>(line.ticks), line.ticks);
  stream.put(line);
  stream.finish();
  std::vector<std::uint64_t> cycles;
  for (const PathStep& step : steps.path) cycles.push_back(step.cycle);
  EXPECT_EQ(cycles.size(), line.ticks);
  return cycles;
}

// Ramps from rest to a speed, at constant speed, to another speed, and to rest. The last tick before rest comes early,
// by half of the time that a tick takes there.
TEST(FeedRamp, TicksComeAtTheirTimes) {
  std::mt19937_64 random(3);
  const auto between = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random() % 1000) / 1000;
  };
  // 32-bit CPUs are emulated, some twenty times slower.
  constexpr int kTrials = sizeof(void*) < 8 ? 2 : 15;
  for (int i = 0; i < kTrials; ++i) {
    const double speed = between(5'000, 60'000);  // ticks/s
    const double other = between(5'000, 60'000);
    const std::vector<FeedRamp> ramps = {
        ramp_of(400 + random() % 2000, 0, speed), ramp_of(1 + random() % 1000, speed, speed),
        ramp_of(400 + random() % 2000, speed, other), ramp_of(400 + random() % 2000, other, 0)};
    const std::vector<std::uint64_t> cycles = ticks_of(ramps);
    double begin = static_cast<double>(cycles[0]) - clocks_to(ramps[0], 1);
    std::size_t tick = 0;
    for (const FeedRamp& ramp : ramps) {
      for (std::uint64_t n = 1; n <= ramp.ticks; ++n, ++tick) {
        const double late = static_cast<double>(cycles[tick]) - begin - clocks_to(ramp, static_cast<double>(n));
        // Near rest, rounding has a larger effect on the time.
        const double at_rest = ramp.end_speed == 0 ? tick_at_rest(ramp) : 0;
        ASSERT_NEAR(late, n == ramp.ticks ? -0.51 * at_rest : 0, 4 + 0.03 * at_rest)
            << "tick " << n << " of " << ramp.speed << " to " << ramp.end_speed;
      }
      begin += clocks_to(ramp, static_cast<double>(ramp.ticks));
    }
  }
}

TEST(FeedRamp, AShortPieceHasItsMeanRate) {
  const FeedCommand piece = feed_for_ramp(ramp_of(15, 400'000, 600'000), kRampHz);  // 30 clocks
  EXPECT_EQ(piece.acceleration, 0);
  EXPECT_EQ(piece.rate, std::uint64_t{1} << 63);
  EXPECT_EQ(piece.floor, static_cast<std::uint32_t>(0.4 * 0x1p32));
  // One tick per clock: the field cannot hold 1 itself.
  EXPECT_EQ(feed_for_ramp(ramp_of(100, kRampHz, kRampHz), kRampHz).rate, std::uint64_t{0} - 2048);
}

// Beyond half a tick per clock and update the field would overflow, and its sign change.
TEST(FeedRamp, TheChangeInAnUpdateIsWithinItsField) {
  for (const double most : {1.0, 0.0}) {
    EXPECT_NEAR(0x1p-64 * static_cast<double>(
                              feed_for_ramp(ramp_of(33, (1 - most) * kRampHz, most * kRampHz), kRampHz).acceleration),
                (2 * most - 1) * 16.0 / 33, 1e-12);
    EXPECT_NE(argument_error([&] {
                feed_for_ramp(ramp_of(32, (1 - most) * kRampHz, most * kRampHz), kRampHz);
              }).find("give the piece more ticks"),
              std::string::npos);
  }
  EXPECT_EQ(feed_for_ramp(ramp_of(15, 0, kRampHz), kRampHz).acceleration, 0) << "30 clocks: its mean rate";
}

// The ticks of half the slew time at the highest speed; 0 if and only if the piece ends at rest.
TEST(FeedRamp, StopDistance) {
  FeedRamp ramp = ramp_of(1000, 0, 20'000);
  EXPECT_EQ(feed_for_ramp(ramp, kRampHz).stop_distance, 1U);
  ramp.slew_time = 100ms;
  EXPECT_EQ(feed_for_ramp(ramp, kRampHz).stop_distance, 1000U);
  ramp.highest_speed = 30'000.1;
  EXPECT_EQ(feed_for_ramp(ramp, kRampHz).stop_distance, 1501U);
  ramp.highest_speed = 1;
  EXPECT_EQ(feed_for_ramp(ramp, kRampHz).stop_distance, 1000U);
  ramp.speed = 40'000;
  EXPECT_EQ(feed_for_ramp(ramp, kRampHz).stop_distance, 2000U);
  ramp.end_speed = 0;
  EXPECT_EQ(feed_for_ramp(ramp, kRampHz).stop_distance, 0U);
}

TEST(FeedRamp, IsRefused) {
  const auto refusal = [](const FeedRamp& ramp, std::uint32_t clock_hz) {
    return argument_error([&] { feed_for_ramp(ramp, clock_hz); });
  };
  const auto says = [&](const FeedRamp& ramp, std::string_view words) {
    return refusal(ramp, kRampHz).find(words) != std::string::npos;
  };
  EXPECT_EQ(refusal(ramp_of(1, 1, 0), kRampHz), "");
  EXPECT_EQ(refusal(ramp_of((std::uint64_t{1} << 40) - 1, 0, kRampHz), kRampHz), "");
  EXPECT_TRUE(says(ramp_of(0, 1, 1), "ticks, not 0"));
  EXPECT_TRUE(says(ramp_of(std::uint64_t{1} << 40, 1, 1), "ticks, not 1099511627776"));
  EXPECT_TRUE(says(ramp_of(1, 0, 0), "from rest to rest"));
  EXPECT_TRUE(says(ramp_of(1, -1, 1), "speed is 0 to 1000000 ticks/s, not -1"));
  EXPECT_TRUE(says(ramp_of(1, 1, kRampHz + 1), "end_speed is 0 to 1000000 ticks/s, not 1000001"));
  EXPECT_TRUE(says(ramp_of(1, std::numeric_limits<double>::quiet_NaN(), 1), "speed is"));
  EXPECT_TRUE(says({1, 1, 1, 2'000'000, 0ns}, "highest_speed is"));
  EXPECT_TRUE(says({1, 1, 1, 0, -1ns}, "slew time"));
  EXPECT_TRUE(says({1, kRampHz, kRampHz, 0, std::chrono::hours(3)}, "2^32 - 1"));
  EXPECT_NE(refusal(ramp_of(1, 0, 0), 0).find("0 Hz"), std::string::npos);
}

}  // namespace
}  // namespace trammel::driver
