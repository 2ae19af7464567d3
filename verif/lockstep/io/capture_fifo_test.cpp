// Lockstep of the queue of captures: snapshots written to the units' areas and to others, captures that pass alone
// and together, a host that reads, drops, drops twice or the wrong one, and is too slow; resets. Every output in
// every cycle.
#include "trammel/model/capture_fifo.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr std::uint64_t kComparedSignals = 4;
constexpr unsigned kUnits = 4;
constexpr unsigned kFilling = 16;  // clocks after a reset in which nothing passes

class Bench {
 public:
  using Inputs = model::CaptureFifo::Inputs;
  using Area = model::CaptureFifo::Area;

  explicit Bench(std::uint64_t seed) : check_("capture_fifo", seed) { reset(); }

  void reset() {
    check_.event("reset");
    drive({}, {}, 0);
    dut_->rst_i = 1;
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::CaptureFifo();
    read_.fill(0);
    since_reset_ = 0;
    compare({});
  }

  // `store`: the word of a snapshot that is written. The selected word of the oldest capture shows two clocks later.
  void clock(const Inputs& in, const model::Setting& store, unsigned word) {
    if (in.passed != 0) check_.event("passed", in.passed);
    drive(in, store, word);
    lost_ += in.passed != 0 && model_.full() ? 1U : 0U;
    const unsigned unit = model::CaptureFifo::unit_of(in.passed);
    read_ = {model_.oldest(word), read_[0]};
    dut_.clock();
    model_.clock(in, unit < kUnits ? areas_[unit].data() : nullptr);
    ++since_reset_;
    compare(in);
    const std::uint32_t captures = model_.word() & field::kCaptureQueueCaptures;
    full_ += captures == model::CaptureFifo::kCaptures ? 1U : 0U;
    empty_ += captures == 0 ? 1U : 0U;
  }

  const model::CaptureFifo& model() const { return model_; }
  Area& area(unsigned unit) { return areas_[unit]; }
  bool filled() const { return since_reset_ > kFilling; }
  const Checker& check() const { return check_; }
  std::uint64_t full() const { return full_; }
  std::uint64_t empty() const { return empty_; }
  std::uint64_t lost() const { return lost_; }

 private:
  void drive(const Inputs& in, const model::Setting& store, unsigned word) {
    dut_->setting_i = wire(in.setting);
    dut_->store_i = wire(store);
    dut_->passed_i = in.passed;
    dut_->active_i = in.edges;
    dut_->word_i = static_cast<CData>(word);
  }
  void compare(const Inputs& in) {
    check_.next_cycle();
    check_.compare("queued_o", dut_->queued_o, model::CaptureFifo::queued(in.passed));
    check_.compare("full_o", dut_->full_o, model_.full());
    check_.compare("state_o", dut_->state_o, model_.word());
    // A read requested before a reset has no defined answer.
    check_.compare("data_o", since_reset_ < 2 ? 0 : dut_->data_o, since_reset_ < 2 ? 0 : read_[1]);
  }

  Simulated<Vdut> dut_;
  model::CaptureFifo model_;
  Checker check_;
  std::array<Area, kUnits> areas_{};
  std::array<std::uint32_t, 2> read_{};
  std::uint64_t since_reset_ = 0, full_ = 0, empty_ = 0, lost_ = 0;
};

// Imitates the snapshot writer and the capture units: an area is written from its last word down, and then its
// capture passes, at once or later. Areas of other snapshots come in between.
class Units {
 public:
  explicit Units(Dice& dice) : dice_(dice) {}

  void reset() {
    left_ = 0;
    written_ = soon_ = passed_ = 0;
  }
  // The word that is written in this clock.
  model::Setting store(Bench& bench) {
    if (left_ == 0) {
      if (dice_.chance(6)) begin();
      // Address and data without `set` are not stored.
      return {false, static_cast<std::uint32_t>(card_map::Area::Capture0) + 4 * dice_.below(64), dice_.draw()};
    }
    --left_;
    const std::uint32_t value = dice_.draw();
    if (unit_ < kUnits) bench.area(unit_)[left_] = value;
    if (left_ == 0 && unit_ < kUnits) written_ |= 1U << unit_;
    return {true, address_ + 4 * left_, value};
  }
  // The units that hand on a capture; `told`: those told in the last clock.
  std::uint8_t passed(unsigned told) {
    passed_ &= ~told;
    const unsigned passes = dice_.chance(4) ? written_ : dice_.chance(30) ? written_ & dice_.draw() : 0;
    written_ &= ~passes;
    passed_ |= soon_;
    soon_ = passes;
    return static_cast<std::uint8_t>(passed_);
  }

 private:
  void begin() {
    using card_map::Area;
    constexpr Area kAreas[] = {Area::Capture0, Area::Capture1, Area::Capture2, Area::Capture3, Area::Snap,
                               Area::Stop,     Area::Probe,    Area::Mark,     Area::Rest};
    unit_ = dice_.below(dice_.chance(4) ? 9 : 4);
    if (unit_ < kUnits && ((written_ | soon_ | passed_) >> unit_ & 1) != 0) return;
    address_ = static_cast<std::uint32_t>(kAreas[unit_]);
    left_ = model::CaptureFifo::kWords;
  }

  Dice& dice_;
  unsigned left_ = 0;  // words left of the snapshot under way
  unsigned unit_ = 0;  // its unit; kUnits or more: an area of no unit
  std::uint32_t address_ = 0;
  unsigned written_ = 0;  // units whose snapshot is complete
  unsigned soon_ = 0;     // units that pass in the next clock: their last word is on its way
  unsigned passed_ = 0;
};

// Mostly the right number; sometimes other writes.
model::Setting drop(Dice& dice, std::uint32_t word) {
  const std::uint32_t oldest = word >> field::kCaptureQueueOldestShift & 0xF;
  if (dice.chance(6)) return {true, reg::kCaptureClear, oldest};
  const std::uint32_t number = dice.chance(5) ? dice.below(16) : oldest;
  return {true, reg::kCaptureNext, number | (dice.chance(9) ? 0x10 : 0)};
}

void captures_and_drops() {
  const std::uint64_t seed = seed_from_environment(20261129);
  Bench bench(seed);
  Dice dice(seed);
  Units units(dice);
  unsigned told = 0;
  unsigned drops_every = 8;  // clocks; at 100 the host is too slow
  const std::uint64_t length = scaled(600'000);
  for (std::uint64_t i = 0; i < length; ++i) {
    Bench::Inputs in;
    const model::Setting store = bench.filled() ? units.store(bench) : model::Setting{};
    if (bench.filled()) in.passed = units.passed(told);
    told = model::CaptureFifo::queued(in.passed);
    in.edges = static_cast<std::uint8_t>(dice.draw());
    if (dice.chance(4000)) drops_every = dice.chance(2) ? 8 : 100;
    if (dice.chance(drops_every)) in.setting = drop(dice, bench.model().word());
    bench.clock(in, store, dice.below(16));
    if (dice.chance(20'000)) {
      bench.reset();
      units.reset();
      told = 0;
    }
  }
  EXPECT_GT(bench.full(), length / 10);
  EXPECT_GT(bench.empty(), length / 10);
  EXPECT_GT(bench.lost(), length / 500);
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * bench.check().cycles());
}

TEST(CaptureFifo, CapturesAndDrops) { EXPECT_EQ(judge(captures_and_drops), ""); }

}  // namespace
}  // namespace trammel::lockstep
