// Lockstep of the direct loader: START with every corner value of the registers, busy and faults in every clock,
// resets of one clock in every state; every output in every cycle. The address is judged by the data that it brings.
#include "trammel/model/direct_loader.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include <array>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;

constexpr unsigned kAxes = TRAMMEL_AXES;
constexpr std::uint64_t kOnePulse = std::uint64_t{1} << 40;
constexpr std::uint64_t kComparedSignals = 3;

class Bench {
 public:
  explicit Bench(std::uint64_t seed, int state = state_seed())
      : dut_(state), check_("direct_loader", seed), dice_(seed), model_(kAxes) {
    reset();
  }

  std::uint32_t& at(std::uint32_t address) { return words_[address >> 2]; }

  // START with the present registers, until its answer, or until a reset `reset_after` clocks later.
  void start(std::uint32_t mask, unsigned reset_after = ~0U) {
    check_.event("START", mask);
    in_.mask = static_cast<std::uint8_t>(mask);
    in_.start = true;
    clock();
    in_.start = false;
    for (unsigned i = 1; !model_.outputs().done && i < reset_after; ++i) clock();
    if (!model_.outputs().done) return reset();
    ++answers_;
    moves_ += model_.outputs().go ? 1U : 0U;
  }

  void idle(unsigned clocks) {
    for (unsigned i = 0; i < clocks; ++i) clock();
  }

  // One clock.
  void reset() {
    check_.event("reset");
    in_.reset = true;
    clock();
    in_.reset = false;
  }

  // The average clocks between clocks of busy, and of a fault; 0: never.
  void surroundings(unsigned busy_every, unsigned closed_every) {
    busy_every_ = busy_every;
    closed_every_ = closed_every;
  }

  Checker& check() { return check_; }
  Dice& dice() { return dice_; }
  std::uint64_t answers() const { return answers_; }
  std::uint64_t moves() const { return moves_; }
  std::uint64_t expected() const { return kComparedSignals * check_.cycles() + more_; }

 private:
  struct Read {
    std::uint32_t fetched = 0;
    std::uint32_t data = 0;
  };

  void clock() {
    in_.busy = busy_every_ != 0 && dice_.chance(busy_every_);
    in_.closed = closed_every_ != 0 && dice_.chance(closed_every_);
    in_.data = model_read_.data;
    dut_->rst_i = in_.reset;
    dut_->busy_i = in_.busy;
    dut_->closed_i = in_.closed;
    using namespace bus::start;
    dut_->start_i = in_place(kStart, in_.start) | in_place(kMask, in_.mask) | in_place(kData, rtl_read_.data);
    rtl_read_ = {words_[get(dut_->answer_o, bus::start_answer::kAddress)], rtl_read_.fetched};
    model_read_ = {words_[model_.outputs().address], model_read_.fetched};
    dut_.clock();
    model_.clock(in_);
    compare();
  }

  void compare() {
    check_.next_cycle();
    const auto& out = model_.outputs();
    using namespace bus::start_answer;
    const auto answer = [this](const bus::Field& field) { return get(dut_->answer_o, field); };
    check_.compare("done", answer(kDone), out.done);
    check_.compare("go_o", dut_->go_o, out.go);
    check_.compare("load_o, valid", get(dut_->load_o, bus::load_bus::kValid), out.load.valid);
    if (out.done) more("error", answer(kError), out.error);
    if (out.done && out.error) more("reason", answer(kReason), out.reason);
    if (out.go) more("mask_o", dut_->mask_o, out.mask);
    if (out.load.valid) more("load_o", dut_->load_o, load_wire(out.load));
  }

  void more(const char* signal, std::uint64_t rtl, std::uint64_t model) {
    check_.compare(signal, rtl, model);
    ++more_;
  }

  Simulated<Vdut> dut_;
  Checker check_;
  Dice dice_;
  model::DirectLoader model_;
  model::DirectLoader::Inputs in_;
  std::array<std::uint32_t, card_map::kWindowBytes / 4> words_{};
  Read rtl_read_;
  Read model_read_;
  unsigned busy_every_ = 0;
  unsigned closed_every_ = 0;
  std::uint64_t answers_ = 0;
  std::uint64_t moves_ = 0;
  std::uint64_t more_ = 0;
};

void set_axis(Bench& bench, unsigned axis, std::uint64_t frequency, std::uint32_t count, std::uint32_t direction) {
  bench.at(reg::frequency_lo(axis)) = static_cast<std::uint32_t>(frequency);
  bench.at(reg::frequency_hi(axis)) = static_cast<std::uint32_t>(frequency >> 32);
  bench.at(reg::count(axis)) = count;
  bench.at(reg::direction(axis)) = direction;
}

void set_length(Bench& bench, std::uint64_t length) {
  bench.at(reg::kLengthLo) = static_cast<std::uint32_t>(length);
  bench.at(reg::kLengthHi) = static_cast<std::uint32_t>(length >> 32);
}

// Every mask; then every pair of corner frequency and count, in both directions, on every axis; every corner length.
void every_odd_value() {
  Bench bench(1);
  constexpr std::uint64_t kFrequencies[] = {0,
                                            1,
                                            0xFFFF,
                                            0x10000,
                                            0xFFFF'FFFF,
                                            std::uint64_t{1} << 32,
                                            kOnePulse - 1,
                                            kOnePulse,
                                            kOnePulse + 1,
                                            kOnePulse + 0x10000,
                                            kOnePulse + (std::uint64_t{1} << 32),
                                            0x1FF'FFFF'FFFF};
  constexpr std::uint32_t kCounts[] = {0, 1, 0xFFFF, 0x10000, 0xFFFF'FFFF};
  constexpr std::uint64_t kLengths[] = {0, 1, 0xFFFF, 0x10000, std::uint64_t{1} << 32, 0xFF'FFFF'FFFF};
  std::uint64_t starts = 0;
  for (unsigned axis = 0; axis < 8; ++axis) set_axis(bench, axis, 1000 + axis, 5, axis & 1);
  set_length(bench, 100);
  for (unsigned mask = 0; mask < 256; ++mask, ++starts) bench.start(mask);
  for (unsigned axis = 0; axis < kAxes; ++axis) {
    for (const std::uint64_t frequency : kFrequencies) {
      for (const std::uint32_t count : kCounts) {
        for (const std::uint32_t direction : {0U, 1U}) {
          set_axis(bench, axis, frequency, count, direction);
          bench.start(1U << axis);
          bench.start((1U << kAxes) - 1);
          starts += 2;
        }
      }
    }
    set_axis(bench, axis, 7, 5, 0);
  }
  for (const std::uint64_t length : kLengths) {
    set_length(bench, length);
    bench.start(1);
    ++starts;
  }
  EXPECT_EQ(bench.answers(), starts);
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
}

void random_starts() {
  Bench bench(seed_from_environment(20261114));
  Dice& dice = bench.dice();
  const std::uint64_t starts = scaled(4000);
  for (std::uint64_t i = 0; i < starts; ++i) {
    bench.surroundings(dice.chance(2) ? 0 : 2 + dice.below(60), dice.chance(2) ? 0 : 2 + dice.below(200));
    for (unsigned axis = 0; axis < 8; ++axis) {
      std::uint64_t frequency = dice.log_uniform(41) % (kOnePulse + 1);
      if (dice.chance(30)) frequency = kOnePulse + dice.below(2) * (std::uint64_t{1} << dice.below(40));
      set_axis(bench, axis, frequency, static_cast<std::uint32_t>(dice.log_uniform(32)), dice.below(2));
    }
    set_length(bench, dice.chance(20) ? 0 : dice.log_uniform(40));
    bench.idle(dice.below(3));
    bench.start(dice.chance(8) ? dice.below(256) : 1 + dice.below((1U << kAxes) - 1),
                dice.chance(8) ? 1 + dice.below(150) : ~0U);
  }
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
  EXPECT_GT(bench.answers(), starts / 2);
  EXPECT_GT(bench.moves(), starts / 20);
}

// A reset in every clock of a START whose values are refused: nothing remains for the next START, which moves.
void every_reset() {
  Bench bench(1);
  constexpr unsigned kLongest = 33 + 16 * kAxes;
  constexpr std::uint32_t kAll = (1U << kAxes) - 1;
  set_length(bench, 100);
  for (unsigned after = 1; after < kLongest; ++after) {
    for (unsigned axis = 0; axis < kAxes; ++axis) set_axis(bench, axis, kOnePulse + 0xFFFF'FFFF, 5, 1);
    bench.start(kAll, after);
    for (unsigned axis = 0; axis < kAxes; ++axis) set_axis(bench, axis, 1000, 5, 0);
    bench.idle(after % 3);
    bench.start(kAll);
  }
  EXPECT_EQ(bench.answers(), kLongest - 1);
  EXPECT_EQ(bench.moves(), kLongest - 1);
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
}

// For any initial register contents, one clock of reset leaves nothing under way.
void power_ups() {
  for (int state = 1; state <= 300; ++state) {
    Bench bench(1, state);
    bench.idle(3);
  }
}

TEST(DirectLoader, PowerUps) { EXPECT_EQ(judge(power_ups), ""); }
TEST(DirectLoader, EveryReset) { EXPECT_EQ(judge(every_reset), ""); }
TEST(DirectLoader, EveryOddValue) { EXPECT_EQ(judge(every_odd_value), ""); }
TEST(DirectLoader, RandomStarts) { EXPECT_EQ(judge(random_starts), ""); }

}  // namespace
}  // namespace trammel::lockstep
