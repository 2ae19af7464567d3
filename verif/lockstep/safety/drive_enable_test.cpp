// Lockstep of the sequence of enable and brake: every start, stop, order, fault and emergency stop at each clock of
// the sequence, and random ones; every output in every cycle. Forbidden states are checked independently of the
// model.
#include "trammel/model/drive_enable.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include <array>
#include <iterator>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;

constexpr unsigned kAxes = TRAMMEL_AXES;
constexpr std::uint32_t kAllAxes = (1U << kAxes) - 1;
constexpr unsigned kDelayBits = 2;  // as built
constexpr unsigned kIdleBits = 4;
constexpr std::uint64_t kComparedSignals = 4;  // plus one more in each clock without a reset

class Bench {
 public:
  using Inputs = model::DriveEnable::Inputs;
  using Stage = model::DriveEnable::Stage;

  explicit Bench(std::uint64_t seed) : check_("drive_enable", seed) { reset({}); }

  void reset(const Inputs& in) {
    check_.event("reset");
    dut_->rst_i = 1;
    apply(in);
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::DriveEnable(kAxes, kDelayBits, kIdleBits);
    compare(in);
  }

  void clock(const Inputs& in) {
    if (in.setting.set) check_.event("setting", std::uint64_t{in.setting.address} << 32 | in.setting.data);
    if (in.emergency) check_.event("emergency stop");
    if (in.fault != 0) check_.event("fault", in.fault);
    const bool was = model_.enabled();
    const bool wanted = in.moves || model_.state().on;
    apply(in);
    dut_->eval();  // combinational outputs, before the edge
    check_.compare("disabled_o", dut_->disabled_o, model_.disables(in));
    dut_.clock();
    model_.clock(in);
    compare(in);
    ++clocks_;
    ++stages_[static_cast<unsigned>(model_.state().stage)];
    enabled_ += model_.enabled() && !was ? 1U : 0U;
    by_nobody_ += model_.enabled() && !was && !wanted ? 1U : 0U;
  }

  void set(std::uint32_t address, std::uint32_t data) {
    Inputs in;
    in.setting = {true, address, data};
    clock(in);
  }

  const model::DriveEnable& model() const { return model_; }
  Checker& check() { return check_; }
  std::uint64_t expected() const { return kComparedSignals * check_.cycles() + clocks_; }
  std::uint64_t enabled() const { return enabled_; }
  std::uint64_t by_nobody() const { return by_nobody_; }
  std::uint64_t stage(Stage stage) const { return stages_[static_cast<unsigned>(stage)]; }

 private:
  void apply(const Inputs& in) {
    dut_->setting_i = wire(in.setting);
    dut_->moves_i = in.moves;
    dut_->busy_i = in.busy;
    dut_->emergency_i = in.emergency;
    dut_->fault_i = in.fault;
  }

  void compare(const Inputs& in) {
    check_.next_cycle();
    check_.compare("enabled_o", dut_->enabled_o, model_.enabled());
    check_.compare("released_o", dut_->released_o, model_.released());
    check_.compare("wait_o", dut_->wait_o, model_.waits());
    check_.compare("waiting_o", dut_->waiting_o, model_.waits() && in.moves);
  }

  Simulated<Vdut> dut_;
  model::DriveEnable model_{kAxes, kDelayBits, kIdleBits};
  Checker check_;
  std::uint64_t clocks_ = 0;
  std::uint64_t enabled_ = 0;
  std::uint64_t by_nobody_ = 0;
  std::array<std::uint64_t, 6> stages_{};
};

void settings(Bench& bench, std::uint32_t idle) {
  bench.set(reg::kBrakeReleaseDelay, 1);
  bench.set(reg::kEnableDelay, 2);
  bench.set(reg::kStopDelay, 1);
  bench.set(reg::kBrakeSetDelay, 2);
  bench.set(reg::kEnableIdle, idle);
  bench.set(reg::kDisableCauses, card_map::field::kFaultWatchdog);
  bench.set(reg::kEnableAxes, kAllAxes & 0b101);
  bench.clock({});  // at rest it takes effect
}

// The event of one clock of a course, in addition to the motion.
Bench::Inputs happening(unsigned kind) {
  Bench::Inputs in;
  if (kind == 1) in.emergency = true;
  if (kind == 2) in.fault = card_map::field::kFaultWatchdog;
  if (kind == 3) in.fault = card_map::field::kFaultLimit;
  if (kind == 4) in.setting = {true, reg::kEnable, card_map::field::kEnableOn};
  if (kind == 5) in.setting = {true, reg::kEnable, card_map::field::kEnableManual};
  if (kind == 6) in.setting = {true, reg::kEnableAxes, 0};
  if (kind == 7) in.setting = {true, reg::kStopDelay, 0};
  return in;
}

// Motion of 12 clocks that begins at once; an event of one clock, or to the end, at each clock of the course.
void every_moment() {
  Bench bench(0);
  constexpr unsigned kClocks = 90;
  for (const std::uint32_t idle : {0U, 1U}) {
    for (unsigned kind = 0; kind < 8; ++kind) {
      for (unsigned at = 0; at < kClocks; ++at) {
        for (const bool lasts : {false, true}) {
          bench.reset({});
          settings(bench, idle);
          unsigned moved = 0;
          for (unsigned i = 0; i < kClocks; ++i) {
            Bench::Inputs in;
            if (i == at || (lasts && i > at)) in = happening(kind);
            in.moves = moved < 12;
            in.busy = moved < 14;
            if (!bench.model().waits() || moved >= 12) ++moved;
            bench.clock(in);
          }
        }
      }
    }
  }
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
  EXPECT_EQ(bench.by_nobody(), 0U);
  for (unsigned stage = 0; stage < 6; ++stage) EXPECT_GT(bench.stage(static_cast<Bench::Stage>(stage)), 1000U) << stage;
}

void random_courses() {
  const std::uint64_t seed = seed_from_environment(41);
  Bench bench(seed);
  Dice dice(seed);
  const std::uint64_t length = scaled(400'000);
  bool moves = false;
  bool busy = false;
  std::uint32_t fault = 0;
  unsigned calm = 1;
  for (std::uint64_t i = 0; i < length; ++i) {
    if (i % 1024 == 0) calm = 1 + dice.below(40);
    Bench::Inputs in;
    if (dice.chance(4 * calm)) moves = !moves;
    if (dice.chance(3 * calm)) busy = !busy;
    if (dice.chance(fault != 0 ? 10 : 30 * calm)) fault = fault != 0 ? 0 : dice.draw() & 0x7FFFF;
    in.moves = moves;
    in.busy = busy;
    in.fault = fault;
    in.emergency = dice.chance(60 * calm);
    if (dice.chance(5 * calm)) {
      constexpr std::uint32_t kPlaces[] = {reg::kEnable,        reg::kEnable,        reg::kEnableAxes,
                                           reg::kEnableAxes,    reg::kEnableDelay,   reg::kBrakeReleaseDelay,
                                           reg::kStopDelay,     reg::kBrakeSetDelay, reg::kEnableIdle,
                                           reg::kDisableCauses, reg::kOutputRoles,   reg::kHealthCauses};
      const std::uint32_t address = kPlaces[dice.below(std::size(kPlaces))];
      const std::uint32_t data = address == reg::kDisableCauses ? dice.draw() & dice.draw() & 0x7FFFF
                                 : address == reg::kEnable      ? dice.below(4)
                                 : address == reg::kEnableAxes  ? (dice.chance(4) ? 0 : dice.draw() & 0xFF)
                                 : dice.chance(40)              ? dice.draw() & 0xFFFF
                                                                : dice.below(4);
      in.setting = {!dice.chance(4), address, data};
    }
    if (dice.chance(2000))
      bench.reset(in);
    else
      bench.clock(in);
  }
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
  EXPECT_EQ(bench.check().cycles(), length + 1);
  EXPECT_EQ(bench.by_nobody(), 0U);
  EXPECT_GT(bench.enabled(), length / 2000);
}

TEST(DriveEnable, EveryMoment) { EXPECT_EQ(judge(every_moment), ""); }
TEST(DriveEnable, RandomCourses) { EXPECT_EQ(judge(random_courses), ""); }

}  // namespace
}  // namespace trammel::lockstep
