// Lockstep of the arc generator with the axes that make its steps: arcs of every shift and chord length, ticks at
// full speed or with gaps, starts directly after the load, ends and clears at any clock. Every output in every cycle;
// and every step at its tick, by the rule of the increments alone.
#include "trammel/model/arc_generator.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include "trammel/model/axis.hpp"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

namespace load_target = model::load_target;

constexpr unsigned kAxes = 3;
constexpr unsigned kStepDelay = 5;  // clocks from the generator's tick to path_step
constexpr std::int64_t kOne = std::int64_t{1} << 40;

struct Arc {
  model::ChordRotation::State state;
  std::array<std::int64_t, kAxes> first{};  // first increment; of an axis outside the plane: its only one
  unsigned axis_x = 0;
  unsigned axis_y = 1;
  bool active = true;
};

// The increment at each path tick by the rule: first the loaded one, then chords, which end at odd halves for y and
// at even halves for x.
class Rule {
 public:
  explicit Rule(const Arc& arc) : arc_(arc), rotation_{arc.state} {
    // The two first chords are made in sequence, y's first.
    increment_[1] = rotation_.chord_y();
    increment_[0] = rotation_.chord_x();
  }

  // The steps of the axes at the next path tick: bit n is a step of axis n, bit n + 8 its direction.
  unsigned tick() {
    ++tick_;
    unsigned steps = 0;
    for (unsigned n = 0; n < kAxes; ++n) {
      const std::int64_t by = tick_ == 1         ? arc_.first[n]
                              : n == arc_.axis_x ? increment_[0]
                              : n == arc_.axis_y ? increment_[1]
                                                 : arc_.first[n];
      phase_[n] += by;
      if (phase_[n] >= kOne) steps |= 1U << n;
      if (phase_[n] < 0) steps |= 0x101U << n;
      phase_[n] &= kOne - 1;
    }
    const std::uint64_t half = std::uint64_t{1} << arc_.state.m >> 1;
    if (arc_.state.m >= 5 && tick_ % half == 0) {
      if (tick_ / half % 2 != 0)
        increment_[1] = rotation_.chord_y();
      else
        increment_[0] = rotation_.chord_x();
    }
    return arc_.active ? steps : 0;
  }

 private:
  Arc arc_;
  model::ChordRotation rotation_;
  std::array<std::int64_t, 2> increment_{};
  std::array<std::int64_t, kAxes> phase_{kOne / 2, kOne / 2, kOne / 2};
  std::uint64_t tick_ = 0;
};

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("arc_generator", seed), dice_(seed) { reset(); }

  // Loads an arc, starts it at once or later, and runs `ticks` path ticks of it; a clear may end it earlier.
  void run(const Arc& arc, std::uint64_t ticks, unsigned every, unsigned clear_in) {
    load(arc);
    check_.event("start", arc.state.k | arc.state.m << 8);
    Rule rule(arc);
    step_ = 0;
    in_.start = true;
    clock();
    in_.start = false;
    std::uint64_t stalls = 0;
    bool one_before = dice_.chance(2);  // one tick may be taken before ready falls
    for (std::uint64_t made = 0, clocks = 0; made < ticks; ++clocks) {
      // A tick allowed by ready arrives four clocks later.
      const bool granted = ready_ & 0x10;
      if ((clear_in != 0 && dice_.chance(clear_in)) || end_after_-- == 0) return end();
      const bool before = one_before && clocks >= 3 && clocks < 12 && dice_.chance(3);
      const bool paused = made == 10 && pause_ != 0;
      if (paused) --pause_;
      in_.tick = before || (granted && clocks > 4 && !paused && (every <= 1 || dice_.chance(every)));
      in_.swap = clocks == 2;
      in_.active = arc.active;
      if (before) one_before = false;
      if (in_.tick) {
        ++made;
        step_ = rule.tick();
        ++ticks_;
      } else if (clocks > 24 && every <= 1 && !paused) {
        ++stalls;
      }
      clock();
      step_ = 0;
    }
    in_.tick = in_.swap = false;
    EXPECT_EQ(stalls, 0U);
    for (unsigned i = dice_.below(30); i != 0; --i) clock();
    end();
  }

  void reset() {
    check_.event("reset");
    dut_->rst_i = 1;
    in_ = {};
    apply();
    dut_.clock();
    dut_->rst_i = 0;
    generator_ = {};
    for (unsigned n = 0; n < kAxes; ++n) axes_[n] = model::Axis(n);
    forget();
    compare();
  }

  Checker& check() { return check_; }
  Dice& dice() { return dice_; }
  // The next arc ends this many clocks after its start; sometimes by a reset instead.
  void end_after(unsigned clocks) { end_after_ = clocks; }
  // The next arc gets no tick for this many clocks after its tenth tick.
  void pause(unsigned clocks) { pause_ = clocks; }
  std::uint64_t steps() const { return steps_; }
  std::uint64_t ticks() const { return ticks_; }

 private:
  struct Inputs {
    bool clear = false, start = false, tick = false, swap = false, active = false;
    model::LoadWord load;
  };

  void load(const Arc& arc) {
    const unsigned plane = (arc.state.clockwise ? 1U : 0U) | arc.axis_x << 4 | arc.axis_y << 8;
    send(load_target::kChordPlane, plane, 1);
    // Random values in the unused bits.
    send(load_target::kChordShifts, arc.state.k | arc.state.m << 8 | (dice_.draw() & 0xE0E0), 1);
    send(load_target::kChordState, static_cast<std::uint64_t>(arc.state.x), 4);
    send(load_target::kChordState, static_cast<std::uint64_t>(arc.state.y), 4);
    for (unsigned n = 0; n < kAxes; ++n) send(load_target::increment(n), static_cast<std::uint64_t>(arc.first[n]), 3);
    send(load_target::kChordClosing, static_cast<std::uint64_t>(arc.state.closing_x), 3);
    send(load_target::kChordClosing, static_cast<std::uint64_t>(arc.state.closing_y), 3);
    for (unsigned i = dice_.chance(2) ? dice_.below(20) : 0; i != 0; --i) clock();
  }

  void send(unsigned target, std::uint64_t value, unsigned halfwords) {
    for (unsigned i = 0; i < halfwords; ++i) {
      in_.load = halfword(target, value, i);
      clock();
      in_.load = {};
      if (dice_.chance(8)) {  // for another block, or for none
        const std::array<std::uint16_t, 3> others{load_target::kTicks, load_target::kPrescale, load_target::kCommand};
        in_.load = {dice_.chance(2), others[dice_.below(3)], static_cast<std::uint16_t>(dice_.draw())};
        clock();
        in_.load = {};
      }
    }
  }

  // The arc ends, in any clock; the next load may follow at once.
  void end() {
    const bool reset_instead = dice_.chance(40);
    check_.event("end");
    if (reset_instead) return reset();
    in_.swap = false;
    in_.clear = true;
    in_.tick = dice_.chance(2);
    in_.start = dice_.chance(8);
    clock();
    in_ = {};
    end_after_ = UINT64_MAX;
    forget();
  }

  void forget() {
    expected_.fill(0);
    tick_late_ = false;
    ready_ = 0;
  }

  void clock() {
    apply();
    dut_.clock();
    const auto out = generator_.outputs();
    for (unsigned n = 0; n < kAxes; ++n) {
      model::Axis::Inputs in;
      in.cut = in_.clear;
      in.tick = tick_late_;
      in.swap = in_.swap;
      in.active = in_.active;
      in.load = in_.load;
      in.chord_load = (out.load >> n & 1) != 0;
      in.chord_swap = (out.swap >> n & 1) != 0;
      in.chord_word = out.word;
      axes_[n].clock(in);
    }
    generator_.clock({in_.clear, in_.load, in_.start, in_.tick});
    tick_late_ = in_.tick && !in_.clear;
    std::rotate(expected_.begin(), expected_.begin() + 1, expected_.end());
    expected_.back() = step_;
    if (in_.clear) forget();
    ready_ = ready_ << 1 | (generator_.outputs().ready ? 1U : 0U);
    compare();
  }

  void compare() {
    check_.next_cycle();
    const auto& out = generator_.outputs();
    const unsigned mask = (1U << kAxes) - 1;
    check_.compare("chord_load_o", dut_->chord_load_o, out.load & mask);
    check_.compare("chord_swap_o", dut_->chord_swap_o, out.swap & mask);
    check_.compare("ready_o", dut_->ready_o, out.ready);
    check_.compare("loadable_o", dut_->loadable_o, out.loadable);
    check_.compare("chord_word_o", out.load != 0 ? dut_->chord_word_o : 0, out.load != 0 ? out.word : 0);
    unsigned step = 0;
    unsigned dir = 0;
    for (unsigned n = 0; n < kAxes; ++n) {
      step |= (axes_[n].outputs().path_step ? 1U : 0U) << n;
      dir |= (axes_[n].outputs().path_dir ? 1U : 0U) << n;
    }
    check_.compare("path_step_o", dut_->path_step_o, step);
    check_.compare("path_dir_o", dut_->path_dir_o, dir);
    // A step that is on its way to the shaper at a clear is still made.
    const unsigned made = step | (dir & step) << 8;
    check_.compare("steps by the rule", made, in_.clear ? made : expected_.front());
    steps_ += step != 0 ? 1U : 0U;
  }

  void apply() {
    dut_->clear_i = in_.clear;
    dut_->load_i = load_wire(in_.load);
    dut_->start_i = in_.start;
    dut_->tick_i = in_.tick;
    dut_->swap_i = in_.swap;
    dut_->line_tick_i = 0;
    dut_->active_i = in_.active ? (1U << kAxes) - 1 : 0;
  }

  Simulated<Vdut> dut_;
  model::ArcGenerator generator_;
  std::array<model::Axis, kAxes> axes_{model::Axis(0), model::Axis(1), model::Axis(2)};
  Inputs in_;
  bool tick_late_ = false;
  unsigned step_ = 0;  // the rule's steps for the tick in this clock
  std::array<unsigned, kStepDelay> expected_{};
  std::uint64_t end_after_ = UINT64_MAX;
  unsigned pause_ = 0;
  std::uint32_t ready_ = 0;  // ready in the last clocks, bit 0 is the latest
  Checker check_;
  Dice dice_;
  std::uint64_t steps_ = 0;
  std::uint64_t ticks_ = 0;
};

std::int64_t up_to(Dice& dice, std::int64_t limit) {
  const auto bound = static_cast<std::uint64_t>(limit) + 1;
  const auto magnitude = static_cast<std::int64_t>(dice.word() % bound);
  return dice.chance(2) ? -magnitude : magnitude;
}

// A circle whose chords are at most half a pulse per tick, so that even with closing increments no axis makes more
// than one.
Arc circle(Dice& dice, unsigned k, unsigned m) {
  Arc arc;
  arc.state.k = static_cast<std::uint8_t>(k);
  arc.state.m = static_cast<std::uint8_t>(m);
  arc.state.clockwise = dice.chance(2);
  // X and Y stay near the radius of the circle: 2^(38 + k), but at most 2^62.
  const unsigned bits = std::min(38 + k, 62U) - (dice.chance(3) ? dice.below(30) : 0);
  const double radius = std::ldexp(1 + static_cast<double>(dice.below(1000)) / 1001, static_cast<int>(bits) - 1);
  const double angle = static_cast<double>(dice.draw()) * 0x1p-32 * 2 * 3.14159265358979;
  arc.state.x = static_cast<std::int64_t>(std::llround(radius * std::cos(angle)));
  arc.state.y = static_cast<std::int64_t>(std::llround(radius * std::sin(angle)));
  arc.state.closing_x = up_to(dice, kOne / 8) >> dice.below(41);
  arc.state.closing_y = up_to(dice, kOne / 8) >> dice.below(41);
  for (auto& first : arc.first) first = up_to(dice, kOne);
  arc.axis_x = dice.below(kAxes);
  arc.axis_y = (arc.axis_x + 1 + dice.below(kAxes - 1)) % kAxes;
  return arc;
}

// Not a curve: every bit is in use. The axes are not active, because too large increments would break their rule.
Arc noise(Dice& dice) {
  Arc arc = circle(dice, dice.below(32), 5 + dice.below(3));
  arc.state.x = static_cast<std::int64_t>(dice.word()) >> dice.below(63);
  arc.state.y = static_cast<std::int64_t>(dice.word()) >> dice.below(63);
  arc.state.closing_x = static_cast<std::int64_t>(dice.word()) >> 16;
  arc.state.closing_y = static_cast<std::int64_t>(dice.word()) >> 16;
  arc.active = false;
  return arc;
}

void random_arcs() {
  Bench bench(seed_from_environment(20261122));
  Dice& dice = bench.dice();
  const std::uint64_t length = scaled(10'000'000);
  while (bench.check().cycles() < length) {
    const bool is_noise = dice.chance(4);
    const unsigned m = dice.chance(2) ? 5 : dice.chance(8) ? dice.below(32) : 5 + dice.below(6);
    const Arc arc = is_noise ? noise(dice) : circle(dice, 1 + dice.below(31), m);
    const std::uint64_t chord = std::uint64_t{1} << std::min<unsigned>(arc.state.m, 10);
    bench.run(arc, 1 + dice.word() % (chord * (1 + dice.below(12))), dice.chance(2) ? 1 : 1 + dice.below(20),
              dice.chance(3) ? 1 + dice.below(100) : 0);
  }
  EXPECT_GE(bench.check().cycles(), length);
  EXPECT_EQ(bench.check().comparisons(), bench.check().cycles() * 8);
  EXPECT_GT(bench.steps(), bench.check().cycles() / 20);
  std::cout << bench.check().cycles() << " cycles of arcs compared, " << bench.steps() << " with steps\n";
}

// One arc with a path tick in every clock and the shortest chords, for thousands of chords: no stall after the start.
void every_clock() {
  Bench bench(seed_from_environment(20261123));
  for (const unsigned k : {1U, 5U, 15U, 16U, 27U}) bench.run(circle(bench.dice(), k, 5), 40'000, 1, 0);
  EXPECT_EQ(bench.check().comparisons(), bench.check().cycles() * 8);
  EXPECT_EQ(bench.ticks(), 200'000U);
}

// An arc ends in any clock after its start, and the next one is loaded from the following clock on.
void ends_at_every_clock() {
  Bench bench(seed_from_environment(20261125));
  for (unsigned clocks = 0; clocks < 120; ++clocks)
    for (const unsigned k : {3U, 20U})
      for (const unsigned every : {1U, 1U, 3U}) {
        bench.end_after(clocks);
        Arc arc = circle(bench.dice(), k, 5);
        // A chain of ones, with a carry after it, must not disturb the next load.
        if (clocks % 2 != 0) arc.state.x = -1;
        bench.run(arc, 1000, every, 0);
        bench.run(circle(bench.dice(), k, 5), 50, 1, 0);
      }
  EXPECT_EQ(bench.check().comparisons(), bench.check().cycles() * 8);
}

// The first swap of a half chord comes in each clock of the computation of the next ones.
void pauses() {
  Bench bench(seed_from_environment(20261126));
  for (unsigned clocks = 0; clocks < 60; ++clocks)
    for (const unsigned k : {3U, 20U}) {
      bench.pause(clocks);
      bench.run(circle(bench.dice(), k, 5), 100, 1, 0);
    }
  EXPECT_EQ(bench.check().comparisons(), bench.check().cycles() * 8);
}

// Chords so long that the upper bits of the tick count matter: three halves of each.
void long_chords() {
  Bench bench(seed_from_environment(20261124));
  for (unsigned m = 11; m <= 20; ++m) {
    const std::uint64_t ticks = (std::uint64_t{3} << m >> 1) + 40;
    bench.run(circle(bench.dice(), 1 + m, m), ticks, 1, 0);
  }
  EXPECT_EQ(bench.check().comparisons(), bench.check().cycles() * 8);
}

// If m is below 5 no half chord ever ends: both axes keep their first chords.
void no_half_ends() {
  Bench bench(seed_from_environment(20261127));
  for (unsigned m = 0; m < 5; ++m)
    for (const unsigned k : {3U, 20U}) bench.run(circle(bench.dice(), k, m), 200, 1, 0);
  EXPECT_EQ(bench.check().comparisons(), bench.check().cycles() * 8);
  EXPECT_EQ(bench.ticks(), 2'000U);
}

TEST(ArcGenerator, RandomArcs) { EXPECT_EQ(judge(random_arcs), ""); }
TEST(ArcGenerator, ATickEveryClock) { EXPECT_EQ(judge(every_clock), ""); }
TEST(ArcGenerator, EndsAtEveryClock) { EXPECT_EQ(judge(ends_at_every_clock), ""); }
TEST(ArcGenerator, Pauses) { EXPECT_EQ(judge(pauses), ""); }
TEST(ArcGenerator, NoHalfEnds) { EXPECT_EQ(judge(no_half_ends), ""); }
TEST(ArcGenerator, LongChords) { EXPECT_EQ(judge(long_chords), ""); }

}  // namespace
}  // namespace trammel::lockstep
