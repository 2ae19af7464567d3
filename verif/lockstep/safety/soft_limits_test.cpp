// Lockstep of the soft limits: axes that move to and fro around their ends, with pulses as close as a shaper makes
// them, ends that change at the same time, positions across the carries of 2^31 and 2^32, and the state that a reset
// must clear; every output in every cycle.
#include "trammel/model/soft_limits.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;

constexpr unsigned kAxes = TRAMMEL_AXES;
constexpr std::uint64_t kComparedSignals = 2;
constexpr unsigned kClearing = 16;  // clocks after reset
constexpr unsigned kSameWay = 6;    // minimum clocks between two pulses in the same direction
constexpr unsigned kTurned = 13;    // minimum clocks between two pulses at a reversal

class Bench {
 public:
  using Inputs = model::SoftLimits::Inputs;

  explicit Bench(std::uint64_t seed) : check_("soft_limits", seed) { reset({}); }

  void reset(Inputs in) {
    check_.event("reset");
    dut_->rst_i = 1;
    in.position = {};
    apply(in);
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::SoftLimits(kAxes);
    compare();
    // The bus has data without `set` while the ends are cleared.
    Inputs idle;
    idle.setting = {false, reg::soft_minus(0), 0x12345678};
    for (unsigned i = 0; i < kClearing; ++i) clock(idle);
  }

  void clock(const Inputs& in) {
    if (in.counts != 0) check_.event("pulses, backwards", std::uint64_t{in.counts} << 8 | in.back);
    if (in.setting.set) check_.event("setting", std::uint64_t{in.setting.address} << 32 | in.setting.data);
    if (in.clear) check_.event("clear");
    apply(in);
    dut_.clock();
    model_.clock(in);
    compare();
    causes_ += model_.cause() ? 1U : 0U;
  }

  void set(std::uint32_t address, std::uint32_t data) {
    Inputs in;
    in.setting = {true, address, data};
    clock(in);
  }
  void wait(unsigned clocks) {
    for (; clocks != 0; --clocks) clock({});
  }

  Checker& check() { return check_; }
  std::uint64_t causes() const { return causes_; }

 private:
  void apply(const Inputs& in) {
    using namespace bus::axis_observe;
    dut_->setting_i = wire(in.setting);
    dut_->clear_i = in.clear;
    for (unsigned n = 0; n < kAxes; ++n) {
      put(dut_->axes_i, up(kPosition, kWidth * n), in.position[n]);
      put(dut_->axes_i, up(kCounts, kWidth * n), in.counts >> n & 1);
      put(dut_->axes_i, up(kCountsBack, kWidth * n), in.back >> n & 1);
    }
  }

  void compare() {
    check_.next_cycle();
    check_.compare("cause_o", dut_->cause_o, model_.cause());
    check_.compare("state_o", dut_->state_o, model_.limit_state() >> card_map::field::kLimitStateSoftAxisShift);
  }

  Simulated<Vdut> dut_;
  model::SoftLimits model_{kAxes};
  Checker check_;
  std::uint64_t causes_ = 0;
};

// The pulses of an axis, as its shaper would make them.
struct Mover {
  std::uint32_t position = 0;
  bool back = false;
  unsigned since = kTurned;

  // Makes a pulse or none.
  bool pulse(Dice& dice, bool quick) {
    ++since;
    if (since < kSameWay || !dice.chance(quick ? 2 : 30)) return false;
    const bool turns = dice.chance(6);
    if (turns && since < kTurned) return false;
    if (turns) back = !back;
    since = 0;
    return true;
  }
  void count() { position += back ? ~std::uint32_t{0} : 1U; }
};

model::Setting random_setting(Dice& dice, const std::array<Mover, kAxes>& axes) {
  const unsigned axis = dice.below(kAxes);
  const std::uint32_t here = axes[axis].position;
  switch (dice.below(6)) {
    case 0:
      return {true, reg::kSoftLimits, dice.draw() & 0xFF};
    case 1:
      return {true, reg::soft_minus(axis), dice.chance(20) ? here + 0x80000001 : here - dice.below(5)};
    case 2:
      return {true, reg::soft_plus(axis), dice.chance(20) ? here + 0x7FFFFFFF : here + dice.below(5)};
    case 3:
      return {true, dice.chance(2) ? reg::kLimitOverride : reg::mode(axis), dice.draw()};
    case 4:  // addresses below those of the axes
      return {true, 4 * dice.below(reg::mode(0) / 4), dice.draw()};
    default:
      return {true, reg::machine_zero(axis), dice.draw()};
  }
}

void random_courses() {
  const std::uint64_t seed = seed_from_environment(20261127);
  Bench bench(seed);
  Dice dice(seed);
  const std::uint64_t length = scaled(600'000);
  std::array<Mover, kAxes> axes;
  std::uint64_t cycles = 1 + kClearing;
  bool quick = true;
  for (std::uint64_t i = 0; i < length; ++i) {
    Bench::Inputs in;
    for (unsigned n = 0; n < kAxes; ++n) {
      in.position[n] = axes[n].position;
      if (!axes[n].pulse(dice, quick)) continue;
      in.counts |= static_cast<std::uint8_t>(1U << n);
      if (axes[n].back) in.back |= static_cast<std::uint8_t>(1U << n);
    }
    in.clear = dice.chance(9);
    if (dice.chance(15)) in.setting = random_setting(dice, axes);
    in.setting.set = in.setting.set && !dice.chance(4);
    ++cycles;
    if (dice.chance(5'000)) {
      bench.reset(in);
      cycles += kClearing;
      quick = dice.chance(2);
      for (Mover& axis : axes) axis = {dice.chance(2) ? 0x7FFFFFFC + dice.below(8) : dice.below(8) - 4, false, kTurned};
      continue;
    }
    bench.clock(in);
    for (unsigned n = 0; n < kAxes; ++n) {
      if ((in.counts >> n & 1) != 0) axes[n].count();
    }
  }
  EXPECT_EQ(bench.check().cycles(), cycles);
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * cycles);
  EXPECT_GT(bench.causes(), length / 100);
}

// A reset in the clock of a pulse beyond the end, at each clock of the round: the pulse has no effect. The first
// pulse after it, in the other direction, is judged and reported as if there had been none before.
void resets_beside_pulses() {
  constexpr std::uint8_t kAll = (1U << kAxes) - 1;
  constexpr unsigned kRound = 8;
  Bench bench(0);
  for (unsigned course = 0; course < 2 * kRound * kRound; ++course) {
    const bool back = course % 2 != 0;
    Bench::Inputs before;
    before.counts = kAll;
    before.back = back ? kAll : std::uint8_t{0};
    Bench::Inputs behind;
    behind.counts = kAll;
    behind.back = back ? std::uint8_t{0} : kAll;
    bench.set(reg::kSoftLimits, kAll);
    for (unsigned n = 0; n < kAxes; ++n) {
      bench.set(reg::soft_minus(n), 5);
      bench.set(reg::soft_plus(n), ~std::uint32_t{4});
    }
    bench.clock(before);
    bench.wait(kTurned + course / 2 % kRound);
    bench.reset(before);
    bench.set(reg::kSoftLimits, kAll);
    bench.wait(course / 2 / kRound);
    bench.clock(behind);
    Bench::Inputs beyond;
    beyond.position.fill(back ? 1 : ~std::uint32_t{0});
    for (unsigned i = 0; i < 2 * kRound; ++i) bench.clock(beyond);
  }
  EXPECT_GE(bench.causes(), 4 * kRound * kRound);
}

TEST(SoftLimits, ResetsBesidePulses) { EXPECT_EQ(judge(resets_beside_pulses), ""); }
TEST(SoftLimits, RandomCourses) { EXPECT_EQ(judge(random_courses), ""); }

}  // namespace
}  // namespace trammel::lockstep
