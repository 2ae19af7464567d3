// Lockstep of the emergency stop's pin: presses, releases and clears in every order of eight clocks, random ones,
// both levels; every output in every cycle. Here a press acts with the clock; card_pins_test.cpp presses between two
// edges.
#include "trammel/model/emergency_stop.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

constexpr std::uint64_t kComparedSignals = 2;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("emergency_stop", seed) {}

  // One clock of reset, with this level at the pin.
  void reset(bool level, bool pin) {
    check_.event("reset, level that stops", level);
    level_ = level;
    model_ = model::EmergencyStop(level);
    dut_->rst_i = 1;
    apply({pin, false});
    dut_.clock();
    dut_->rst_i = 0;
    model_.reset(pin);
    compare(false);
  }

  // One clock; `pressed`: the pin is at its stop level, `clear`: a clear comes.
  void clock(bool pressed, bool clear) {
    if (pressed) check_.event("pressed");
    if (clear) check_.event("clear");
    const model::EmergencyStop::Inputs in{pressed == level_, clear};
    apply(in);
    dut_.clock();
    model_.clock(in);
    compare(clear);
  }

  const model::EmergencyStop& model() const { return model_; }
  Checker& check() { return check_; }

 private:
  void apply(const model::EmergencyStop::Inputs& in) {
    dut_->level_i = level_;
    dut_->pin_i = in.pin;
    dut_->clear_i = in.clear;
  }
  void compare(bool clear) {
    check_.next_cycle();
    check_.compare("latched_o", dut_->latched_o, model_.latched());
    check_.compare("stop_o", dut_->stop_o, model_.stops(clear));
  }

  Simulated<Vdut> dut_;
  model::EmergencyStop model_;
  Checker check_;
  bool level_ = true;
};

void every_order() {
  Bench bench(0);
  std::uint64_t cleared = 0;
  constexpr unsigned kClocks = 8;
  for (const bool level : {false, true}) {
    for (unsigned order = 0; order < 1U << 2 * kClocks; ++order) {
      bench.reset(level, !level);
      bool stopped = false;
      for (unsigned clock = 0; clock < kClocks; ++clock) {
        bench.clock((order >> 2 * clock & 1) != 0, (order >> 2 * clock & 2) != 0);
        cleared += stopped && !bench.model().stops(false) ? 1U : 0U;
        stopped = bench.model().stops(false);
      }
    }
  }
  EXPECT_GT(cleared, 1000U);
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * bench.check().cycles());
  EXPECT_EQ(bench.check().cycles(), 2U * (1U << 2 * kClocks) * (kClocks + 1));
}

void random_presses() {
  const std::uint64_t seed = seed_from_environment(37);
  Bench bench(seed);
  Dice dice(seed);
  bench.reset(true, false);
  const std::uint64_t length = scaled(300'000);
  bool pressed = false;
  for (std::uint64_t i = 0; i < length; ++i) {
    if (dice.chance(pressed ? 3 : 20)) pressed = !pressed;
    if (dice.chance(300))
      bench.reset(dice.chance(2), dice.chance(2));
    else
      bench.clock(pressed, dice.chance(6));
  }
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * (length + 1));
}

TEST(EmergencyStop, EveryOrder) { EXPECT_EQ(judge(every_order), ""); }
TEST(EmergencyStop, RandomPresses) { EXPECT_EQ(judge(random_presses), ""); }

}  // namespace
}  // namespace trammel::lockstep
