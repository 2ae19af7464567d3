// Lockstep of the inputs' filter: levels that bounce, single pulses of every length around the limit, and other
// settings. A second checker knows only the inputs and the outputs.
#include "trammel/model/input_filter.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <type_traits>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

constexpr unsigned kInputs = TRAMMEL_INPUTS;
constexpr std::uint32_t kAll = static_cast<std::uint32_t>((std::uint64_t{1} << kInputs) - 1);
constexpr bool kQuiet = TRAMMEL_QUIET != 0;
constexpr std::uint64_t kScan = 64;
constexpr unsigned kSettles = 4;  // clocks: a look that has already read its length still uses the old one

// The filter's promise, in clocks, in terms of the levels driven and the outputs seen.
class Promise {
 public:
  // The levels of one clock, and the outputs after its edge.
  void clock(std::uint32_t levels, std::uint32_t outputs, std::uint32_t quiet) {
    if (kQuiet) judge_quiet(levels, outputs, quiet);
    for (unsigned n = 0; n < kInputs; ++n) {
      const std::uint32_t bit = std::uint32_t{1} << n;
      One& one = inputs_[n];
      one.differs = ((levels ^ outputs_) & bit) != 0 ? one.differs + 1 : 0;
      if (((outputs ^ outputs_) & bit) != 0) {
        if (one.differs <= one.least * kScan) too_short_ += 1;
        one.differs = 0;
        passed_ += 1;
      }
      if (one.differs >= (one.greatest + 1) * kScan) too_long_ += 1;
      if (one.settles != 0) one.settles -= 1;
      if (one.differs == 0 && one.settles == 0) one.greatest = one.least = one.length;
    }
    outputs_ = outputs;
  }
  // While a level lasts, both the old and the new length may apply.
  void set(unsigned input, std::uint64_t length) {
    if (input >= kInputs) return;
    One& one = inputs_[input];
    one.length = length;
    one.settles = kSettles;
    one.agreed = 0;
    one.least = std::min(one.least, length);
    one.greatest = std::max(one.greatest, length);
  }
  std::uint64_t passed() const { return passed_; }
  std::uint64_t quiet() const { return was_quiet_; }
  std::uint64_t bad_quiet() const { return bad_quiet_; }
  std::uint64_t too_short() const { return too_short_; }
  std::uint64_t too_long() const { return too_long_; }

 private:
  // An input may become quiet when its level has lasted for the length, as it passes or together with the output. It
  // must be quiet when it has agreed with the output for one scan more. It must not be quiet while it differs.
  void judge_quiet(std::uint32_t levels, std::uint32_t outputs, std::uint32_t quiet) {
    for (unsigned n = 0; n < kInputs; ++n) {
      const std::uint32_t bit = std::uint32_t{1} << n;
      One& one = inputs_[n];
      const bool differs = ((levels ^ outputs_) & bit) != 0;
      const bool passed = ((outputs ^ outputs_) & bit) != 0;
      one.stood = ((levels ^ levels_) & bit) != 0 ? 1 : one.stood + 1;
      one.agreed = differs ? 0 : one.agreed + 1;
      const bool is = (quiet & bit) != 0;
      const bool was = (quiet_ & bit) != 0;
      if (differs && !passed && is) ++bad_quiet_;
      if (is && !was && one.stood < one.least * kScan) ++bad_quiet_;
      if (!is && one.agreed >= (std::max<std::uint64_t>(one.greatest, 1) + 1) * kScan) ++bad_quiet_;
      was_quiet_ += is && !was ? 1 : 0;
    }
    levels_ = levels;
    quiet_ = quiet;
  }

  struct One {
    std::uint64_t stood = 0, agreed = 0;                // clocks
    unsigned settles = 0;                               // clocks until only the last length applies
    std::uint64_t differs = 0;                          // clocks
    std::uint64_t length = 0, least = 0, greatest = 0;  // scans
  };
  std::array<One, kInputs> inputs_{};
  std::uint32_t outputs_ = 0;
  std::uint32_t levels_ = 0, quiet_ = 0;
  std::uint64_t was_quiet_ = 0, bad_quiet_ = 0;
  std::uint64_t passed_ = 0, too_short_ = 0, too_long_ = 0;
};

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("input_filter", seed) { reset(); }

  // Runs until lengths may be set.
  void reset() {
    check_.event("reset");
    dut_->rst_i = 1;
    dut_->set_i = 0;
    dut_->levels_i = 0;
    dut_.clock();
    dut_->rst_i = 0;
    const model::InputFilter::State before = model_.state();
    model_ = model::InputFilter(kQuiet);
    // A reset does not change the RAM.
    model_.state().lengths = before.lengths;
    model_.state().counts = before.counts;
    model_.state().length_read = before.length_read;
    promise_ = Promise();
    compare();
    // In this time old lengths must not apply, and new ones must not be taken.
    for (std::uint64_t i = 0; i < kScan; ++i) clock({i % 3 == 0 ? 0 : kAll, false, 0, 0xFFFF});
    for (std::uint64_t i = 0; i < 2 * kScan; ++i) clock({});
  }

  void clock(const model::InputFilter::Inputs& in) {
    if (in.set) check_.event("length", std::uint64_t{in.set_input} << 32 | in.set_length);
    dut_->levels_i = static_cast<std::remove_reference_t<decltype(dut_->levels_i)>>(in.levels);
    dut_->set_i = in.set ? 1 : 0;
    dut_->set_input_i = static_cast<CData>(in.set_input);
    dut_->set_length_i = in.set_length;
    dut_.clock();
    model_.clock(in);
    if (in.set) promise_.set(in.set_input, in.set_length);
    promise_.clock(in.levels, dut_->levels_o, dut_->quiet_o);
    compare();
  }

  void set(unsigned input, std::uint16_t length) {
    clock({0, true, input, length});
    for (unsigned i = 0; i < kSettles; ++i) clock({});
  }
  // A level of this many clocks, and then rest for as long as the filter may need. Returns whether it passed.
  bool passes(unsigned input, std::uint64_t clocks, std::uint64_t length) {
    const std::uint32_t bit = std::uint32_t{1} << input;
    bool seen = false;
    for (std::uint64_t i = 0; i < clocks + (length + 2) * kScan; ++i) {
      clock({i < clocks ? bit : 0U});
      seen = seen || (model_.levels() & bit) != 0;
    }
    return seen;
  }

  const Checker& check() const { return check_; }
  const Promise& promise() const { return promise_; }

 private:
  void compare() {
    check_.next_cycle();
    check_.compare("levels_o", dut_->levels_o, model_.levels());
    check_.compare("quiet_o", dut_->quiet_o, model_.quiet() & kAll);
  }

  Simulated<Vdut> dut_;
  model::InputFilter model_{kQuiet};
  Checker check_;
  Promise promise_;
};

void expect_kept(const Promise& promise) {
  EXPECT_EQ(promise.too_short(), 0U);
  EXPECT_EQ(promise.too_long(), 0U);
  EXPECT_EQ(promise.bad_quiet(), 0U);
}

// Pulses that start in every clock of a scan: none of length * 64 clocks passes; each that is 64 clocks longer does.
void single_pulses() {
  Bench bench(0);
  unsigned some = 0;
  for (const int scans : {0, 1, 2, 5}) {
    const auto length = static_cast<std::uint16_t>(scans);
    for (unsigned phase = 0; phase < kScan; ++phase) {
      const unsigned input = phase % kInputs;
      bench.set(input, length);
      EXPECT_FALSE(bench.passes(input, length * kScan, length)) << length << " scans, phase " << phase;
      EXPECT_TRUE(bench.passes(input, (length + 1) * kScan, length));
      some += bench.passes(input, length * kScan + 32, length) ? 1U : 0U;
      bench.set(input, 0);
      for (unsigned i = 0; i < phase % 7; ++i) bench.clock({});
    }
  }
  EXPECT_GT(some, 0U);
  EXPECT_LT(some, 4 * kScan);
  expect_kept(bench.promise());
}

// Levels that last some clocks or some scans and bounce in between; lengths that change at the same time; resets.
void bouncing_levels() {
  const std::uint64_t seed = seed_from_environment(20261124);
  Bench bench(seed);
  Dice dice(seed);
  std::array<std::uint64_t, kInputs> left{};
  std::uint64_t passed = 0;
  std::uint64_t quiet = 0;
  model::InputFilter::Inputs in;
  const std::uint64_t length = scaled(400'000);
  for (std::uint64_t i = 0; i < length; ++i) {
    for (unsigned n = 0; n < kInputs; ++n) {
      if (left[n]-- != 0) continue;
      in.levels ^= std::uint32_t{1} << n;
      left[n] = dice.chance(2) ? dice.below(6) : dice.below(5 * kScan);
    }
    in.levels &= kAll;
    in.set = dice.chance(500);
    in.set_input = dice.below(32);
    in.set_length = static_cast<std::uint16_t>(dice.below(4));
    bench.clock(in);
    if (!dice.chance(40'000)) continue;
    passed += bench.promise().passed();
    quiet += bench.promise().quiet();
    expect_kept(bench.promise());
    bench.reset();
  }
  EXPECT_GT(passed + bench.promise().passed(), length / 1000);
  expect_kept(bench.promise());
  EXPECT_EQ(quiet + bench.promise().quiet() > length / 100, kQuiet);
  EXPECT_EQ(bench.check().comparisons(), 2 * bench.check().cycles());
}

TEST(InputFilter, PulsesAroundTheLimit) { EXPECT_EQ(judge(single_pulses), ""); }
TEST(InputFilter, BouncingLevels) { EXPECT_EQ(judge(bouncing_levels), ""); }

}  // namespace
}  // namespace trammel::lockstep
