// Lockstep of the watchdog: short times to their end, writes close to it, and other settings; compared in every
// cycle.
#include "trammel/model/watchdog.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

constexpr std::uint64_t kComparedSignals = 2;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("watchdog", seed) { reset({}); }

  void reset(const model::Setting& setting) {
    check_.event("reset");
    dut_->rst_i = 1;
    dut_->setting_i = wire(setting);
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::Watchdog();
    compare();
  }

  void clock(const model::Setting& setting = {}) {
    if (setting.set) check_.event("setting", std::uint64_t{setting.address} << 32 | setting.data);
    dut_->setting_i = wire(setting);
    dut_.clock();
    const bool before = model_.expired();
    model_.clock(setting);
    expiries_ += model_.expired() && !before ? 1U : 0U;
    compare();
  }

  void run(std::uint64_t clocks) {
    for (; clocks != 0; --clocks) clock();
  }

  Checker& check() { return check_; }
  std::uint64_t expiries() const { return expiries_; }

 private:
  void compare() {
    check_.next_cycle();
    check_.compare("expired_o", dut_->expired_o, model_.expired());
    check_.compare("running_o", dut_->running_o, model_.running());
  }

  Simulated<Vdut> dut_;
  model::Watchdog model_;
  Checker check_;
  std::uint64_t expiries_ = 0;
};

model::Setting time_of(std::uint32_t units) { return {true, card_map::reg::kWatchdog, units}; }

// Each time to its end and beyond; rewritten half way, and in each of the last clocks before it.
void around_the_end() {
  Bench bench(0);
  for (const std::uint32_t units : {1U, 2U, 3U}) {
    bench.clock(time_of(units));
    bench.run((units + 1) * model::Watchdog::kUnitClocks);
  }
  EXPECT_EQ(bench.expiries(), 3U);
  for (const std::uint32_t units : {1U, 2U}) {
    bench.clock(time_of(units));
    bench.run(model::Watchdog::kUnitClocks / 2);
  }
  bench.run(2 * model::Watchdog::kUnitClocks);
  EXPECT_EQ(bench.expiries(), 4U);
  for (std::uint64_t before = 0; before < 5; ++before) {
    bench.clock(time_of(1));
    bench.run(model::Watchdog::kUnitClocks + 3 - before);
  }
  EXPECT_EQ(bench.expiries(), 7U) << "the two shortest runs are written anew in time";
  bench.clock(time_of(0));
  bench.run(2 * model::Watchdog::kUnitClocks);
  EXPECT_EQ(bench.expiries(), 7U);
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * bench.check().cycles());
}

void random_writes() {
  const std::uint64_t seed = seed_from_environment(20261123);
  Bench bench(seed);
  Dice dice(seed);
  const std::uint64_t length = scaled(4'000'000);
  for (std::uint64_t i = 0; i < length; ++i) {
    const std::uint32_t address = card_map::reg::kWatchdog + (dice.chance(2) ? 0 : 4 * dice.below(8));
    // Mostly a short time, which may expire before the next write.
    constexpr std::uint32_t kShort[] = {0, 1, 1, 1, 1, 1, 2, 2};
    const std::uint32_t units = dice.chance(8) ? dice.below(0x10000) : kShort[dice.below(8)];
    const model::Setting setting{dice.chance(2), address, units};
    if (dice.chance(300'000))
      bench.reset(setting);
    else if (dice.chance(25'000))
      bench.clock(setting);
    else
      bench.clock();
  }
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * (length + 1));
  EXPECT_GT(bench.expiries(), length / 1'000'000);
}

TEST(Watchdog, AroundTheEnd) { EXPECT_EQ(judge(around_the_end), ""); }
TEST(Watchdog, RandomWrites) { EXPECT_EQ(judge(random_writes), ""); }

}  // namespace
}  // namespace trammel::lockstep
