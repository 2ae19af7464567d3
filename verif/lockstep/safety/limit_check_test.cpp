// Lockstep of the limit check: every sequence of steps and levels of one axis over a few clocks with each rule, and
// random ones of all axes; every output in every cycle.
#include "trammel/model/limit_check.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr unsigned kAxes = TRAMMEL_AXES;
constexpr std::uint64_t kComparedSignals = 2;

class Bench {
 public:
  using Inputs = model::LimitCheck::Inputs;

  explicit Bench(std::uint64_t seed) : check_("limit_check", seed) { reset({}); }

  void reset(const Inputs& in) {
    check_.event("reset");
    dut_->rst_i = 1;
    apply(in);
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::LimitCheck(kAxes);
    compare();
  }

  void clock(const Inputs& in) {
    if (in.step != 0) check_.event("step, direction", std::uint64_t{in.step} << 8 | in.dir);
    if (in.setting.set) check_.event("setting", std::uint64_t{in.setting.address} << 32 | in.setting.data);
    if (in.clear != 0) check_.event("clear", in.clear);
    apply(in);
    dut_.clock();
    model_.clock(in);
    compare();
    limits_ += model_.causes().limit ? 1U : 0U;
    beyond_ += model_.causes().beyond ? 1U : 0U;
    others_ += model_.causes().probe || model_.causes().tool_setter ? 1U : 0U;
  }

  void set(std::uint32_t address, std::uint32_t data) {
    Inputs in;
    in.setting = {true, address, data};
    clock(in);
  }

  Checker& check() { return check_; }
  std::uint64_t limits() const { return limits_; }
  std::uint64_t beyond() const { return beyond_; }
  std::uint64_t others() const { return others_; }

 private:
  void apply(const Inputs& in) {
    dut_->setting_i = wire(in.setting);
    dut_->roles_i = roles_wire(in.roles);
    dut_->step_i = static_cast<CData>(in.step & ((1U << kAxes) - 1));
    dut_->dir_i = static_cast<CData>(in.dir & ((1U << kAxes) - 1));
    dut_->runs_i = in.runs;
    dut_->probing_i = in.probing;
    dut_->stopping_i = in.stopping;
    dut_->clear_i = in.clear;
  }

  void compare() {
    check_.next_cycle();
    check_.compare("causes_o", dut_->causes_o, causes_wire(model_.causes()));
    check_.compare("state_o", dut_->state_o, model_.limit_state());
  }

  Simulated<Vdut> dut_;
  model::LimitCheck model_{kAxes};
  Checker check_;
  std::uint64_t limits_ = 0;
  std::uint64_t beyond_ = 0;
  std::uint64_t others_ = 0;
};

// The last axis in every sequence of four clocks: no step or one in either direction, with each pair of levels; with
// each rule.
void every_course() {
  Bench bench(0);
  constexpr unsigned kAxis = kAxes - 1;
  constexpr std::uint8_t kBit = 1U << kAxis;
  constexpr unsigned kClocks = 4;
  constexpr unsigned kMoments = 12;
  const std::uint32_t rules[] = {0, kBit, std::uint32_t{kBit} << field::kStopCausesSharedShift};
  for (const std::uint32_t rule : rules) {
    for (unsigned course = 0; course < kMoments * kMoments * kMoments * kMoments; ++course) {
      bench.reset({});
      bench.set(reg::kStopCauses, rule);
      unsigned rest = course;
      bool backwards = false;
      for (unsigned clock = 0; clock < kClocks; ++clock, rest /= kMoments) {
        const unsigned move = rest % 3;
        Bench::Inputs in;
        in.roles.limit_minus = (rest / 3 & 1) != 0 ? kBit : std::uint8_t{0};
        in.roles.limit_plus = (rest / 3 & 2) != 0 ? kBit : std::uint8_t{0};
        in.step = move != 0 ? kBit : std::uint8_t{0};
        if (move != 0) backwards = move == 2;
        in.dir = backwards ? kBit : std::uint8_t{0};
        bench.clock(in);
      }
      bench.clock({});
      bench.clock({});
    }
  }
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * bench.check().cycles());
  EXPECT_GT(bench.limits(), 10'000U);
}

std::uint8_t some_axes(Dice& dice, unsigned one_in) {
  return dice.chance(one_in) ? static_cast<std::uint8_t>(dice.draw() & 0xFF) : std::uint8_t{0};
}

model::Setting random_setting(Dice& dice) {
  switch (dice.below(4)) {
    case 0:
      return {true, reg::kStopCauses, dice.draw() & dice.draw() & 0x6FFFF};
    case 1:
      return {true, reg::kLimitOverride, dice.draw() & dice.draw() & 0xFFFF};
    case 2:
      return {true, reg::overtravel(dice.below(kAxes)), dice.below(6)};
    default:
      return {true, reg::mode(dice.below(kAxes)), dice.draw()};
  }
}

void random_courses() {
  const std::uint64_t seed = seed_from_environment(20261124);
  Bench bench(seed);
  Dice dice(seed);
  const std::uint64_t length = scaled(400'000);
  Bench::Inputs in;
  for (std::uint64_t i = 0; i < length; ++i) {
    in.step = some_axes(dice, 2);
    in.dir = static_cast<std::uint8_t>((in.dir & ~in.step) | (dice.draw() & in.step));
    if (dice.chance(8)) in.roles.limit_minus = some_axes(dice, 2);
    if (dice.chance(8)) in.roles.limit_plus = some_axes(dice, 2);
    if (dice.chance(20)) in.roles.drive_fault = some_axes(dice, 3) & some_axes(dice, 1);
    if (dice.chance(8)) in.roles.probe = !in.roles.probe;
    if (dice.chance(8)) in.roles.tool_setter = !in.roles.tool_setter;
    if (dice.chance(10)) in.stopping = !in.stopping;
    if (dice.chance(20)) in.runs = !in.runs;
    if (dice.chance(20)) in.probing = !in.probing;
    in.clear = dice.chance(6) ? dice.draw() : 0;
    in.setting = dice.chance(20) ? random_setting(dice) : model::Setting{};
    if (dice.chance(2000))
      bench.reset(in);
    else
      bench.clock(in);
  }
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * (length + 1));
  EXPECT_GT(bench.limits(), length / 20);
  EXPECT_GT(bench.beyond(), length / 100);
  EXPECT_GT(bench.others(), length / 1'000);
}

// Inputs in the clock of a reset have no effect after it.
void reset_beside_a_cause() {
  Bench bench(0);
  bench.set(reg::kStopCauses, field::kStopCausesProbe | field::kStopCausesToolSetter);
  Bench::Inputs in;
  in.runs = true;
  bench.clock(in);
  in.roles.probe = in.roles.tool_setter = true;
  in.roles.drive_fault = in.roles.limit_plus = in.step = 1;
  bench.reset(in);
  bench.clock(in);
  EXPECT_EQ(bench.others(), 0U);
}

TEST(LimitCheck, EveryCourse) { EXPECT_EQ(judge(every_course), ""); }
TEST(LimitCheck, ResetBesideACause) { EXPECT_EQ(judge(reset_beside_a_cause), ""); }
TEST(LimitCheck, RandomCourses) { EXPECT_EQ(judge(random_courses), ""); }

}  // namespace
}  // namespace trammel::lockstep
