// Lockstep of the scan of roles: random levels, masks and resets. A second checker knows only the levels, the masks
// and the outputs.
#include "trammel/model/role_scan.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <type_traits>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

constexpr unsigned kAxes = TRAMMEL_AXES;
constexpr unsigned kInputs = TRAMMEL_INPUTS;
constexpr std::uint32_t kAll = static_cast<std::uint32_t>((std::uint64_t{1} << kInputs) - 1);
constexpr unsigned kRoles = 64;
constexpr unsigned kLatest = kRoles + 3;  // clocks until an output follows: a scan, and a mask that is being read

// The bit of a role in the outputs, in the order of input_roles_pkg; negative for a role that the outputs do not
// have.
int bit_of(unsigned role) {
  switch (role) {
    case 48:
      return 27;
    case 49:
      return 26;
    case 50:
      return 24;
    case 51:
      return 25;
    default:
      break;
  }
  if (role % 8 >= kAxes) return -1;
  if (role < 16) return static_cast<int>(role);
  return role / 8 == 4 ? static_cast<int>(16 + role % 8) : -1;
}

// The scan's promise: an output has the level that its role's inputs have had for longer than a scan.
class Promise {
 public:
  void clock(std::uint32_t levels, std::uint32_t outputs) {
    for (unsigned role = 0; role < kRoles; ++role) {
      const int bit = bit_of(role);
      if (bit < 0) continue;
      One& one = roles_[role];
      const bool level = (levels & one.mask) != 0;
      one.same = level == one.level ? one.same + 1 : 0;
      one.level = level;
      const bool seen = (outputs >> bit & 1) != 0;
      settled_ += one.same > kLatest ? 1 : 0;
      active_ += one.same > kLatest && level ? 1 : 0;
      wrong_ += one.same > kLatest && seen != level ? 1 : 0;
      // All other bits belong to no role: they must be 0.
      outputs &= ~(std::uint32_t{1} << bit);
    }
    wrong_ += outputs != 0 ? 1 : 0;
  }
  void set(unsigned role, std::uint32_t mask) {
    roles_[role].mask = mask;
    roles_[role].same = 0;
  }
  void reset() { roles_ = {}; }
  std::uint64_t wrong() const { return wrong_; }
  std::uint64_t settled() const { return settled_; }
  std::uint64_t active() const { return active_; }

 private:
  struct One {
    std::uint32_t mask = 0;
    std::uint64_t same = 0;  // clocks
    bool level = false;
  };
  std::array<One, kRoles> roles_{};
  std::uint64_t wrong_ = 0, settled_ = 0, active_ = 0;
};

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("role_scan", seed) { reset(); }

  // Runs until masks may be set. Levels are active during that time: old masks must not apply, and new ones must not
  // be taken.
  void reset() {
    check_.event("reset");
    dut_->rst_i = 1;
    dut_->set_i = 0;
    dut_.clock();
    dut_->rst_i = 0;
    model::RoleScan::State state;
    // A reset does not change the RAM.
    state.masks = model_.state().masks;
    state.mask_read = model_.state().mask_read;
    model_.state() = state;
    promise_.reset();
    compare();
    for (unsigned i = 0; i < kRoles; ++i) clock({kAll, false, 0, kAll});
  }

  void clock(const model::RoleScan::Inputs& in) {
    dut_->levels_i = static_cast<std::remove_reference_t<decltype(dut_->levels_i)>>(in.levels);
    dut_->set_i = in.set ? 1 : 0;
    dut_->set_role_i = static_cast<CData>(in.set_role);
    dut_->set_mask_i = static_cast<std::remove_reference_t<decltype(dut_->set_mask_i)>>(in.set_mask);
    dut_.clock();
    model_.clock(in);
    if (in.set) {
      check_.event("mask", std::uint64_t{in.set_role} << 32 | in.set_mask);
      promise_.set(in.set_role, in.set_mask);
    }
    promise_.clock(in.levels, dut_->roles_o);
    compare();
  }

  const Checker& check() const { return check_; }
  const Promise& promise() const { return promise_; }

 private:
  void compare() {
    check_.next_cycle();
    check_.compare("roles_o", dut_->roles_o, roles_wire(model_.roles()));
  }

  Simulated<Vdut> dut_;
  model::RoleScan model_{kAxes};
  Checker check_;
  Promise promise_;
};

void random_levels() {
  const std::uint64_t seed = seed_from_environment(20261124);
  Bench bench(seed);
  Dice dice(seed);
  model::RoleScan::Inputs in;
  const std::uint64_t length = scaled(200'000);
  for (std::uint64_t i = 0; i < length; ++i) {
    if (dice.chance(100)) in.levels ^= (std::uint32_t{1} << dice.below(kInputs)) & kAll;
    if (dice.chance(1'000)) in.levels = 0;
    in.set = dice.chance(30);
    in.set_role = dice.below(kRoles);
    in.set_mask =
        dice.chance(3) ? 0 : std::uint32_t{1} << dice.below(kInputs) | std::uint32_t{1} << dice.below(kInputs);
    bench.clock(in);
    if (dice.chance(20'000)) bench.reset();
  }
  EXPECT_EQ(bench.promise().wrong(), 0U);
  EXPECT_GT(bench.promise().active(), length / 10);
  EXPECT_GT(bench.promise().settled(), 2 * bench.promise().active());
}

TEST(RoleScan, RandomLevels) { EXPECT_EQ(judge(random_levels), ""); }

}  // namespace
}  // namespace trammel::lockstep
