// Lockstep of the card's inputs: random pins, polarities, filters, roles and resets. One promise is also judged
// without the model: a level shorter than its filter length is not seen, neither as a level nor as a role.
#include "trammel/model/card_inputs.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <type_traits>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;

constexpr unsigned kAxes = 4;
constexpr unsigned kInputs = TRAMMEL_INPUTS;
constexpr std::uint32_t kAll = static_cast<std::uint32_t>((std::uint64_t{1} << kInputs) - 1);
constexpr bool kMachineInputs = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kMachineInputs);
constexpr unsigned kScan = 64;  // clocks

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("card_inputs", seed) { reset(); }

  // Runs until settings may be written. Pins are active during that time, and already in the reset.
  void reset() {
    check_.event("reset");
    dut_->rst_i = 1;
    drive({kAll, {}});
    dut_.clock();
    dut_->rst_i = 0;
    model::CardInputs fresh(kAxes, kInputs, TRAMMEL_ENGINES);
    // A reset does not change the RAMs.
    fresh.state().filter.state().lengths = model_.state().filter.state().lengths;
    fresh.state().filter.state().counts = model_.state().filter.state().counts;
    fresh.state().filter.state().length_read = model_.state().filter.state().length_read;
    fresh.state().roles.state().masks = model_.state().roles.state().masks;
    fresh.state().roles.state().mask_read = model_.state().roles.state().mask_read;
    model_ = fresh;
    compare();
    for (unsigned i = 0; i < kScan; ++i) clock({kAll, {}});
  }

  void clock(const model::CardInputs::Inputs& in) {
    drive(in);
    dut_.clock();
    model_.clock(in);
    if (in.setting.set) check_.event("setting", std::uint64_t{in.setting.address} << 32 | in.setting.data);
    compare();
  }

  void set(std::uint32_t address, std::uint32_t data, std::uint32_t pins) { clock({pins, {true, address, data}}); }

  Checker& check() { return check_; }
  std::uint64_t levels() { return get(dut_->inputs_o, bus::input_levels::kLevels); }
  std::uint64_t raw() { return get(dut_->inputs_o, bus::input_levels::kRaw); }
  std::uint64_t roles() { return dut_->roles_o; }

 private:
  void drive(const model::CardInputs::Inputs& in) {
    dut_->pin_i = static_cast<std::remove_reference_t<decltype(dut_->pin_i)>>(in.pins & kAll);
    dut_->setting_i = wire(in.setting);
  }
  void compare() {
    check_.next_cycle();
    check_.compare("raw", raw(), model_.raw());
    check_.compare("levels", levels(), model_.levels());
    check_.compare("quiet", get(dut_->inputs_o, bus::input_levels::kQuiet), kMachineInputs ? model_.quiet() : 0);
    check_.compare("roles_o", dut_->roles_o, roles_wire(model_.roles()));
  }

  Simulated<Vdut> dut_;
  model::CardInputs model_{kAxes, kInputs, TRAMMEL_ENGINES};
  Checker check_;
};

// Any setting that the block takes, and the words next to its arrays.
model::Setting random_setting(Dice& dice) {
  switch (dice.below(6)) {
    case 0:
      return {true, reg::kInputPolarity, dice.draw()};
    case 1:
      return {true, reg::input_filter(0) - 4 + 4 * 97 * dice.below(2), dice.draw()};
    case 2:
    case 3:
      return {true, reg::input_filter(dice.below(32)), dice.below(4)};
    default:
      return {true, reg::role(dice.below(64)), dice.chance(3) ? 0 : dice.draw() & dice.draw() & dice.draw()};
  }
}

void random_pins() {
  const std::uint64_t seed = seed_from_environment(20261125);
  Bench bench(seed);
  Dice dice(seed);
  std::uint32_t pins = 0;
  std::uint64_t active = 0;
  const std::uint64_t length = scaled(300'000);
  for (std::uint64_t i = 0; i < length; ++i) {
    if (dice.chance(100)) pins ^= std::uint32_t{1} << dice.below(kInputs);
    // Address and data are random without `set`, too.
    model::Setting setting = dice.chance(50) ? random_setting(dice) : model::Setting{};
    setting.set = setting.set && dice.chance(2);
    bench.clock({dice.chance(40) ? dice.draw() : pins, setting});
    active += bench.roles() != 0 ? 1U : 0U;
    if (dice.chance(20'000)) bench.reset();
  }
  if (kMachineInputs) {
    EXPECT_GT(active, length / 10);
  } else {
    EXPECT_EQ(active, 0U);
  }
}

// A pulse of input 1 of a number of clocks; whether the input, and the role of an axis's positive limit, saw it.
struct Seen {
  bool raw = false, level = false, role = false;
};
Seen pulse(Bench& bench, unsigned clocks) {
  Seen seen;
  for (unsigned i = 0; i < clocks + 400; ++i) {
    bench.clock({i < clocks ? 2U : 0U, {}});
    seen.raw = seen.raw || bench.raw() == 2;
    seen.level = seen.level || bench.levels() == 2;
    seen.role = seen.role || bench.roles() == std::uint64_t{1} << 10;
  }
  return seen;
}

// With a filter of 3 scans, a pulse of 3 scans is not seen and one of 4 is; without a filter, one of a single clock
// is.
void pulses() {
  Bench bench(1);
  bench.set(reg::role(8 + 2), 2, 0);
  for (unsigned clocks = 1; clocks < 200; clocks += 11) {
    const Seen seen = pulse(bench, clocks);
    EXPECT_TRUE(seen.raw && seen.level);
    EXPECT_EQ(seen.role, kMachineInputs && (clocks >= kScan || seen.role)) << clocks;
  }
  if (!kMachineInputs) return;
  bench.set(reg::input_filter(1), 3, 0);
  for (unsigned clocks = 3 * kScan - 20; clocks <= 3 * kScan; ++clocks) {
    const Seen seen = pulse(bench, clocks);
    EXPECT_TRUE(seen.raw && !seen.level && !seen.role) << clocks;
  }
  for (unsigned clocks = 4 * kScan; clocks < 4 * kScan + 20; ++clocks) {
    const Seen seen = pulse(bench, clocks);
    EXPECT_TRUE(seen.raw && seen.level && seen.role) << clocks;
  }
}

TEST(CardInputs, RandomPins) { EXPECT_EQ(judge(random_pins), ""); }
TEST(CardInputs, Pulses) { EXPECT_EQ(judge(pulses), ""); }

}  // namespace
}  // namespace trammel::lockstep
