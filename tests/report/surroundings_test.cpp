#include "trammel/report/surroundings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "stream_reader.hpp"
#include "text.hpp"

namespace trammel::report {
namespace {

constexpr std::uint32_t kClockHz = 1'000'000;
constexpr std::uint64_t kBlock = kClockHz / Surroundings::kBlocks;

struct Kept {
  std::uint64_t cycle;
  std::int64_t pulses;
};

std::vector<Kept> kept(const std::string& page, const std::string& stream) {
  const std::vector<std::uint64_t> numbers = varints(page, stream);
  std::vector<Kept> list;
  Kept now{0, 0};
  for (std::size_t n = 0; n + 1 < numbers.size(); n += 2) {
    now.cycle += numbers[n];
    const auto half = static_cast<std::int64_t>(numbers[n + 1] >> 1U);
    now.pulses += (numbers[n + 1] & 1U) != 0 ? -half - 1 : half;
    list.push_back(now);
  }
  return list;
}

TEST(Surroundings, EachChangeOfAnInputComesBackAtItsClock) {
  Text page;
  Surroundings out(page, kClockHz, {}, 0b101);
  out.inputs(10, 0b101);  // no change
  out.inputs(250, 0b100);
  out.inputs(251, 0b110);
  out.inputs(90'000, 0b110 | std::uint64_t{1} << Surroundings::kEmergencyStop);
  out.finish();
  EXPECT_EQ(varints(page.all, "inputs"),
            (std::vector<std::uint64_t>{250, 1, 1, 2, 89'749, std::uint64_t{1} << Surroundings::kEmergencyStop}));
}

// Nothing is written while a motor follows within a quarter of a full step. The first block beyond that is written.
TEST(Surroundings, ADifferenceIsKeptWhereItHasChangedEnough) {
  Text page;
  Surroundings out(page, kClockHz, {4, 4}, 0);
  for (std::uint64_t clock = 0; clock < 100 * kBlock; clock += 20) {
    const double second = static_cast<double>(clock) / kClockHz;
    out.apart(clock, 0, 3 * std::sin(300 * second));
    out.apart(clock, 1, clock < 40 * kBlock ? 0 : 64);
  }
  out.finish();
  for (const Kept& one : kept(page.all, "apart-0")) EXPECT_LT(std::abs(one.pulses), 4);
  const std::vector<Kept> lost = kept(page.all, "apart-1");
  ASSERT_EQ(lost.size(), 1U);
  EXPECT_EQ(lost[0].pulses, 64);
  EXPECT_NEAR(static_cast<double>(lost[0].cycle), 40.0 * kBlock, kBlock);
}

// The largest difference of each block, of either sign, is written, and the last difference at rest.
TEST(Surroundings, TheLargestDifferencesAndTheLastOneAreThere) {
  Text page;
  Surroundings out(page, kClockHz, {4}, 0);
  for (std::uint64_t clock = 0; clock < 50 * kBlock; clock += 20) {
    double pulses = 10;
    if (clock == 20 * kBlock + 40) pulses = -200;
    if (clock == 30 * kBlock + 40) pulses = 300;
    if (clock + 20 >= 50 * kBlock) pulses = 12;
    out.apart(clock, 0, pulses);
  }
  out.finish();
  const std::vector<Kept> list = kept(page.all, "apart-0");
  const auto has = [&](std::uint64_t cycle, std::int64_t pulses) {
    for (const Kept& one : list) {
      if (one.cycle == cycle && one.pulses == pulses) return true;
    }
    return false;
  };
  EXPECT_TRUE(has(20 * kBlock + 40, -200));
  EXPECT_TRUE(has(30 * kBlock + 40, 300));
  EXPECT_EQ(list.back().pulses, 12);
}

// A machine that vibrates all the time: at most kBlocks differences per second are kept.
TEST(Surroundings, ALongRunKeepsFewOfAllDifferences) {
  Text page;
  Surroundings out(page, kClockHz, {4}, 0);
  constexpr unsigned kSeconds = 20;
  for (std::uint64_t clock = 0; clock < kSeconds * std::uint64_t{kClockHz}; clock += 20) {
    out.apart(clock, 0, static_cast<double>(clock / 20 % 7) * (clock / 60 % 2 == 0 ? 40.0 : -40.0));
  }
  out.finish();
  EXPECT_LE(kept(page.all, "apart-0").size(), kSeconds * Surroundings::kBlocks + 1);
}

}  // namespace
}  // namespace trammel::report
