// Lockstep of the stop control: every order of two or three events in each state with each reaction, and random ones;
// every output in every cycle.
#include "trammel/model/stop_control.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;

constexpr unsigned kAxes = TRAMMEL_AXES;
constexpr std::uint64_t kComparedSignals = 11;

class Bench {
 public:
  using Inputs = model::StopControl::Inputs;

  explicit Bench(std::uint64_t seed) : check_("stop_control", seed) { reset({}); }

  // One clock of reset, with these other inputs.
  void reset(const Inputs& in) {
    check_.event("reset");
    dut_->rst_i = 1;
    apply(in);
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::StopControl();
    compare();
  }

  void clock(const Inputs& in) {
    if (in.step_fault != 0) check_.event("step fault", in.step_fault);
    if (in.missing) check_.event("missing period");
    if (in.expired) check_.event("watchdog expired");
    if (in.link_lost) check_.event("link lost");
    if (in.soft_limit) check_.event("soft limit");
    if (in.emergency) check_.event("emergency stop");
    if (in.causes.any()) check_.event("cause from an input", causes_wire(in.causes));
    if (in.mismatch || in.incomplete) check_.event("fault at once", in.mismatch);
    if (in.abort) check_.event("abort");
    if (in.clear != 0) check_.event("clear", in.clear);
    if (in.setting.set) check_.event("setting", std::uint64_t{in.setting.address} << 32 | in.setting.data);
    apply(in);
    dut_.clock();
    model_.clock(in);
    compare();
    rests_ += model_.rests(in) ? 1U : 0U;
    cuts_ += model_.outputs().cut ? 1U : 0U;
  }

  void set(std::uint32_t address, std::uint32_t data) {
    Inputs in;
    in.setting = {true, address, data};
    clock(in);
  }

  const model::StopControl::Outputs& outputs() const { return model_.outputs(); }
  Checker& check() { return check_; }
  std::uint64_t cuts() const { return cuts_; }
  std::uint64_t rests() const { return rests_; }
  void swap(bool begins) { swap_ = begins; }

 private:
  void apply(const Inputs& in) {
    dut_->setting_i = wire(in.setting);
    dut_->step_fault_i = static_cast<CData>(in.step_fault);
    dut_->mismatch_i = in.mismatch;
    dut_->incomplete_i = in.incomplete;
    dut_->missing_i = in.missing;
    dut_->expired_i = in.expired;
    dut_->link_lost_i = in.link_lost;
    dut_->emergency_i = in.emergency;
    dut_->causes_i = causes_wire(in.causes);
    dut_->soft_limit_i = in.soft_limit;
    dut_->abort_i = in.abort;
    dut_->clear_i = in.clear;
    dut_->at_rest_i = in.at_rest;
    dut_->moving_i = in.moving;
    dut_->fixed_i = in.fixed;
    dut_->underrun_i = in.underrun;
    dut_->probe_i = in.probe;
    dut_->button_i = in.button;
    dut_->take_i = in.take;
    dut_->swap_i = swap_;
    dut_->quiet_i = in.quiet;
    dut_->pulses_i = in.pulses;
    dut_->busy_i = in.busy;
    in_ = in;
  }

  void compare() {
    check_.next_cycle();
    const auto& out = model_.outputs();
    check_.compare("fault_o", dut_->fault_o, out.fault);
    check_.compare("hold_o", dut_->hold_o, out.hold);
    check_.compare("cut_o", dut_->cut_o, out.cut);
    check_.compare("stop_o", dut_->stop_o, out.stop);
    check_.compare("stopping_o", dut_->stopping_o, out.stopping);
    check_.compare("closed_o", dut_->closed_o, out.closed);
    check_.compare("rest_o", dut_->rest_o, model_.rests(in_));
    check_.compare("closing_o", dut_->closing_o, model_.closing());
    check_.compare("caused_o", dut_->caused_o, model_.caused(in_));
    check_.compare("shut_o", dut_->shut_o, model_.shut());
    check_.compare("settled_o", dut_->settled_o, model_.settled() && !swap_);
  }

  Simulated<Vdut> dut_;
  model::StopControl model_;
  Checker check_;
  Inputs in_;
  bool swap_ = false;
  std::uint64_t cuts_ = 0;
  std::uint64_t rests_ = 0;
};

// The events of one clock of the directed scenario. Over a screen: one case per event.
Bench::Inputs happening(unsigned kind) {
  Bench::Inputs in;
  switch (kind) {
    case 0:
      in.step_fault = 1;
      break;
    case 1:
      in.step_fault = 1U << (kAxes - 1);
      break;
    case 2:
      in.mismatch = true;
      break;
    case 3:
      in.incomplete = true;
      break;
    case 4:
      in.abort = true;
      break;
    case 5:
      in.clear = ~0U;
      break;
    case 6:
      in.at_rest = true;
      break;
    case 7:  // an event wins over a clear in the same clock
      in.clear = ~0U;
      in.step_fault = 1;
      break;
    case 8:
      in.abort = true;
      in.step_fault = 1;
      break;
    case 9:
      in.missing = true;
      break;
    case 10:
      in.expired = true;
      break;
    case 11:
      in.causes.limit = true;
      break;
    case 12:  // no overtravel is left
      in.causes.limit = in.causes.beyond = true;
      break;
    case 13:
      in.causes.drive_fault = in.causes.tool_setter = true;
      break;
    case 14:
      in.soft_limit = true;
      break;
    case 15:
      in.link_lost = true;
      break;
    case 16:
      in.emergency = true;
      break;
    default:
      break;
  }
  return in;
}
constexpr unsigned kHappenings = 18;  // the last one is no event

// Three events at any distance of 0 to 2 clocks, with each reaction, from reset.
void every_order() {
  Bench bench(0);
  std::uint64_t cycles = 1;
  for (const std::uint32_t reaction : {0U, 0x7FCFFU}) {
    for (unsigned order = 0; order < kHappenings * kHappenings * kHappenings * 9; ++order) {
      unsigned rest = order;
      const auto draw = [&rest](unsigned n) {
        const unsigned value = rest % n;
        rest /= n;
        return value;
      };
      bench.reset({});
      bench.set(reg::kStopReaction, reaction);
      bench.clock(happening(draw(kHappenings)));
      const unsigned first = draw(3);
      for (unsigned i = 0; i < first; ++i) bench.clock({});
      bench.clock(happening(draw(kHappenings)));
      const unsigned second = draw(3);
      for (unsigned i = 0; i < second; ++i) bench.clock({});
      bench.clock(happening(draw(kHappenings)));
      // Every other run continues to the end of a stop.
      const unsigned rest_for = order % 2 == 0 ? 3 : 36;
      for (unsigned i = 0; i < rest_for; ++i) bench.clock({});
      cycles += 5 + rest_for + first + second;
    }
  }
  EXPECT_EQ(bench.check().cycles(), cycles);
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * cycles);
  EXPECT_GT(bench.cuts(), 10'000U);
}

// HOLD, or the button's hold, set and released in every clock of every sequence of six clocks of the pieces: none, a
// fixed one, another one, and a fixed one with the time base at rest.
void holds(bool button) {
  Bench bench(0);
  constexpr unsigned kClocks = 6;
  std::uint64_t cycles = 1;
  std::uint64_t held = 0;
  std::uint64_t waited = 0;
  for (unsigned set_at = 0; set_at < kClocks; ++set_at) {
    for (unsigned course = 0; course < 1U << 2 * kClocks; ++course) {
      bench.reset({});
      for (unsigned clock = 0; clock < kClocks; ++clock) {
        const unsigned now = course >> 2 * clock & 3;
        Bench::Inputs in;
        in.moving = now != 0;
        in.fixed = now == 1 || now == 3;
        in.at_rest = now == 3;
        if (clock == set_at && !button) in.setting = {true, reg::kHold, 1};
        if (clock == set_at + 4) in.setting = {true, reg::kHold, 0};
        in.button = button && clock > set_at && clock <= set_at + 4;
        bench.clock(in);
        if (clock > set_at) ++(bench.outputs().hold ? held : waited);
      }
      cycles += kClocks + 1;
    }
  }
  EXPECT_EQ(bench.check().cycles(), cycles);
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * cycles);
  EXPECT_GT(held, cycles / 10);
  EXPECT_GT(waited, cycles / 50);
}

void random_events() {
  const std::uint64_t seed = seed_from_environment(20261119);
  Bench bench(seed);
  Dice dice(seed);
  const std::uint64_t length = scaled(500'000);
  unsigned rest_every = 10;
  unsigned moves_every = 10;
  unsigned course = 0;  // state of the pieces
  bool expired = false;
  bool link_lost = false;
  bool emergency = false;
  bool drive_fault = false;
  bool button = false;
  for (std::uint64_t i = 0; i < length; ++i) {
    Bench::Inputs in;
    if (i % 512 == 0) rest_every = 1 + dice.below(40);
    if (dice.chance(12)) in.step_fault = dice.draw() & dice.draw() & ((1U << kAxes) - 1);
    in.mismatch = dice.chance(60);
    in.incomplete = dice.chance(60);
    in.missing = dice.chance(30);
    if (dice.chance(expired ? 10 : 40)) expired = !expired;
    in.expired = expired;
    if (dice.chance(link_lost ? 10 : 40)) link_lost = !link_lost;
    in.link_lost = link_lost;
    if (dice.chance(emergency ? 10 : 60)) emergency = !emergency;
    in.emergency = emergency;
    if (dice.chance(drive_fault ? 10 : 40)) drive_fault = !drive_fault;
    in.causes.drive_fault = drive_fault;
    in.causes.limit = dice.chance(20);
    in.causes.beyond = in.causes.limit && dice.chance(3);
    in.soft_limit = dice.chance(60);
    in.causes.probe = dice.chance(60);
    in.causes.tool_setter = dice.chance(60);
    if (dice.chance(12)) button = !button;
    in.button = button;
    in.abort = dice.chance(30);
    if (dice.chance(6)) in.clear = dice.chance(2) ? ~0U : dice.draw();
    in.at_rest = dice.chance(rest_every);
    if (dice.chance(6)) course = dice.below(4);
    in.moving = course != 0;
    in.fixed = course > 1 || (course == 0 && dice.chance(2));
    in.underrun = dice.chance(6);
    in.probe = dice.chance(6);
    if (i % 128 == 0) moves_every = 1 + dice.below(dice.chance(2) ? 200 : 20);
    in.take = dice.chance(moves_every);
    in.quiet = !dice.chance(moves_every);
    in.pulses = dice.chance(moves_every);
    in.busy = dice.chance(2);
    bench.swap(dice.chance(10));
    if (dice.chance(20)) in.setting = {dice.chance(2), dice.chance(2) ? reg::kHold : reg::kHoldLimit, dice.below(2)};
    if (dice.chance(20)) in.setting = {dice.chance(2), reg::kStopReaction, dice.draw() & 0x7FCFF};
    if (dice.chance(2000))
      bench.reset(in);
    else
      bench.clock(in);
  }
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * (length + 1));
  EXPECT_GT(bench.cuts(), length / 200);
  EXPECT_GT(bench.rests(), length / 500);
}

TEST(StopControl, EveryOrderOfThree) { EXPECT_EQ(judge(every_order), ""); }
TEST(StopControl, Holds) {
  EXPECT_EQ(judge([] { holds(false); }), "");
}
TEST(StopControl, ButtonHolds) {
  EXPECT_EQ(judge([] { holds(true); }), "");
}
TEST(StopControl, RandomEvents) { EXPECT_EQ(judge(random_events), ""); }

}  // namespace
}  // namespace trammel::lockstep
