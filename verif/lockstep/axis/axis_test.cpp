// Lockstep of a whole axis: lines, counted lines, steps of an engine, settings during a pulse, cuts and resets at any
// clock, and its word of the snapshot; every output in every cycle.
#include "trammel/model/axis.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;
using model::load_target::count;
using model::load_target::increment;

constexpr unsigned kAxis = TRAMMEL_AXIS;
constexpr std::uint64_t kComparedSignals = 8;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("axis", seed), dice_(seed) { reset(); }

  // A line, counted or not, or a sequence of engine steps, with its own settings.
  void path() {
    if (dice_.chance(3)) settings();
    const bool engine = dice_.chance(4);
    const bool direct = !engine && dice_.chance(3);
    const std::int64_t top = std::int64_t{1} << (30 + dice_.below(11));
    // A power of two meets the half pulse exactly; there a line and its mirror image differ.
    const std::int64_t magnitude = dice_.chance(4) ? top : static_cast<std::int64_t>(dice_.word() >> 24) % (top + 1);
    send(increment(kAxis), static_cast<std::uint64_t>(dice_.chance(2) ? magnitude : -magnitude), 3);
    if (direct) send(count(kAxis), dice_.below(30), 2);
    in_.swap = true;
    in_.active = !engine;
    in_.direct = direct;
    clock();
    in_.swap = false;
    // The steps of the old line leave the generator before the engine's first one.
    for (int i = 0; i < 3; ++i) clock();
    if (!engine && !direct) chords(top);
    run(engine, 1 + dice_.below(20), 20 + dice_.below(500));
    if (model_.outputs().live) cut();
    if (dice_.chance(200)) reset();
  }

  Checker& check() { return check_; }
  std::uint64_t steps() const { return steps_; }
  std::uint64_t chained() const { return chained_; }

 private:
  // An arc: increments that come as chords, while ticks continue.
  void chords(std::int64_t top) {
    const unsigned every = 1 + dice_.below(4);
    for (unsigned left = dice_.below(6); left != 0; --left) {
      const auto increment = static_cast<std::int64_t>(dice_.word() >> 23) % (2 * top + 1) - top;
      check_.event("chord", static_cast<std::uint64_t>(increment));
      for (unsigned i = 0; i < 3; ++i) {
        in_.chord_load = true;
        in_.chord_word = static_cast<std::uint16_t>(static_cast<std::uint64_t>(increment) >> (16 * i));
        tick(every);
        in_.chord_load = false;
        // Words without a load, and words on the load bus for another axis, must have no effect.
        in_.chord_word = static_cast<std::uint16_t>(dice_.draw());
        in_.load = halfword(model::load_target::increment(other_axis()), dice_.word(), 0);
        if (dice_.chance(3)) tick(every);
      }
      for (unsigned clocks = 1 + dice_.below(20); clocks != 0; --clocks) tick(every);
      in_.chord_swap = true;
      tick(every);
      in_.chord_swap = false;
      for (int i = 0; i < 3; ++i) tick(every);
    }
    in_.load = {};
    in_.tick = false;
  }

  void tick(unsigned every) {
    in_.tick = dice_.chance(every);
    clock();
  }

  void run(bool engine, unsigned every, unsigned clocks) {
    for (unsigned i = 0; i < clocks; ++i) {
      in_.tick = !engine && dice_.chance(every);
      in_.engine_step = engine && dice_.chance(every);
      in_.engine_dir = dice_.chance(3);
      if (dice_.chance(in_.silent ? 20 : 200)) in_.silent = !in_.silent;
      if (dice_.chance(100)) settings();
      clock();
      if (dice_.chance(2000)) return cut();
    }
    in_.engine_step = in_.tick = in_.silent = false;
  }

  // Cuts, with random other inputs in this clock, including swaps.
  void cut() {
    check_.event("cut");
    in_.cut = true;
    in_.swap = dice_.chance(2);
    clock();
    in_ = {};
    for (int i = 0; i < 3; ++i) clock();
  }

  // One clock; the pins have the levels of the strap.
  void reset() {
    check_.event("reset");
    const unsigned idle_level = dice_.below(4);
    dut_->idle_level_i = static_cast<CData>(idle_level);
    dut_->rst_i = 1;
    apply();
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::Axis(kAxis, idle_level);
    snapshot_ = {};
    compare();
    in_ = {};
  }

  // One setting of this axis, of a neighbour, or of no axis.
  void settings() {
    const unsigned axis = dice_.chance(4) ? dice_.below(8) : kAxis;
    const unsigned times = 1U << dice_.below(5);
    const std::uint32_t addresses[] = {reg::step_length(axis), reg::step_space(axis), reg::dir_setup(axis),
                                       reg::dir_hold(axis),    reg::mode(axis),       reg::mode(axis) + 4};
    const unsigned which = dice_.below(6);
    in_.setting.set = true;
    in_.setting.address = addresses[which];
    in_.setting.data = which == 4 ? dice_.below(16) : dice_.below(times);
    check_.event("setting", in_.setting.address);
    clock();
    in_.setting = {};
  }

  unsigned other_axis() { return (kAxis + 1 + dice_.below(7)) % 8; }

  // The same chain of another axis, or a chain that no axis has.
  unsigned other_target(unsigned target) {
    if (dice_.chance(4)) return increment(kAxis) + 2 + dice_.below(14);
    return target - increment(kAxis) + increment(other_axis());
  }

  void send(unsigned target, std::uint64_t value, unsigned halfwords) {
    check_.event("load", value);
    for (unsigned i = 0; i < halfwords; ++i) {
      in_.load = halfword(target, value, i);
      clock();
      // Halfwords for another axis or chain must have no effect here.
      if (dice_.chance(3)) {
        in_.load = halfword(other_target(target), dice_.word(), 0);
        clock();
      }
    }
    // The path domain swaps at least three clocks after the last halfword; the RTL takes it one clock late.
    in_.load = {};
    clock();
  }

  void clock() {
    in_.wait_tick = dice_.chance(100);
    apply();
    const std::uint32_t position = model_.outputs().shaper.position;
    dut_.clock();
    model_.clock(in_);
    snapshot_.clock(dut_->snapshot_i, position);
    compare();
    steps_ += model_.outputs().path_step ? 1U : 0U;
  }

  void compare() {
    check_.next_cycle();
    const auto out = model_.outputs();
    check_.compare("path step", get(dut_->observe_o, bus::axis_observe::kStep), out.path_step);
    check_.compare("path dir", get(dut_->observe_o, bus::axis_observe::kDir), out.path_dir);
    check_.compare("live_o", dut_->live_o, out.live);
    check_.compare("step_o", dut_->step_o, out.shaper.step);
    check_.compare("dir_o", dut_->dir_o, out.shaper.dir);
    check_.compare("position", get(dut_->observe_o, bus::axis_observe::kPosition), out.shaper.position);
    check_.compare("busy_o", dut_->busy_o, out.shaper.busy);
    check_.compare("fault_o", dut_->fault_o, out.shaper.fault);
    if (!snapshot_.known()) return;
    check_.compare("snapshot_o, word", get(dut_->snapshot_o, bus::snapshot::kWord), snapshot_.word());
    ++chained_;
  }

  void apply() {
    dut_->cut_i = in_.cut;
    dut_->tick_i = in_.tick;
    dut_->swap_i = in_.swap;
    dut_->active_i = in_.active;
    dut_->direct_i = in_.direct;
    dut_->chord_word_i = in_.chord_word;
    dut_->chord_load_i = in_.chord_load;
    dut_->chord_swap_i = in_.chord_swap;
    dut_->silent_i = in_.silent;
    dut_->engine_step_i = in_.engine_step;
    dut_->engine_dir_i = in_.engine_dir;
    dut_->wait_tick_i = in_.wait_tick;
    dut_->load_i = load_wire(in_.load);
    dut_->setting_i = wire(in_.setting);
    dut_->snapshot_i = dice_.snapshot();
  }

  Simulated<Vdut> dut_;
  model::Axis model_{kAxis};
  model::Axis::Inputs in_;
  SnapshotWord snapshot_;
  Checker check_;
  Dice dice_;
  std::uint64_t steps_ = 0;
  std::uint64_t chained_ = 0;
};

void random_paths() {
  Bench bench(seed_from_environment(20260703));
  const std::uint64_t length = scaled(400'000);
  while (bench.check().cycles() < length) bench.path();
  EXPECT_EQ(bench.check().comparisons(), bench.check().cycles() * kComparedSignals + bench.chained());
  EXPECT_GT(bench.chained(), bench.check().cycles() / 2);
  EXPECT_GT(bench.steps(), 10'000U);
}

TEST(Axis, RandomPaths) { EXPECT_EQ(judge(random_paths), ""); }

}  // namespace
}  // namespace trammel::lockstep
