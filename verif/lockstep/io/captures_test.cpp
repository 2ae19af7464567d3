// Lockstep of the capture units: arbitrary levels, and levels that bounce behind real filters with snapshots that
// come late; selections, clears and resets at any clock; a queue that takes captures late, and is full. Every output
// in every cycle.
#include "trammel/model/captures.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>

#include "trammel/model/input_filter.hpp"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr unsigned kUnits = TRAMMEL_CAPTURES;
constexpr bool kQueue = TRAMMEL_QUEUE != 0;
constexpr std::uint64_t kComparedSignals = 4;  // plus one more in each clock without a reset

class Bench {
 public:
  using Inputs = model::Captures::Inputs;

  explicit Bench(std::uint64_t seed) : check_("captures", seed) { reset(); }

  void reset() {
    check_.event("reset");
    drive({});
    dut_->rst_i = 1;
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::Captures(kUnits);
    compare({});
  }

  // The combinational outputs must be equal in the clock itself, too.
  void clock(const Inputs& in) {
    if (in.setting.set) check_.event("setting", std::uint64_t{in.setting.address} << 32 | in.setting.data);
    drive(in);
    dut_->eval();
    check_.compare("ask", get(dut_->capture_o, bus::capture::kAsk), model_.asks(in));
    ++clocks_;
    dut_.clock();
    model_.clock(in);
    compare(in);
    const std::uint32_t now = model_.word();
    const std::uint32_t rises = now & ~word_;
    valid_ += (rises & field::kCaptureStateValid) != 0 ? 1U : 0U;
    overruns_ += (rises & field::kCaptureStateOverrun) != 0 ? 1U : 0U;
    touches_ += (rises & field::kCaptureStatePending) != 0 ? 1U : 0U;
    queued_ += in.queued != 0 && !in.full ? 1U : 0U;
    word_ = now;
  }

  std::uint8_t asks(const Inputs& in) const { return model_.asks(in); }
  std::uint8_t passed() const { return model_.passed(); }
  const Checker& check() const { return check_; }
  std::uint64_t expected() const { return kComparedSignals * check_.cycles() + clocks_; }
  std::uint64_t valid() const { return valid_; }
  std::uint64_t overruns() const { return overruns_; }
  std::uint64_t touches() const { return touches_; }
  std::uint64_t queued() const { return queued_; }

 private:
  void drive(const Inputs& in) {
    put_inputs(dut_->inputs_i, in.levels, in.raw, in.quiet);
    dut_->setting_i = wire(in.setting);
    namespace answer = bus::capture_answer;
    dut_->answer_i = static_cast<SData>(in_place(answer::kCaptured, in.captured) |
                                        in_place(answer::kQueued, in.queued) | in_place(answer::kFull, in.full));
  }
  void compare(const Inputs& in) {
    check_.next_cycle();
    namespace capture = bus::capture;
    const std::uint64_t passed = model_.passed();
    check_.compare("ask", get(dut_->capture_o, capture::kAsk), model_.asks(in));
    check_.compare("state", get(dut_->capture_o, capture::kState), model_.word());
    check_.compare("passed", get(dut_->capture_o, capture::kPassed), passed);
    check_.compare("edge", get(dut_->capture_o, capture::kEdge) & passed, model_.edges() & passed);
  }

  Simulated<Vdut> dut_;
  model::Captures model_{kUnits};
  Checker check_;
  std::uint32_t word_ = 0;
  std::uint64_t clocks_ = 0;
  std::uint64_t valid_ = 0, overruns_ = 0, touches_ = 0, queued_ = 0;
};

// Selects one of the first inputs, so that units often share one.
model::Setting random_setting(Dice& dice, unsigned inputs) {
  if (dice.chance(2)) return {true, reg::kCaptureClear, dice.below(16)};
  const std::uint32_t edges = dice.chance(8) ? 0 : (1 + dice.below(3)) << 8;
  const std::uint32_t continuous = dice.chance(3) ? 0 : field::kCaptureSelectContinuous;
  const std::uint32_t queue = !kQueue || dice.chance(2) ? 0 : field::kCaptureSelectQueue;
  return {true, reg::capture_select(dice.below(4)), dice.below(inputs) | edges | continuous | queue};
}

// One unit that hands on a capture is told, the lowest or another one, now or later.
void answer_queue(Dice& dice, Bench::Inputs& in, unsigned passed) {
  in.queued = 0;
  in.full = dice.chance(4);
  if (dice.chance(3)) return;
  const unsigned lowest = passed & (0U - passed);
  in.queued = static_cast<std::uint8_t>(dice.chance(2) ? lowest : passed & 1U << dice.below(4));
}

// Levels, quiet and snapshots in any order, including combinations that no filter gives.
void any_levels() {
  const std::uint64_t seed = seed_from_environment(20261127);
  Bench bench(seed);
  Dice dice(seed);
  const std::uint64_t length = scaled(600'000);
  Bench::Inputs in;
  for (std::uint64_t i = 0; i < length; ++i) {
    if (dice.chance(3)) in.raw ^= dice.draw() & dice.draw();
    if (dice.chance(4)) in.levels ^= (in.raw ^ in.levels) & dice.draw();
    if (dice.chance(3)) in.quiet = dice.draw();
    // Address and data without `set` must have no effect.
    in.setting = dice.chance(20) ? random_setting(dice, 32) : model::Setting{};
    in.setting.set = in.setting.set && dice.chance(3);
    // Units are told only if they have asked in this clock.
    in.captured = static_cast<std::uint8_t>(dice.chance(4) ? bench.asks(in) & dice.draw() : 0);
    answer_queue(dice, in, bench.passed());
    bench.clock(in);
    if (dice.chance(30'000)) bench.reset();
  }
  EXPECT_GT(bench.valid(), length / 400);
  EXPECT_GT(bench.overruns(), length / 2000);
  EXPECT_GT(bench.touches(), bench.valid());
  EXPECT_GE(bench.queued(), kQueue ? length / 400 : 0);
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
}

// Inputs that are constant and then bounce; every other one has a filter. The writer takes one snapshot after
// another.
void bouncing_inputs() {
  constexpr unsigned kInputs = 6;
  const std::uint64_t seed = seed_from_environment(20261128);
  Bench bench(seed);
  Dice dice(seed);
  model::InputFilter filter(true);
  for (unsigned i = 0; i < model::InputFilter::kScanClocks; ++i) filter.clock({});
  for (unsigned n = 0; n < kInputs; ++n) filter.clock({0, true, n, static_cast<std::uint16_t>(n)});
  const std::uint32_t with_filter = 0x2A;
  std::array<std::uint64_t, kInputs> left{};
  unsigned writing = 0;
  const std::uint64_t length = scaled(600'000);
  Bench::Inputs in;
  for (std::uint64_t i = 0; i < length; ++i) {
    for (unsigned n = 0; n < kInputs; ++n) {
      if (left[n]-- != 0) continue;
      in.raw ^= std::uint32_t{1} << n;
      left[n] = dice.chance(3) ? dice.below(800) : dice.below(dice.chance(2) ? 8 : 100);
    }
    in.levels = (filter.levels() & with_filter) | (in.raw & ~with_filter);
    in.quiet = filter.quiet() | ~with_filter;
    in.setting = dice.chance(150) ? random_setting(dice, kInputs) : model::Setting{};
    const unsigned asks = bench.asks(in);
    if (writing == 0 && asks != 0) writing = 12 + dice.below(dice.chance(4) ? 100 : 8);
    in.captured = 0;
    if (writing != 0 && --writing == 0) in.captured = static_cast<std::uint8_t>(asks & (0U - asks));
    answer_queue(dice, in, bench.passed());
    bench.clock(in);
    filter.clock({in.raw});
  }
  EXPECT_GT(bench.valid(), length / 2000);
  EXPECT_GT(bench.overruns(), length / 10'000);
  EXPECT_GT(bench.touches(), 2 * bench.valid());
  EXPECT_GE(bench.queued(), kQueue ? length / 2000 : 0);
}

TEST(Captures, AnyLevels) { EXPECT_EQ(judge(any_levels), ""); }
TEST(Captures, BouncingInputs) { EXPECT_EQ(judge(bouncing_inputs), ""); }

}  // namespace
}  // namespace trammel::lockstep
