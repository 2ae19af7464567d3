// Lockstep of the machine's place: every sequence of one axis over a few clocks, and random ones of all axes; the
// register in every cycle.
#include "trammel/model/machine_place.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr unsigned kAxes = TRAMMEL_AXES;
constexpr std::uint8_t kAllAxes = (1U << kAxes) - 1;

class Bench {
 public:
  using Inputs = model::MachinePlace::Inputs;

  explicit Bench(std::uint64_t seed) : check_("machine_place", seed) { reset({}); }

  void reset(const Inputs& in) {
    check_.event("reset");
    dut_->rst_i = 1;
    apply(in);
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::MachinePlace(kAxes);
    compare();
  }

  void clock(const Inputs& in) {
    if (in.setting.set) check_.event("setting", std::uint64_t{in.setting.address} << 32 | in.setting.data);
    if (in.cut) check_.event("cut");
    apply(in);
    dut_.clock();
    const std::uint8_t before = model_.state().valid;
    model_.clock(in);
    compare();
    losses_ += (before & ~model_.state().valid) != 0 && !in.setting.set ? 1U : 0U;
    kept_ +=
        in.cut && !in.at_rest && (model_.state().moved & model_.state().keeps & model_.state().valid) != 0 ? 1U : 0U;
  }

  void set(std::uint32_t address, std::uint32_t data) {
    Inputs in;
    in.setting = {true, address, data};
    clock(in);
  }

  Checker& check() { return check_; }
  std::uint64_t losses() const { return losses_; }
  std::uint64_t kept() const { return kept_; }

 private:
  void apply(const Inputs& in) {
    dut_->setting_i = wire(in.setting);
    dut_->cut_i = in.cut;
    dut_->at_rest_i = in.at_rest;
    dut_->runs_i = in.runs;
    dut_->step_i = static_cast<CData>(in.step & kAllAxes);
    dut_->disabled_i = static_cast<CData>(in.disabled & kAllAxes);
    dut_->drive_fault_i = static_cast<CData>(in.drives & kAllAxes);
  }

  void compare() {
    check_.next_cycle();
    check_.compare("place_o", dut_->place_o, model_.place());
  }

  Simulated<Vdut> dut_;
  model::MachinePlace model_{kAxes};
  Checker check_;
  std::uint64_t losses_ = 0;
  std::uint64_t kept_ = 0;
};

std::uint32_t place_of(std::uint32_t axes, std::uint32_t bits) { return axes << field::kSetPlaceAxesShift | bits; }

// The last axis, valid and homed, kept and not kept, in every sequence of three clocks: a step, a piece, rest, a cut,
// a fault of the drive, a write of both bits or of neither. A fourth clock without events shows the effect of the
// third.
void every_course() {
  Bench bench(0);
  constexpr std::uint8_t kBit = 1U << (kAxes - 1);
  constexpr unsigned kMoments = 64;
  for (const std::uint32_t keeps : {std::uint32_t{0}, std::uint32_t{kBit}}) {
    for (unsigned course = 0; course < kMoments * kMoments * kMoments; ++course) {
      bench.reset({});
      bench.set(reg::kKeepsPlace, keeps);
      bench.set(reg::kSetPlace, place_of(kAllAxes, 3));
      unsigned rest = course;
      for (unsigned clock = 0; clock < 3; ++clock, rest /= kMoments) {
        Bench::Inputs in;
        in.step = (rest & 1) != 0 ? kBit : std::uint8_t{0};
        in.runs = (rest & 2) != 0;
        in.at_rest = (rest & 4) != 0;
        in.cut = (rest & 8) != 0;
        in.drives = (rest & 0x30) == 0x30 && !in.at_rest ? kBit : std::uint8_t{0};
        in.disabled = (rest & 0x30) == 0x30 && in.at_rest ? kBit : std::uint8_t{0};
        in.setting = {(rest & 0x30) == 0x10 || (rest & 0x30) == 0x20, reg::kSetPlace,
                      place_of(kBit, (rest & 0x20) != 0 ? 3 : 0)};
        bench.clock(in);
      }
      bench.clock({});
    }
  }
  EXPECT_EQ(bench.check().comparisons(), bench.check().cycles());
  EXPECT_GT(bench.losses(), 10'000U);
  EXPECT_GT(bench.kept(), 1'000U);
}

std::uint8_t some_axes(Dice& dice, unsigned one_in) {
  return dice.chance(one_in) ? static_cast<std::uint8_t>(dice.draw() & kAllAxes) : std::uint8_t{0};
}

model::Setting random_setting(Dice& dice) {
  switch (dice.below(6)) {
    case 0:
      return {true, reg::kKeepsPlace, dice.draw() & dice.draw() & 0xFF};
    case 1:
      return {true, reg::kScales, dice.draw()};
    case 2:
      return {true, reg::kLimitOverride, dice.draw()};
    default:
      return {true, reg::kSetPlace, place_of(dice.draw() & 0xFF, dice.chance(3) ? dice.below(4) : 3)};
  }
}

void random_courses() {
  const std::uint64_t seed = seed_from_environment(20261125);
  Bench bench(seed);
  Dice dice(seed);
  const std::uint64_t length = scaled(400'000);
  Bench::Inputs in;
  for (std::uint64_t i = 0; i < length; ++i) {
    in.step = some_axes(dice, 4);
    if (dice.chance(10)) in.runs = !in.runs;
    if (dice.chance(10)) in.at_rest = dice.chance(3);
    in.cut = dice.chance(12);
    in.drives = some_axes(dice, 100);
    in.disabled = some_axes(dice, 100);
    in.setting = dice.chance(6) ? random_setting(dice) : model::Setting{};
    if (dice.chance(2000))
      bench.reset(in);
    else
      bench.clock(in);
  }
  EXPECT_EQ(bench.check().comparisons(), length + 1);
  EXPECT_GT(bench.losses(), length / 100);
  EXPECT_GT(bench.kept(), length / 400);
}

// Inputs in the clock of a reset have no effect after it.
void reset_beside_an_event() {
  Bench bench(0);
  Bench::Inputs in;
  in.runs = in.cut = true;
  in.step = in.drives = in.disabled = kAllAxes;
  bench.reset(in);
  bench.set(reg::kSetPlace, place_of(kAllAxes, 3));
  bench.clock({});
  EXPECT_EQ(bench.losses(), 0U);
}

TEST(MachinePlace, EveryCourse) { EXPECT_EQ(judge(every_course), ""); }
TEST(MachinePlace, ResetBesideAnEvent) { EXPECT_EQ(judge(reset_beside_an_event), ""); }
TEST(MachinePlace, RandomCourses) { EXPECT_EQ(judge(random_courses), ""); }

}  // namespace
}  // namespace trammel::lockstep
