// Lockstep of the wait timer; and of the busy timer with its closed form: busy in a clock if something ran in any of
// the last 11 clocks before it.
#include <Vdut.h>
#include <gtest/gtest.h>

#include "trammel/model/wait_timer.hpp"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

constexpr std::uint64_t kComparedSignals = 2;
constexpr std::uint32_t kBusyClocks = 11;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("timers", seed), dice_(seed) { reset(); }

  // One clock of reset: the limit has the value of the register map again, and the count is 0.
  void reset() {
    check_.event("reset");
    dut_->rst_i = 1;
    drive({});
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::WaitTimer();
    since_ran_ = kBusyClocks;
    compare();
  }

  void clock(const model::Setting& setting = {}) {
    if (setting.set) check_.event("setting", std::uint64_t{setting.address} << 32 | setting.data);
    drive(setting);
    dut_.clock();
    model_.clock(setting);
    since_ran_ = dut_->running_i != 0 ? 0 : since_ran_ + 1;
    compare();
    ticks_ += model_.tick() ? 1U : 0U;
  }

  void limit(std::uint32_t clocks) { clock({true, card_map::reg::kHoldLimit, clocks}); }

  Checker& check() { return check_; }
  Dice& dice() { return dice_; }
  std::uint64_t ticks() const { return ticks_; }

 private:
  void drive(const model::Setting& setting) {
    dut_->setting_i = wire(setting);
    if (dice_.chance(200)) calm_ = !calm_;
    dut_->running_i = dice_.chance(calm_ ? 14 : 3);
  }

  void compare() {
    check_.next_cycle();
    check_.compare("tick_o", dut_->tick_o, model_.tick());
    check_.compare("busy_o", dut_->busy_o, since_ran_ < kBusyClocks);
  }

  Simulated<Vdut> dut_;
  model::WaitTimer model_;
  Checker check_;
  Dice dice_;
  std::uint32_t since_ran_ = kBusyClocks;
  bool calm_ = true;
  std::uint64_t ticks_ = 0;
};

// The limit after reset, then each limit from 1 to 300 and those at the end of 16 bits, for a little more than two
// periods.
void every_limit() {
  Bench bench(1);
  std::uint64_t cycles = 1;
  std::uint64_t ticks = 0;
  const auto run = [&](std::uint64_t clocks) {
    for (std::uint64_t i = 0; i < clocks; ++i) bench.clock();
    cycles += clocks;
  };
  run(2 * 65535 + 100);
  ticks += 2;
  EXPECT_EQ(bench.ticks(), ticks);
  for (std::uint32_t limit = 1; limit <= 300; ++limit) {
    bench.reset();
    bench.limit(limit);
    run(2 * limit + 3);
    cycles += 2;
  }
  for (const std::uint32_t limit : {65534U, 65535U, 256U, 255U, 32768U}) {
    bench.limit(limit);
    run(2 * limit + 3);
    ++cycles;
  }
  EXPECT_EQ(bench.check().cycles(), cycles);
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * cycles);
}

// Limits that change during a count, also to below the count, and other settings.
void random_limits() {
  Bench bench(seed_from_environment(20261120));
  Dice& dice = bench.dice();
  const std::uint64_t length = scaled(300'000);
  std::uint64_t cycles = 1;
  for (; cycles < length; ++cycles) {
    if (dice.chance(5000)) {
      bench.reset();
    } else if (dice.chance(50)) {
      bench.limit(1 + static_cast<std::uint32_t>(dice.log_uniform(dice.chance(20) ? 16 : 8)) % 0xFFFF);
    } else if (dice.chance(50)) {
      // Another setting, or the limit's own address without `set`.
      const std::uint32_t word = dice.below(10);
      bench.clock({word != 0 && dice.chance(2), card_map::reg::kHoldLimit + 4 * word, dice.draw()});
    } else {
      bench.clock();
    }
  }
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * cycles);
  EXPECT_GT(bench.ticks(), length / 1000);
}

TEST(Timers, EveryLimit) { EXPECT_EQ(judge(every_limit), ""); }
TEST(Timers, RandomLimits) { EXPECT_EQ(judge(random_limits), ""); }

}  // namespace
}  // namespace trammel::lockstep
