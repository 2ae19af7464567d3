// Lockstep of position streaming: periods of any length up to 2^40 - 1 ticks, ticks beyond their ends at any pace,
// with and without a successor, STREAMING set at any clock, commands that arrive in part; every output in every
// cycle.
#include "trammel/model/position_streaming.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "position_streaming_inside.hpp"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;

constexpr std::uint64_t kComparedSignals = 4;
constexpr std::uint64_t kMax = (std::uint64_t{1} << 40) - 1;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("position_streaming", seed), dice_(seed) { reset(); }

  void random_clock() {
    if (dice_.chance(2000)) pace_ = 1 + dice_.below(6);
    in_ = {};
    in_.setting = {dice_.chance(20), dice_.chance(8) ? reg::kHold : reg::kStreaming,
                   dice_.below(2) | (dice_.chance(8) ? dice_.below(256) : dice_.below(4)) << 8};
    in_.setting.data |= dice_.draw() & 0xFFFF'00FE;
    in_.write = dice_.chance(4);
    in_.whole = dice_.chance(3);
    in_.rest = !dice_.chance(5);
    in_.cut = dice_.chance(300);
    random_path();
    if (stale_ && dice_.chance(100)) ticks_near_a_carry();
    if (dice_.chance(in_.period || in_.stale_tick ? 100 : 3000))
      reset();
    else
      clock();
  }

  // A line continues without end: 2^bit ticks of a round are left, then one less.
  void borrow_from(unsigned bit) {
    reset();
    in_ = {};
    in_.setting = {true, reg::kStreaming, 255U << 8};
    clock();
    in_ = {};
    in_.begin = true;
    in_.ticks = kMax;
    clock();
    in_ = {};
    clock();
    in_.period = in_.goes_on = true;
    clock();
    in_.period = false;
    in_.stale_tick = true;
    clock();
    ticks_left(*dut_) = std::uint64_t{1} << bit;
    clock();
    check_.compare("ticks left", ticks_left(*dut_), (std::uint64_t{1} << bit) - 1);
  }

  Checker& check() { return check_; }
  std::uint64_t missing() const { return missing_; }
  std::uint64_t modes() const { return modes_; }

 private:
  // A path begins, reaches its end, and continues for a while.
  void random_path() {
    was_stale_ = stale_;
    if (stale_) {
      in_.stale_tick = dice_.chance(pace_);
      in_.goes_on = !dice_.chance(200);
      in_.begin = !in_.goes_on && dice_.chance(2);
      stale_ = in_.goes_on;
    } else if (running_ && dice_.chance(6)) {
      in_.period = true;
      in_.goes_on = !dice_.chance(8);
      stale_ = in_.goes_on;
      running_ = false;
    } else {
      in_.begin = dice_.chance(10);
    }
    if (in_.begin) {
      in_.ticks = random_ticks();
      check_.event("begin", in_.ticks);
      running_ = true;
    }
    if (in_.cut) running_ = stale_ = false;
  }

  // Few ticks, or counts that equal them if one bit is ignored.
  std::uint64_t random_ticks() {
    const std::uint64_t few = 1 + dice_.below(dice_.chance(2) ? 3 : 40);
    if (dice_.chance(3)) return few;
    if (dice_.chance(8)) return kMax - dice_.below(2);
    const std::uint64_t ticks = (std::uint64_t{1} << dice_.below(40)) + few;
    return ticks > kMax ? kMax : ticks;
  }

  // The port is the register itself.
  void ticks_near_a_carry() {
    dut_->ticks_o = static_cast<IData>(dice_.before_carry(32));
    ticks_ahead_ = dut_->ticks_o - model_.outputs().ticks;
  }

  void reset() {
    check_.event("reset");
    dut_->rst_i = 1;
    apply();
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::PositionStreaming();
    ticks_ahead_ = 0;
    running_ = stale_ = false;
    compare();
  }

  void clock() {
    apply();
    const bool on = model_.outputs().on;
    dut_.clock();
    model_.clock(in_);
    if (in_.period) ticks_ahead_ = 0;
    began_with_ = in_.begin ? in_.ticks : 0;
    compare();
    missing_ += model_.outputs().missing ? 1U : 0U;
    modes_ += model_.outputs().on != on ? 1U : 0U;
  }

  void apply() {
    dut_->cut_i = in_.cut;
    dut_->setting_i = wire(in_.setting);
    using namespace bus::arrival;
    dut_->arrival_i = dice_.draw() & static_cast<IData>(in_place(kFull, 1) | in_place(kHalfword, ~0U));
    if (in_.write) put(dut_->arrival_i, dice_.chance(2) ? kGeometryWrite : kFeedWrite, 1);
    if (in_.whole) put(dut_->arrival_i, dice_.chance(3) ? kDrop : dice_.chance(2) ? kGeometryCommit : kFeedCommit, 1);
    dut_->rest_i = in_.rest;
    dut_->begin_i = in_.begin;
    dut_->count_i = began_with_ != 0 ? began_with_ : dice_.word() & kMax;
    // A tick that is not beyond the line's end must have no effect.
    const bool gone_on = in_.stale_tick || (was_stale_ && dice_.chance(2));
    dut_->take_i = in_.stale_tick || (!gone_on && dice_.chance(2));
    dut_->goes_on_i = in_.goes_on;
    dut_->stale_i = gone_on;
    dut_->period_ends_i = in_.period;
  }

  void compare() {
    check_.next_cycle();
    const auto& out = model_.outputs();
    check_.compare("streaming_o", dut_->streaming_o, out.on);
    check_.compare("missing_o", dut_->missing_o, out.missing);
    check_.compare("lost_o", dut_->lost_o, out.lost);
    check_.compare("ticks_o", dut_->ticks_o, out.ticks + ticks_ahead_);
  }

  Simulated<Vdut> dut_;
  model::PositionStreaming model_;
  model::PositionStreaming::Inputs in_;
  Checker check_;
  Dice dice_;
  unsigned pace_ = 1;             // a tick in one of this many clocks
  std::uint64_t began_with_ = 0;  // ticks of the path that began in the previous clock; 0: none
  bool running_ = false;
  bool stale_ = false;
  bool was_stale_ = false;
  std::uint32_t ticks_ahead_ = 0;  // the RTL's count minus the model's, until the next period ends
  std::uint64_t missing_ = 0;
  std::uint64_t modes_ = 0;
};

void random_periods() {
  Bench bench(seed_from_environment(20261122));
  const std::uint64_t length = scaled(1'000'000);
  for (std::uint64_t i = 0; i < length; ++i) bench.random_clock();
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * bench.check().cycles());
  EXPECT_GT(bench.missing(), length / 2000);
  EXPECT_GT(bench.modes(), length / 1000);
}

void borrows() {
  Bench bench(2);
  for (unsigned bit = 2; bit < 40; ++bit) bench.borrow_from(bit);
}

TEST(PositionStreaming, Borrows) { EXPECT_EQ(judge(borrows), ""); }
TEST(PositionStreaming, RandomPeriods) { EXPECT_EQ(judge(random_periods), ""); }

}  // namespace
}  // namespace trammel::lockstep
