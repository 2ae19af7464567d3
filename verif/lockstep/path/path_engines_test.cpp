// Lockstep of the path engines: arcs on either engine and lines in sequence, random ticks, the state of the next arc
// loaded while a line runs, cuts and resets at any clock; every output in every cycle.
#include "trammel/model/path_engines.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "deviation_paths.hpp"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

namespace load_target = model::load_target;

constexpr std::uint8_t kLines = card_map::engine::kLines;
constexpr std::uint8_t kAccumulator = card_map::engine::kAccumulator;
constexpr std::uint8_t kArcGenerator = card_map::engine::kArcGenerator;
constexpr bool kEngines = TRAMMEL_ENGINES != 0;  // engines other than lines are built in
constexpr unsigned kAxes = 4;
constexpr std::uint64_t kOnePulse = std::uint64_t{1} << 40;
constexpr std::uint64_t kComparedSignals = kEngines ? 13 : 15;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("path_engines", seed), dice_(seed), random_(seed) { reset(); }

  void arc() {
    // Mostly a path tick every few feed ticks.
    const std::uint64_t prescale = dice_.word() >> 23 >> (dice_.chance(4) ? dice_.below(40) : dice_.below(4));
    if (!load(load_target::kPrescale, prescale % (kOnePulse + 1), 3)) return;
    if (!wait([this] { return engine_free() && model_.outputs().payload_ready; }, 20'000)) return;
    // A halfword requested now arrives three clocks later.
    if (!idle(2) || !load_path(any_path(random_, true))) return;
    if (finish_path()) begin(kAccumulator);
  }

  void chords() {
    const std::uint64_t prescale = dice_.chance(2) ? kOnePulse : dice_.word() >> 23 >> dice_.below(4);
    if (!load(load_target::kPrescale, prescale % (kOnePulse + 1), 3)) return;
    if (!wait([this] { return engine_free() && model_.outputs().payload_ready; }, 20'000)) return;
    if (!idle(2) || !load_chords()) return;
    if (finish_path()) begin(kArcGenerator);
  }

  void line() {
    if (finish_path()) begin(kLines);
  }

  Checker& check() { return check_; }
  std::uint64_t steps() const { return steps_; }
  std::uint64_t chords_swapped() const { return chords_; }
  std::uint64_t expected() const { return kComparedSignals * check_.cycles() + judged_; }

 private:
  // True if all ticks of an arc were given, the last one at least two clocks ago.
  bool engine_free() const { return !on_arc_ || (ticks_left_ == 0 && since_tick_ >= 2); }

  // Waits until the ticks of the path are given, and until an arc's are finished.
  bool finish_path() {
    if (!wait([this] { return ticks_left_ == 0; }, 20'000)) return false;
    return !on_arc_ || wait([this] { return since_tick_ >= 2 && model_.outputs().done; }, 2000);
  }

  // A line's swap may come with the last tick of the previous line. Swaps are at least 3 clocks apart.
  void begin(std::uint8_t engine) {
    if (!idle(since_swap_ < 3 ? 3 - since_swap_ : 0)) return;
    check_.event("swap", engine);
    in_.swap = true;
    in_.engine = engine;
    in_.tick = on_line_ && since_swap_ > 3 && model_.outputs().ready && dice_.chance(2);
    clock();
    in_.swap = false;
    in_.engine = kLines;
    on_arc_ = engine != kLines;
    on_line_ = !on_arc_;
    since_swap_ = 0;
    ticks_left_ = dice_.chance(4) ? dice_.below(3) : dice_.below(300);
    tick_every_ = 1 + dice_.below(dice_.chance(2) ? 2 : 20);
    idle(3);
  }

  bool load(unsigned target, std::uint64_t value, unsigned halfwords) {
    bool good = true;
    for (unsigned i = 0; i < halfwords && good; ++i) {
      in_.load = halfword(target, value, i);
      good = idle(1);
      in_.load = {};
      while (good && dice_.chance(5)) good = idle(1);
    }
    return good;
  }

  bool load_chords() {
    const unsigned x = dice_.below(kAxes);
    const unsigned y = (x + 1 + dice_.below(kAxes - 1)) % kAxes;
    bool good = load(load_target::kChordPlane, y << 8 | x << 4 | dice_.below(2), 1) &&
                load(load_target::kChordShifts, (5 + dice_.below(4)) << 8 | dice_.below(32), 1);
    for (unsigned i = 0; i < 2 && good; ++i) good = load(load_target::kChordState, dice_.word(), 4);
    for (unsigned i = 0; i < 2 && good; ++i) good = load(load_target::kChordClosing, dice_.word(), 3);
    return good;
  }

  bool load_path(const Path& path) {
    const std::array<int128, 9> values = chains(path);
    const unsigned x = dice_.below(kAxes);
    const unsigned y = (x + 1 + dice_.below(kAxes - 1)) % kAxes;
    bool good = true;
    for (unsigned chain = 0; chain < 8; ++chain) {
      for (unsigned i = 0; i < kChainHalfwords[chain] && good; ++i)
        good = load(load_target::kDeviation + chain, static_cast<std::uint64_t>(values[chain] >> (16 * i)), 1);
    }
    return good && load(load_target::kPlane, y << 8 | x << 4 | rule_bits(path), 1);
  }

  // False if a cut or a reset came in between.
  template <class Condition>
  bool wait(Condition condition, unsigned limit) {
    for (unsigned i = 0; i < limit; ++i) {
      if (condition()) return true;
      if (!idle(1)) return false;
    }
    cut();
    return false;
  }

  bool idle(std::uint64_t clocks) {
    for (std::uint64_t i = 0; i < clocks; ++i) {
      in_.tick = ticks_left_ != 0 && since_swap_ > 0 && model_.outputs().ready && dice_.chance(tick_every_);
      const bool tick = in_.tick;
      clock();
      if (tick) --ticks_left_;
      if (dice_.chance(cut_every_)) {
        cut();
        return false;
      }
    }
    return true;
  }

  // A cut with random other inputs; one in four is a reset of one clock instead. Another one may follow.
  void cut() {
    cut_every_ = 20 + dice_.below(dice_.chance(2) ? 300 : 8000);
    do {
      in_.tick = dice_.chance(2);
      in_.swap = dice_.chance(2);
      in_.engine = !kEngines || dice_.chance(2) ? kLines : dice_.chance(2) ? kAccumulator : kArcGenerator;
      if (dice_.chance(4)) {
        reset();
      } else {
        check_.event("cut");
        in_.cut = true;
        clock();
      }
      in_ = {};
    } while (dice_.chance(2));
    on_arc_ = on_line_ = false;
    ticks_left_ = 0;
    for (unsigned i = dice_.below(4); i != 0; --i) clock();
    since_swap_ = 3;
  }

  void reset() {
    check_.event("reset");
    dut_->rst_i = 1;
    apply();
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::PathEngines();
    compare();
  }

  void clock() {
    // The sequencer knows of the last tick two clocks after it was taken, which is one clock after it is here.
    in_.engine_taken = on_arc_ && !engine_free();
    apply();
    dut_.clock();
    model_.clock(in_);
    compare();
    since_tick_ = in_.tick ? 0 : since_tick_ + 1;
    ++since_swap_;
    steps_ += model_.outputs().step != 0 ? 1U : 0U;
  }

  void apply() {
    dut_->cut_i = in_.cut;
    dut_->tick_i = in_.tick;
    using namespace bus::move;
    dut_->move_i = static_cast<SData>(in_place(kSwap, in_.swap) | in_place(kEngine, in_.engine) |
                                      in_place(kTaking, in_.engine_taken) | in_place(bus::move::kAxes, dice_.draw()));
    // Without its valid bit the bus has no meaning.
    dut_->load_i = in_.load.valid ? load_wire(in_.load) : dice_.below(1U << bus::load_bus::kValid.offset);
  }

  void compare() {
    check_.next_cycle();
    const auto& out = model_.outputs();
    const auto drive = [this](const bus::Field& field) { return get(dut_->drive_o, field); };
    using namespace bus::axis_drive;
    check_.compare("tick", drive(kTick), out.tick);
    check_.compare("swap", drive(kSwap), out.swap);
    check_.compare("path_tick_o", dut_->path_tick_o, out.path_tick);
    check_.compare("step", drive(kStep), out.step);
    check_.compare("dir, of steps", drive(kDir) & drive(kStep), out.dir & out.step);
    check_.compare("ready_o", dut_->ready_o, out.ready);
    check_.compare("payload_ready_o", dut_->payload_ready_o, out.payload_ready);
    check_.compare("quiet_o", dut_->quiet_o, kEngines ? model_.quiet() : true);
    check_.compare("shadows_free_o", dut_->shadows_free_o, out.shadows_free);
    check_.compare("chord_load", drive(kChordLoad), out.chord_load & ((1U << kAxes) - 1));
    check_.compare("chord_swap", drive(kChordSwap), out.chord_swap & ((1U << kAxes) - 1));
    check_.compare("chord_word, of loads", out.chord_load != 0 ? drive(kChordWord) : 0,
                   out.chord_load != 0 ? out.chord_word : 0);
    chords_ += out.chord_swap != 0 ? 1U : 0U;
    if (!kEngines) {
      check_.compare("done_o", dut_->done_o, 1);
      check_.compare("missed_end_o", dut_->missed_end_o, 0);
      check_.compare("dir", drive(kDir), 0);
      return;
    }
    // Both outputs are used while an arc runs.
    check_.compare("done_o", dut_->done_o, out.done);
    if (!on_arc_ || !out.done) return;
    check_.compare("missed_end_o", dut_->missed_end_o, out.missed_end);
    ++judged_;
  }

  Simulated<Vdut> dut_;
  model::PathEngines model_;
  model::PathEngines::Inputs in_;
  Checker check_;
  Dice dice_;
  Random random_;
  bool on_arc_ = false;
  bool on_line_ = false;
  std::uint32_t ticks_left_ = 0;
  std::uint32_t tick_every_ = 1;
  std::uint32_t cut_every_ = 2000;
  std::uint64_t since_tick_ = 10;  // clocks
  std::uint64_t since_swap_ = 10;
  std::uint64_t judged_ = 0;
  std::uint64_t steps_ = 0;
  std::uint64_t chords_ = 0;
};

void random_paths() {
  const std::uint64_t seed = seed_from_environment(20261117);
  Bench bench(seed);
  Dice dice(seed);
  const std::uint64_t length = scaled(2'400'000);
  while (bench.check().cycles() < length) {
    if (!kEngines || dice.chance(3))
      bench.line();
    else if (dice.chance(2))
      bench.chords();
    else
      bench.arc();
  }
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
  EXPECT_GE(bench.steps(), kEngines ? length / 1000 : 0);
  EXPECT_GE(bench.chords_swapped(), kEngines ? length / 4000 : 0);
}

TEST(PathEngines, RandomPaths) { EXPECT_EQ(judge(random_paths), ""); }

}  // namespace
}  // namespace trammel::lockstep
