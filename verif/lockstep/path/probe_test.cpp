// Lockstep of the probe: every combination of two clocks of inputs from each of its states, and random ones; every
// output in every cycle.
#include "trammel/model/probe.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

constexpr std::uint64_t kComparedSignals = 10;
constexpr bool kFirstTouch = TRAMMEL_FIRST_TOUCH != 0;

class Bench {
 public:
  using Inputs = model::Probe::Inputs;

  explicit Bench(std::uint64_t seed) : check_("probe", seed) { reset({}); }

  // One clock of reset, with random inputs except those of the decoder, which is reset too. The conditions have no
  // reset: a command loads them, here the first one.
  void reset(Inputs in) {
    check_.event("reset");
    in.load = {true, model::load_target::kCommand, 0};
    in.waits = false;
    dut_->rst_i = 1;
    apply(in);
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::Probe(kFirstTouch);
    compare(in);
  }

  void clock(const Inputs& in) {
    apply(in);
    edges_ += model_.trips(in) ? 1U : 0U;
    touches_ += model_.touches(in) ? 1U : 0U;
    dut_.clock();
    model_.clock(in);
    compare(in);
  }

  // Takes a PROBE for input 0 at level 1, with that input at `level`.
  void arm(bool level) {
    Inputs in;
    in.levels = level ? 1 : 0;
    in.load = {true, model::load_target::kCommand, 0x20};
    clock(in);
    in.load = {};
    in.waits = true;
    for (unsigned i = 0; i < model::Probe::kSettle; ++i) clock(in);
  }

  const model::Probe& model() const { return model_; }
  Checker& check() { return check_; }
  std::uint64_t edges() const { return edges_; }
  std::uint64_t touches() const { return touches_; }

 private:
  void apply(const Inputs& in) {
    dut_->cut_i = in.cut;
    dut_->level_i = in.levels;
    dut_->raw_i = in.raw;
    dut_->quiet_i = in.quiet;
    dut_->load_i = load_wire(in.load);
    dut_->waits_i = in.waits;
    dut_->ends_i = in.ends;
    dut_->at_rest_i = in.at_rest;
    dut_->stopping_i = in.stopping;
    dut_->clear_i = in.clear;
  }

  void compare(const Inputs& in) {
    check_.next_cycle();
    check_.compare("met_o", dut_->met_o, model_.met(in.levels));
    check_.compare("taken_o", dut_->taken_o, model_.takes(in));
    check_.compare("stays_o", dut_->stays_o, model_.stays(in));
    check_.compare("snapshot_o", dut_->snapshot_o, model_.asks(in));
    check_.compare("hold_o", dut_->hold_o, model_.holds());
    check_.compare("halt_o", dut_->halt_o, model_.halt());
    check_.compare("drop_o", dut_->drop_o, model_.drops());
    check_.compare("busy_o", dut_->busy_o, model_.busy());
    check_.compare("probed", dut_->probed_o, model_.probed());
    check_.compare("missed", dut_->missed_o, model_.missed());
  }

  Simulated<Vdut> dut_;
  model::Probe model_{kFirstTouch};
  Checker check_;
  std::uint64_t edges_ = 0;
  std::uint64_t touches_ = 0;
};

// The inputs of a clock, by bits. The raw level differs if `waits` is high; the input is quiet at rest.
Bench::Inputs inputs_of(unsigned bits) {
  Bench::Inputs in;
  in.levels = bits & 1;
  in.raw = in.levels ^ (bits >> 1 & 1);
  in.quiet = bits >> 3 & 1;
  in.waits = (bits & 2) != 0;
  in.ends = (bits & 4) != 0 && !in.waits;  // the decoded command is either a PROBE or a PROBE_END
  in.at_rest = (bits & 8) != 0;
  in.stopping = (bits & 16) != 0;
  in.clear = (bits & 32) != 0;
  in.cut = (bits & 64) != 0;
  return in;
}

// From each state, every combination of two successive clocks.
void every_two_clocks() {
  Bench bench(0);
  std::uint64_t cycles = 1;
  for (unsigned state = 0; state < 5; ++state) {
    for (unsigned course = 0; course < 1U << 14; ++course) {
      bench.reset({});
      if (state != 0) bench.arm(state == 4);                    // armed; or already tripped
      if (state == 2 || state == 3) bench.clock(inputs_of(1));  // the edge
      if (state == 3) bench.clock(inputs_of(8));                // at rest
      bench.clock(inputs_of(course & 0x7F));
      bench.clock(inputs_of(course >> 7));
      bench.clock({});
      cycles += 4 + (state == 0 ? 0 : 1 + model::Probe::kSettle) + (state == 2 ? 1 : state == 3 ? 2 : 0);
    }
  }
  EXPECT_EQ(bench.check().cycles(), cycles);
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * cycles);
  EXPECT_GT(bench.edges(), 50'000U);
}

void random_courses() {
  const std::uint64_t seed = seed_from_environment(20261122);
  Bench bench(seed);
  Dice dice(seed);
  const std::uint64_t length = scaled(500'000);
  Bench::Inputs in;
  std::uint64_t missed = 0;
  for (std::uint64_t i = 0; i < length; ++i) {
    if (dice.chance(8)) in.levels ^= 1U << dice.below(32);
    if (dice.chance(4)) in.raw = in.levels ^ (dice.draw() & dice.draw());
    if (dice.chance(4)) in.quiet = dice.draw();
    if (dice.chance(12)) in.waits = !in.waits;
    in.ends = !in.waits && dice.chance(30);
    in.at_rest = dice.chance(6);
    in.stopping = dice.chance(10);
    in.clear = dice.chance(20);
    in.cut = dice.chance(200);
    in.load = {dice.chance(12),
               static_cast<std::uint16_t>(dice.chance(3) ? dice.below(512) : model::load_target::kCommand),
               static_cast<std::uint16_t>(dice.draw())};
    if (dice.chance(5000))
      bench.reset(in);
    else
      bench.clock(in);
    missed += bench.model().missed() ? 1U : 0U;
  }
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * (length + 1));
  EXPECT_GT(bench.edges(), length / 500);
  EXPECT_GT(missed, length / 500);
  if (kFirstTouch)
    EXPECT_GT(bench.touches(), bench.edges());
  else
    EXPECT_EQ(bench.touches(), 0U);
}

TEST(Probe, EveryTwoClocksFromEachState) { EXPECT_EQ(judge(every_two_clocks), ""); }
TEST(Probe, RandomCourses) { EXPECT_EQ(judge(random_courses), ""); }

}  // namespace
}  // namespace trammel::lockstep
