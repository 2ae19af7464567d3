#include "trammel/sim/timed_bus.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <vector>

#include "trammel/card_map.hpp"
#include "trammel/sim/engines.hpp"

namespace {

using namespace trammel;
namespace reg = card_map::reg;

constexpr std::uint32_t kClock = 1'000'000;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

class TimedBus : public testing::TestWithParam<sim::EngineKind> {
 protected:
  TimedBus() {
    sim::SimulationOptions options;
    options.kind = GetParam();
    options.clock_hz = kClock;
    engine = sim::make_engine(options);
  }
  std::unique_ptr<sim::Engine> engine;
};

INSTANTIATE_TEST_SUITE_P(Engines, TimedBus, testing::Values(sim::EngineKind::kRtl, sim::EngineKind::kModel),
                         [](const auto& row) { return row.param == sim::EngineKind::kRtl ? "rtl" : "model"; });

TEST_P(TimedBus, EventsInWaitsComeInTheirClockAndInOrder) {
  sim::TimedBus bus(*engine, kClock, kNoLimit);
  std::vector<std::pair<int, std::uint64_t>> seen;
  const auto note = [&](int name) { return [&seen, name](sim::Engine& e) { seen.emplace_back(name, e.cycles()); }; };
  bus.at(5000, note(2));
  bus.at(1000, note(0));
  bus.at(5000, note(3));
  bus.at(1001, [&](sim::Engine& e) {
    note(1)(e);
    bus.at(6000, note(4));
  });
  bus.sleep(std::chrono::milliseconds(10));
  EXPECT_EQ(seen, (std::vector<std::pair<int, std::uint64_t>>{{0, 1000}, {1, 1001}, {2, 5000}, {3, 5000}, {4, 6000}}));
  EXPECT_EQ(engine->cycles(), 10'000U) << "notes take no time";
}

TEST_P(TimedBus, EventsBesideAccessesComeWithinTwentyClocks) {
  sim::TimedBus bus(*engine, kClock, kNoLimit);
  for (std::uint64_t due = 1000; due < 3000; due += 37) {
    bus.at(due, [due](sim::Engine& e) {
      EXPECT_GE(e.cycles(), due);
      e.write(reg::kHold, due & 1);
      EXPECT_LE(e.cycles(), due + 20);
      EXPECT_EQ(e.read(reg::kHold), due & 1);
    });
  }
  while (engine->cycles() < 3500) {
    driver::Access access = driver::read_of(reg::kStatus);
    ASSERT_EQ(bus.transfer(&access, 1), 1U);
  }
}

TEST_P(TimedBus, CarriesSoManyBytesASecondAndNoMore) {
  const std::uint64_t first = engine->cycles();
  sim::TimedBus bus(*engine, kClock, 8000);  // 500 clocks per word
  std::vector<driver::Access> accesses(100, driver::read_of(reg::kMagic));
  ASSERT_EQ(bus.transfer(accesses.data(), 60), 60U);
  ASSERT_EQ(bus.transfer(accesses.data(), 40), 40U);
  EXPECT_EQ(accesses[59].data, card_map::kMagicValue);
  EXPECT_EQ(engine->cycles() - first, 50'000U);
  driver::Access refused = driver::read_of(0x7FC);
  EXPECT_EQ(bus.transfer(&refused, 1), 0U);
  EXPECT_EQ(engine->cycles() - first, 50'500U) << "a refusal takes the bus as long";
  bus.sleep(std::chrono::milliseconds(1));
  EXPECT_EQ(engine->cycles() - first, 51'500U) << "waits take their own time alone";
}

TEST_P(TimedBus, FractionsOfAClockAddUp) {
  engine->wait(700);  // after a reset, accesses wait this long
  const std::uint64_t first = engine->cycles();
  sim::TimedBus bus(*engine, kClock, 4e6 / 30.25);
  std::vector<driver::Access> accesses(400, driver::read_of(reg::kMagic));
  ASSERT_EQ(bus.transfer(accesses.data(), 400), 400U);
  EXPECT_NEAR(static_cast<double>(engine->cycles() - first), 12'100, 1);
}

TEST_P(TimedBus, RefusesABusThatCarriesNothing) {
  EXPECT_THROW(sim::TimedBus(*engine, kClock, 0), std::invalid_argument);
  EXPECT_THROW(sim::TimedBus(*engine, kClock, std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
}

}  // namespace
