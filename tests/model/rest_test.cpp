// The area REST on the golden card: whatever runs and whenever a fault stops it, the positions are those of the ticks
// taken, according to the steps of the path itself, and no pulse follows.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core_bench.hpp"
#include "feed_paths.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

// A card that runs a path and stops after a given number of clocks.
struct Bench : CoreBench {
  explicit Bench(std::uint32_t pulse) : CoreBench(all_engines()) {
    for (unsigned n = 0; n < 4; ++n) {
      write(reg::step_length(n), pulse);
      write(reg::step_space(n), pulse);
    }
    write(reg::kSlew, 0x400000);
  }
  void begin(const Path& path) {
    ASSERT_TRUE(feed(path.ticks, kEvery16));
    ASSERT_TRUE(path.send(*this));
    ASSERT_TRUE(end());
  }
  void stop_in(std::uint64_t clocks, bool ramp) {
    write(reg::kStopReaction, ramp ? field::kStopReactionWatchdog : 0);
    write(reg::kWatchdog, 1);
    idle(2);  // the write reaches the watchdog
    core.state().motion.state().watchdog.state().left = clocks;
    idle(clocks);
    for (int i = 0; i < 10'000 && !core.state().motion.state().stop.stopped(); ++i) idle(1);
  }
  std::int32_t pulses(unsigned axis) const {
    std::int32_t sum = 0;
    for (const auto& [cycle, n, direction] : steps.pins) sum += n == axis ? direction : 0;
    return sum;
  }
};

void judge(const Path& path, std::uint64_t clocks, bool ramp, std::uint32_t pulse) {
  Bench whole(pulse);
  whole.begin(path);
  ASSERT_TRUE(whole.finish(100 * path.ticks + 100'000));
  Bench stopped(pulse);
  stopped.begin(path);
  stopped.stop_in(clocks, ramp);
  const std::string what = std::to_string(path.ticks) + " ticks, stopped after " + std::to_string(clocks) +
                           (ramp ? " clocks on a ramp" : " clocks at once");
  ASSERT_TRUE(stopped.core.state().motion.state().stop.stopped()) << what;
  const std::size_t pins = stopped.steps.pins.size();
  ASSERT_EQ(stopped.read(reg::kRestFault), field::kFaultWatchdog);
  EXPECT_NE(stopped.read(reg::kRestStatus) & field::kStatusSettled, 0U) << what;
  const std::uint64_t left = stopped.read(reg::kRestTicksLeftLo) | std::uint64_t{stopped.read(reg::kRestTicksLeftHi)}
                                                                       << 32;
  const std::uint32_t begun = stopped.read(reg::kRestGeometryBegun);
  ASSERT_LE(left, path.ticks) << what;
  ASSERT_TRUE(begun == 1 || left == 0) << what;
  const std::uint64_t taken = path.path_ticks(begun == 0 ? 0 : path.ticks - left);
  std::vector<std::int32_t> expected(4, 0);
  for (const auto& [command, tick, axis, direction, cycle] : whole.steps.path) {
    if (tick <= taken) expected[axis] += direction;
  }
  const std::uint64_t time = stopped.read(reg::kRestTimeLo);
  for (unsigned n = 0; n < 4; ++n) {
    const auto position = static_cast<std::int32_t>(stopped.read(reg::rest_position(n)));
    EXPECT_EQ(position, expected[n]) << what << ", axis " << n << ", " << left << " left";
    EXPECT_EQ(position, stopped.pulses(n)) << what;
  }
  for (const auto& [cycle, axis, direction] : stopped.steps.pins) EXPECT_LE(cycle, time) << what;
  stopped.write(reg::kWatchdog, 0);
  stopped.write(reg::kFault, ~0U & card_map::find_register(reg::kFault).entry->mask);
  stopped.idle(2000);
  EXPECT_EQ(stopped.steps.pins.size(), pins) << "clearing moves nothing";
  EXPECT_EQ(stopped.read(reg::kRestTimeLo), time) << "an idle card keeps it";
}

template <class Make>
void at_any_moment(const Make& make, std::uint64_t salt) {
  std::mt19937_64 random(seed() + salt);
  for (int i = 0; i < 25; ++i) {
    const Path path = make(random);
    const std::uint64_t clocks = 40 + random() % (17 * path.ticks + 200);
    const std::uint32_t pulse = random() % 3 == 0 ? 4 : 1;
    for (const bool ramp : {false, true}) judge(path, clocks, ramp, pulse);
  }
}

TEST(Rest, OnALinePositionsAreThoseOfTheTicksTaken) { at_any_moment(random_line, 1); }
TEST(Rest, OnTheAccumulator) {
  at_any_moment([](auto& random) { return random_circle(random, false); }, 2);
}
TEST(Rest, OnTheAccumulatorInEightDirections) {
  at_any_moment([](auto& random) { return random_circle(random, true); }, 3);
}
TEST(Rest, OnTheArcGenerator) { at_any_moment(random_chords, 4); }

// REST of an abort is exact at rest too. In motion STATUS.settled says that it is not exact. An abort of an idle card
// keeps the last REST.
TEST(Rest, AnAbortsIsExactAtRest) {
  for (const bool hold : {true, false}) {
    std::mt19937_64 random(seed());
    Bench bench(1);
    const Path path = random_line(random);
    bench.begin(path);
    bench.idle(1000);
    if (hold) bench.write(reg::kHold, 1);
    bench.idle(hold ? 5000 : 1);
    EXPECT_EQ((bench.read(reg::kStatus) & field::kStatusSettled) != 0, hold);
    bench.write(reg::kControl, field::kControlAbort);
    bench.idle(100);
    EXPECT_EQ((bench.read(reg::kRestStatus) & field::kStatusSettled) != 0, hold);
    EXPECT_EQ(bench.read(reg::kRestGeometryBegun), 1U);
    EXPECT_EQ(bench.read(reg::kRestTicksLeftLo) != 0, hold);
    const std::uint32_t time = bench.read(reg::kRestTimeLo);
    bench.write(reg::kControl, field::kControlAbort);
    bench.idle(100);
    EXPECT_EQ(bench.read(reg::kRestTimeLo), time);
  }
}

}  // namespace
}  // namespace trammel::testing
