// Lockstep of the time base: RTL and model, every output in every cycle.
#include "trammel/model/time_base.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "Vdut.h"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;

constexpr std::uint64_t kComparedSignals = 2;
constexpr bool kClasses = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kClasses);

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : checker_("time_base", seed), dice_(seed) { reset(); }

  // One clock of reset: ratio, target and slew have the values of the register map again, and the clocks of an update
  // are counted from 0.
  void reset() {
    checker_.event("reset");
    dut_->rst_i = 1;
    clock_dut({});
    dut_->rst_i = 0;
    model_ = model::TimeBase(kClasses);
    snapshot_ = {};
    class_ = card_map::constant::kClassFeed;
    slew_shift_ = 0;
    compare();
  }

  // The class of the piece in force from now on. A card without classes has only one ratio.
  void piece(std::uint8_t piece_class) {
    checker_.event("class", piece_class);
    class_ = piece_class;
  }

  // The number of doublings of the slew from now on.
  void shift_slew(unsigned doublings) {
    checker_.event("slew shift", doublings);
    slew_shift_ = static_cast<std::uint8_t>(doublings);
  }

  // One clock; `setting` arrives in it.
  void clock(bool hold, const model::Setting& setting = {}) {
    dut_->hold_i = hold;
    dut_->class_i = class_;
    dut_->slew_shift_i = slew_shift_;
    const std::uint32_t ratio = model_.outputs().ratio;
    const std::uint32_t left = dice_.below(256);
    dut_->left_i = static_cast<CData>(left);
    clock_dut(setting);
    model_.clock({hold, setting, kClasses ? class_ : std::uint8_t{card_map::constant::kClassFeed}, slew_shift_});
    // STATUS and FAULT pass through this slice: 22 bits.
    snapshot_.clock(dut_->snapshot_i, get(dut_->snapshot_i, bus::snapshot::kRest) != 0 ? left : ratio);
    compare();
  }

  void set(std::uint32_t address, std::uint32_t value, bool hold) {
    checker_.event("setting", std::uint64_t{address} << 32 | value);
    clock(hold, {true, address, value});
  }

  void run(bool hold, std::uint64_t clocks) {
    checker_.event("hold", hold);
    for (std::uint64_t i = 0; i < clocks; ++i) clock(hold);
  }

  // Checks that every signal was compared in every cycle, and the number of cycles of the scenario.
  void expect_cycles(std::uint64_t cycles) const {
    EXPECT_EQ(checker_.cycles(), cycles);
    EXPECT_EQ(checker_.comparisons(), kComparedSignals * cycles + chained_);
    EXPECT_GT(chained_, cycles / 2);
  }

  Dice& dice() { return dice_; }

 private:
  void clock_dut(const model::Setting& setting) {
    dut_->setting_i = wire(setting);
    // Only 22 bits pass.
    dut_->snapshot_i = dice_.snapshot() & ~bus::in_place({22, 10}, ~std::uint64_t{0});
    dut_.clock();
  }

  void compare() {
    checker_.next_cycle();
    checker_.compare("enable_o", dut_->enable_o, model_.outputs().enable);
    checker_.compare("ratio_o", dut_->ratio_o, model_.outputs().ratio);
    if (!snapshot_.known()) return;
    checker_.compare("snapshot_o, word", get(dut_->snapshot_o, bus::snapshot::kWord), snapshot_.word());
    ++chained_;
  }

  Checker checker_;
  Dice dice_;
  Simulated<Vdut> dut_;
  model::TimeBase model_{kClasses};
  SnapshotWord snapshot_;
  std::uint8_t class_ = card_map::constant::kClassFeed;
  std::uint8_t slew_shift_ = 0;
  std::uint64_t chained_ = 0;
};

// Ratios at and around 0, 1 and the goal, slews of one unit and of the whole range at once; hold and resume in
// between.
void directed() {
  Bench bench(0);
  std::uint64_t cycles = 1;
  const auto run = [&](std::uint32_t target, std::uint32_t slew, bool hold, std::uint64_t clocks) {
    bench.set(reg::kRatioFeed, target, hold);
    bench.set(reg::kSlew, slew, hold);
    bench.run(hold, clocks);
    cycles += clocks + 2;
  };
  for (const std::uint32_t slew : {0xFFF'FFFFU, 0xFFF'FFFEU, 0x100'0001U, 0x123'4567U}) {
    for (const std::uint32_t target : {0x10000U, 0xFFFFU, 1U, 0U, 0x8000U, 0x5EB8U}) {
      run(target, slew, false, 203);
      run(target, slew, true, 61);
      run(target, slew, false, 30);
    }
  }
  run(0x10000, 1, false, 4001);
  run(0xFFFF, 1, false, 20011);
  run(0, 0, false, 50);
  run(3, 0xFFF, false, 70001);
  bench.expect_cycles(cycles);
}

// A ratio less than 2^-16 above its goal does not count as arrived: one update with a slew that leads there, some
// with none, then slowly to the lower goal.
void just_above_the_goal() {
  Bench bench(0);
  std::uint64_t cycles = 1;
  const auto set = [&](std::uint32_t address, std::uint32_t value, std::uint64_t clocks) {
    bench.set(address, value, false);
    bench.run(false, clocks);
    cycles += clocks + 1;
  };
  for (const auto& [slew, target] : {std::pair{1U, 0xFFFFU}, {4095U, 0xFFFFU}, {8191U, 0xFFFEU}}) {
    bench.reset();
    ++cycles;
    set(reg::kSlew, 0, 0);
    set(reg::kRatioFeed, target, 9);
    set(reg::kSlew, slew, 3);
    set(reg::kSlew, 0, 8);
    set(reg::kRatioFeed, target - 1, 7);
    set(reg::kSlew, 1, 40);
  }
  bench.expect_cycles(cycles);
}

// Each class's ratio in each clock of an update, with slews of many updates and of one; no class has the ratio of
// another.
void classes() {
  Bench bench(0);
  std::uint64_t cycles = 1;
  const auto set = [&](std::uint32_t address, std::uint32_t value) {
    bench.set(address, value, false);
    ++cycles;
  };
  for (const std::uint32_t slew : {0xFFF'FFFFU, 0x80'0001U}) {
    set(reg::kSlew, slew);
    set(reg::kRatioFeed, 0x5EB8);
    set(reg::kRatioRapid, 0xC001);
    set(reg::kRatioFixed, 0x10000);
    for (unsigned clock = 0; clock < 8; ++clock) {
      for (const unsigned piece : {0U, 1U, 2U, 1U, 0U, 2U, 0U}) {
        bench.piece(static_cast<std::uint8_t>(piece));
        bench.run(false, 96 + clock);
        cycles += 96 + clock;
      }
    }
    // Sets the ratio of the class in force.
    bench.piece(card_map::constant::kClassRapid);
    set(reg::kRatioRapid, 3);
    set(reg::kRatioFixed, 0x10000);
    bench.run(false, 300);
    bench.piece(card_map::constant::kClassFixed);
    set(reg::kRatioFixed, 0x8000);
    bench.run(false, 300);
    cycles += 600;
  }
  bench.expect_cycles(cycles);
}

// Each number of doublings in each clock of an update, up and down, starting from slews that allow all, some or none
// of them.
void slew_shifts() {
  Bench bench(0);
  std::uint64_t cycles = 1;
  for (const std::uint32_t slew : {0x3'0001U, 0x1FF'FFFFU, 0x200'0000U, 0x555'5555U, 0x800'0001U, 1U}) {
    bench.set(reg::kSlew, slew, false);
    ++cycles;
    for (unsigned clock = 0; clock < 8; ++clock) {
      for (const unsigned doublings : {0U, 3U, 1U, 2U, 0U, 2U, 3U, 0U, 1U, 3U}) {
        bench.shift_slew(doublings);
        bench.run(doublings % 2 == 1, 52 + clock);
        cycles += 52 + clock;
      }
    }
  }
  bench.expect_cycles(cycles);
}

void random_inputs() {
  Bench bench(seed_from_environment(1));
  Dice& dice = bench.dice();
  const std::uint64_t length = scaled(2'000'000);
  std::uint64_t cycles = 1;
  bool hold = false;
  constexpr std::uint32_t ratios[] = {reg::kRatioFeed, reg::kRatioRapid, reg::kRatioFixed};
  while (cycles < length) {
    ++cycles;
    if (dice.chance(4)) hold = !hold;
    if (dice.chance(3)) bench.shift_slew(dice.below(4));
    if (dice.chance(3)) bench.piece(static_cast<std::uint8_t>(dice.below(3)));
    const unsigned kind = dice.below(100);
    if (kind == 0)
      bench.reset();
    else if (kind < 50)
      bench.set(ratios[dice.below(3)], dice.chance(4) ? 0x10000 : static_cast<std::uint32_t>(dice.log_uniform(16)),
                hold);
    else if (kind < 80)
      bench.set(reg::kSlew, static_cast<std::uint32_t>(dice.log_uniform(28)), hold);
    else if (kind < 90)  // no setting, with random bus contents
      bench.clock(hold, {false, dice.chance(4) ? reg::kSlew : ratios[dice.below(3)], dice.draw()});
    else  // a setting of another block
      bench.clock(hold, {true, dice.chance(2) ? reg::kHold : reg::kHoldLimit, dice.draw()});
    // Mostly short, so that changes come in each of the four clocks of an update.
    const std::uint64_t clocks = dice.below(dice.chance(8) ? 5000 : 40);
    bench.run(hold, clocks);
    cycles += clocks;
  }
  bench.expect_cycles(cycles);
}

TEST(TimeBaseLockstep, DirectedAndRandom) {
  const std::string complaint = judge([] {
    directed();
    just_above_the_goal();
    classes();
    slew_shifts();
    random_inputs();
  });
  EXPECT_EQ(complaint, "");
}

}  // namespace
}  // namespace trammel::lockstep
