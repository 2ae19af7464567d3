// Pulses on outputs beside their golden model: every pin in every clock, before and after its edge.
#include "trammel/model/pwm.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <type_traits>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;

using Pins = std::remove_reference_t<decltype(Vdut::level_i)>;
constexpr unsigned kOutputs = TRAMMEL_OUTPUTS;
constexpr std::uint32_t kPresent = (1U << kOutputs) - 1;
constexpr std::uint64_t kComparedSignals = 1;  // plus one more in each clock without a reset

class PwmBench {
 public:
  explicit PwmBench(std::uint64_t seed) : check_("pwm", seed), dice_(seed) { reset(); }

  void reset() {
    idle_ = dice_.draw() & kPresent;
    model_ = std::make_unique<model::Pwm>(kOutputs, static_cast<std::uint16_t>(idle_));
    dut_->rst_i = 1;
    in_ = {};
    drive();
    dut_.clock();
    dut_->rst_i = 0;
    check_.event("reset");
    compare();
  }

  void clock() {
    drive();
    dut_->eval();
    compare_pins();
    ++clocks_;
    dut_.clock();
    model_->clock(in_);
    compare();
  }

  // Sends the halfwords of a command in three clocks; the command is taken with the last one.
  void send(unsigned channel, const model::Pwm::Order& order) {
    const unsigned select = channel | (order.follows ? 0x10U : 0U) | unsigned{order.shift} << 8;
    const std::uint16_t words[] = {static_cast<std::uint16_t>(select), order.duty, order.gain};
    check_.event("PWM", std::uint64_t{select} << 32 | std::uint64_t{order.duty} << 16 | order.gain);
    for (unsigned i = 0; i < 3; ++i) {
      in_.load = {true, model::load_target::kCommand, words[i]};
      in_.take = i == 2;
      clock();
    }
    in_.load = {};
    in_.take = false;
  }
  // A sent command is complete one clock later.
  void apply() {
    clock();
    in_.apply = true;
    clock();
    in_.apply = false;
  }
  void set(std::uint32_t address, std::uint32_t data) {
    check_.event("setting", std::uint64_t{address} << 32 | data);
    in_.setting = {true, address, data};
    clock();
    in_.setting = {};
  }
  void wait(unsigned clocks) {
    for (unsigned i = 0; i < clocks; ++i) clock();
  }
  // The number of clocks, out of `clocks`, in which output 0 is not at its idle level.
  unsigned lit(unsigned clocks) {
    unsigned on = 0;
    for (unsigned i = 0; i < clocks; ++i) {
      clock();
      on += (dut_->pin_o ^ idle_) & 1U;
    }
    return on;
  }

  void random_clock() {
    if (dice_.chance(pace_)) act();
    in_.apply = dice_.chance(20);
    in_.drop = dice_.chance(400);
    if (dice_.chance(100)) levels_ = dice_.draw() & kPresent;
    clock();
    in_.apply = in_.drop = false;
    if (dice_.chance(300'000)) reset();
  }

  model::Pwm::Inputs& in() { return in_; }
  Checker& check() { return check_; }
  Dice& dice() { return dice_; }
  std::uint64_t pulses() const { return pulses_; }
  std::uint64_t expected() const { return kComparedSignals * check_.cycles() + clocks_; }
  std::uint32_t pins() { return dut_->pin_o; }
  std::uint32_t idle() const { return idle_; }
  void set_levels(std::uint32_t levels) { levels_ = levels & kPresent; }

 private:
  model::Pwm::Order order() {
    model::Pwm::Order o;
    o.follows = !dice_.chance(3);
    o.shift = static_cast<std::uint8_t>(dice_.below(32));
    o.duty = static_cast<std::uint16_t>(dice_.chance(8) ? 0xFFFF * dice_.below(2) : dice_.draw());
    o.gain = static_cast<std::uint16_t>(dice_.draw());
    // Mostly a scale that suits the rate.
    if (!dice_.chance(4)) {
      const double rate = (in_.speed.rate + 1.0) * 0x1p-32;
      o.shift = 0;
      while (o.shift < 31 && o.duty / (2 * rate * static_cast<double>(std::uint64_t{1} << o.shift)) >= 65536) ++o.shift;
      o.gain = static_cast<std::uint16_t>(
          std::min(65535.0, o.duty / (2 * rate * static_cast<double>(std::uint64_t{1} << o.shift))));
    }
    return o;
  }

  std::uint32_t period() {
    switch (dice_.below(5)) {
      case 0:
        return 100 + dice_.below(600);
      case 1:
        return 500 + dice_.below(30);
      case 2:
        return 100;
      default:
        return 600 + dice_.below(9400);
    }
  }

  void act() {
    switch (dice_.below(12)) {
      case 0:
        return set(dice_.chance(2) ? reg::kPwmPeriod0 : reg::kPwmPeriod1, period());
      case 1:
        return set(reg::kPwmOutputs, dice_.draw() & (dice_.chance(3) ? 0x1F001F : 0x10002U));
      case 2:
        in_.speed.ratio = dice_.chance(2) ? 0x10000 : dice_.chance(4) ? 0 : dice_.below(0x10001);
        return;
      case 3:
        in_.speed.runs = !in_.speed.runs;
        return;
      case 4:
        in_.speed.gives = !dice_.chance(3);
        return;
      case 5:
        in_.speed.silent = dice_.chance(6);
        return;
      case 6:
      case 7:
        in_.speed.rate = dice_.chance(6) ? 0xFFFFFFFF : static_cast<std::uint32_t>(dice_.log_uniform(32));
        return;
      case 8:
        pace_ = dice_.chance(3) ? 20 : dice_.chance(2) ? 200 : 4000;
        return;
      default:
        return send(dice_.below(2), order());
    }
  }

  void drive() {
    using namespace bus::feed;
    dut_->setting_i = wire(in_.setting);
    dut_->load_i = load_wire(in_.load);
    dut_->take_i = in_.take;
    dut_->apply_i = in_.apply;
    dut_->drop_i = in_.drop;
    dut_->runs_i = in_.speed.runs;
    dut_->feed_i = bus::in_place(kGives, in_.speed.gives) | bus::in_place(kSilent, in_.speed.silent) |
                   bus::in_place(kAtRest, in_.speed.ratio == 0) | bus::in_place(kRatio, in_.speed.ratio) |
                   bus::in_place(kRate, in_.speed.rate);
    dut_->level_i = static_cast<Pins>(levels_);
    dut_->idle_i = static_cast<Pins>(idle_);
  }

  void compare_pins() {
    const std::uint32_t pins =
        model_->pins(static_cast<std::uint16_t>(levels_), in_.speed.silent, in_.speed.ratio == 0);
    check_.compare("pin_o", dut_->pin_o, pins);
  }
  void compare() {
    check_.next_cycle();
    compare_pins();
    const bool on = model_->state().channels[0].on != 0;
    pulses_ += on && !was_on_ ? 1U : 0U;
    was_on_ = on;
  }

  Simulated<Vdut> dut_;
  std::unique_ptr<model::Pwm> model_;
  model::Pwm::Inputs in_;
  Checker check_;
  Dice dice_;
  std::uint32_t idle_ = 0;
  std::uint32_t levels_ = 0;
  unsigned pace_ = 200;
  std::uint64_t clocks_ = 0;
  std::uint64_t pulses_ = 0;
  bool was_on_ = false;
};

void random_traffic() {
  PwmBench bench(seed_from_environment(20261128));
  const std::uint64_t length = scaled(1'500'000);
  for (std::uint64_t i = 0; i < length; ++i) bench.random_clock();
  EXPECT_GT(bench.pulses(), length / 20'000);
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
}

// On-times at every rate, ratio and scale equal the closed form, computed without the limit of 17 bits, to one clock
// of the period.
void closed_form() {
  PwmBench bench(seed_from_environment(20261129));
  constexpr std::uint32_t kPeriod = 9000;
  bench.set(reg::kPwmPeriod0, kPeriod);
  bench.set(reg::kPwmOutputs, 1);
  bench.set_levels(~bench.idle());
  bench.in().speed.runs = bench.in().speed.gives = true;
  Dice& dice = bench.dice();
  for (unsigned i = 0; i < 40; ++i) {
    const double nominal = 0x1p31 * (1 + dice.below(1000)) / 1000;  // unit: 2^-32 ticks per clock
    const double share = (1 + dice.below(999)) / 1000.0;
    const auto duty = static_cast<std::uint16_t>(3000 + dice.below(62'000));
    const double u = nominal * 0x1p-32;
    model::Pwm::Order order{true, 0, duty, 0};
    while (duty / (2 * u * (1U << order.shift)) >= 65535.5) ++order.shift;
    order.gain = static_cast<std::uint16_t>(duty / (2 * u * (1U << order.shift)) + 0.5);
    bench.in().speed.ratio = 1 + dice.below(0x10000);
    bench.in().speed.rate = static_cast<std::uint32_t>(nominal * share);
    bench.send(0, order);
    bench.apply();
    bench.wait(2 * kPeriod);
    unsigned on = 0;
    for (unsigned k = 0; k < kPeriod; ++k) {
      bench.clock();
      on += (bench.pins() & 1U) != (bench.idle() & 1U) ? 1U : 0U;
    }
    const double exact = kPeriod * (duty * 0x1p-16) * share * bench.in().speed.ratio / 65536;
    EXPECT_NEAR(on, exact, 1.5 + exact * 0x1p-14) << "duty " << duty << ", share " << share;
  }
}

// Full duty is a constant level, and duty 0 has no pulse. A command waits for its place on the path; a dropped one
// never takes effect.
void ends_of_the_range() {
  PwmBench bench(7);
  bench.set(reg::kPwmPeriod1, 100);
  bench.set(reg::kPwmOutputs, 0x00020000);
  bench.set_levels(~bench.idle());
  const auto lit = [&](unsigned clocks) {
    unsigned on = 0;
    for (unsigned i = 0; i < clocks; ++i) {
      bench.clock();
      on += ((bench.pins() ^ bench.idle()) >> 1 & 1U);
    }
    return on;
  };
  EXPECT_EQ(lit(2000), 0U);
  bench.send(1, {false, 0, 0xFFFF, 0});
  EXPECT_EQ(lit(2000), 0U);
  bench.apply();
  bench.wait(1000);
  EXPECT_EQ(lit(1000), 1000U);
  bench.send(1, {false, 0, 0, 0});
  bench.in().drop = true;
  bench.clock();
  bench.in().drop = false;
  bench.apply();
  EXPECT_EQ(lit(1000), 1000U);
  bench.send(1, {false, 0, 0, 0});
  bench.apply();
  bench.wait(1000);
  EXPECT_EQ(lit(1000), 0U);
}

// If the duty follows the speed, nothing is on without motion; a gap between paths counts as motion.
void rest_is_dark() {
  PwmBench bench(8);
  bench.set(reg::kPwmPeriod0, 3000);
  bench.set(reg::kPwmOutputs, 1);
  bench.set_levels(~bench.idle());
  const auto lit = [&] { return ((bench.pins() ^ bench.idle()) & 1U) != 0; };
  bench.send(0, {true, 0, 0xFFFF, 0xFFFF});
  bench.apply();
  bench.in().speed = {true, true, false, 0x8000'0000, 0x10000};
  bench.wait(8000);
  EXPECT_TRUE(lit());
  bench.in().speed.runs = false;
  for (unsigned i = 0; i < 100; ++i) {
    bench.clock();
    EXPECT_TRUE(lit()) << i;
  }
  bench.wait(40);
  EXPECT_FALSE(lit());
  bench.in().speed.runs = true;
  bench.wait(8000);
  EXPECT_TRUE(lit());
  bench.in().speed.ratio = 0;
  bench.clock();
  EXPECT_FALSE(lit());
  bench.in().speed.ratio = 0x10000;
  bench.in().speed.silent = true;
  bench.clock();
  EXPECT_FALSE(lit());
  bench.in().speed = {false, false, false, 0x8000'0000, 0x10000};
  for (unsigned i = 0; i < 200; ++i) {
    bench.clock();
    EXPECT_FALSE(lit()) << i;
  }
}

// Channel 1 with the period that it has after a reset.
void period_after_a_reset() {
  PwmBench bench(12);
  bench.set(reg::kPwmOutputs, 0x00010000);
  bench.set_levels(~bench.idle());
  bench.send(1, {false, 0, 0x8000, 0});
  bench.apply();
  bench.wait(1000);
  const std::uint32_t period = card_map::find_register(reg::kPwmPeriod1).entry->reset;
  EXPECT_EQ(bench.lit(3 * period), 3 * period / 2);
}

// Sends `times` PWM commands; each one cancels the computation of an on-time before it is done.
void send_at_once(PwmBench& bench, unsigned times, const model::Pwm::Order& order) {
  for (unsigned i = 0; i < times; ++i) {
    bench.send(0, order);
    bench.apply();
  }
}

// A new period is written at each clock of the computation of an on-time. No on-time is ready before the first period
// of the new length, so that period has no pulse.
void first_period_without_an_on_time() {
  PwmBench bench(9);
  constexpr unsigned kPeriod = 400;
  const model::Pwm::Order order{false, 0, 0x8000, 0};
  bench.set(reg::kPwmOutputs, 1);
  bench.set_levels(~bench.idle());
  bench.send(0, order);
  bench.apply();
  for (unsigned clock = 0; clock < 256; ++clock) {
    bench.set(reg::kPwmPeriod0, kPeriod);
    bench.wait(1024);
    EXPECT_EQ(bench.lit(kPeriod), kPeriod / 2);
    bench.wait(clock);
    bench.set(reg::kPwmPeriod0, kPeriod);
    send_at_once(bench, 110, order);
    EXPECT_EQ(bench.lit(1), 0U);
  }
}

// No on-time is ready in the last clocks of a period, the only ones in which it is computed: the pulse keeps its old
// length, although the speed has changed.
void period_without_an_on_time() {
  PwmBench bench(11);
  const model::Pwm::Order order{true, 0, 0xFFFF, 0xFFFF};
  bench.set(reg::kPwmPeriod0, 2000);
  bench.set(reg::kPwmOutputs, 1);
  bench.set_levels(~bench.idle());
  bench.in().speed.runs = bench.in().speed.gives = true;
  for (unsigned i = 0; i < 100; ++i) {
    bench.in().speed.rate = bench.dice().draw();
    bench.wait(1300 + bench.dice().below(2000));
    send_at_once(bench, 140, order);
  }
  EXPECT_GT(bench.pulses(), 50U);
}

// The largest rates whose product is still rounded down to nothing, and the next larger ones: the product with the
// ratio, amplified by shift and gain; and the product with the gain.
void rounding_down() {
  PwmBench bench(10);
  bench.set(reg::kPwmOutputs, 1);
  bench.set_levels(~bench.idle());
  constexpr unsigned kPeriod = 32768;
  bench.set(reg::kPwmPeriod0, kPeriod);
  const auto lit = [&](std::uint32_t rate, std::uint32_t ratio) {
    bench.in().speed = {true, true, false, rate, ratio};
    bench.wait(2 * kPeriod);
    return bench.lit(kPeriod);
  };
  bench.send(0, {true, 30, 0xFFFF, 0xFFFF});
  bench.apply();
  EXPECT_EQ(lit(0x1FFFF, 1), 0U);
  EXPECT_GT(lit(0x20000, 1), kPeriod / 2);
  bench.send(0, {true, 0, 0xFFFF, 1});
  bench.apply();
  EXPECT_EQ(lit(0x7FFDFFFE, 0x10000), 0U);
  EXPECT_EQ(lit(0x7FFE0000, 0x10000), 1U);
  bench.send(0, {true, 1, 0xFFFF, 0x4000});
  bench.apply();
  EXPECT_EQ(lit(0x4000'0000, 0x10000), kPeriod / 4) << "shifted up to 2^30, which is not cut";
}

TEST(Pwm, FirstPeriodWithoutAnOnTime) { EXPECT_EQ(judge(first_period_without_an_on_time), ""); }
TEST(Pwm, PeriodWithoutAnOnTime) { EXPECT_EQ(judge(period_without_an_on_time), ""); }
TEST(Pwm, PeriodAfterAReset) { EXPECT_EQ(judge(period_after_a_reset), ""); }
TEST(Pwm, RoundingDown) { EXPECT_EQ(judge(rounding_down), ""); }
TEST(Pwm, RandomTraffic) {
  EXPECT_EQ(judge([] { random_traffic(); }), "");
}
TEST(Pwm, OnTimesFollowTheClosedForm) {
  EXPECT_EQ(judge([] { closed_form(); }), "");
}
TEST(Pwm, EndsOfTheRange) {
  EXPECT_EQ(judge([] { ends_of_the_range(); }), "");
}
TEST(Pwm, RestIsDark) {
  EXPECT_EQ(judge([] { rest_is_dark(); }), "");
}

}  // namespace
}  // namespace trammel::lockstep
