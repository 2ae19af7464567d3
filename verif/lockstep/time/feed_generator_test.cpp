// Lockstep of the feed generator: RTL and model, every output in every cycle.
#include "trammel/model/feed_generator.hpp"

#include <gtest/gtest.h>

#include <random>

#include "Vdut.h"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel {
namespace {

constexpr std::uint64_t kComparedSignals = 2;
// Minimum clocks between two swaps, which the card guarantees except after a piece that began at rest.
constexpr std::uint64_t kSwapDistance = 24;

struct Piece {
  std::uint64_t rate;
  std::uint64_t acceleration;
  std::uint64_t jerk;
  std::uint32_t floor;
};

class Bench {
 public:
  Bench(std::uint64_t seed, unsigned enable_of_1024)
      : checker_("feed_generator", seed), dice_(seed), enable_of_1024_(enable_of_1024) {
    reset();
  }

  // One clock of reset, with random other inputs. Nothing is enabled from then to the next swap.
  void reset() {
    checker_.event("reset");
    model::FeedGenerator::Inputs in;
    in.swap = dice_.chance(2);
    in.enable = started_ && dice_.chance(2);
    started_ = frozen_ = false;
    dut_->rst_i = 1;
    apply(in);
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::FeedGenerator();
    snapshot_ = {};
    compare();
  }

  void clock(model::FeedGenerator::Inputs in) {
    in.clear = in.clear || resting_;
    in.enable = started_ && !in.clear && dice_.below(1024) < enable_of_1024_;
    started_ = started_ || in.swap;
    // A freeze lasts from a clock of a piece to the next swap.
    if (freeze_in_ != 0 && --freeze_in_ == 0) frozen_ = true;
    if (in.swap) frozen_ = false;
    in.freeze = frozen_;
    apply(in);
    const std::uint32_t rate = model_.outputs().rate;
    dut_.clock();
    model_.clock(in);
    const bool rest = trammel::bus::get(dut_->snapshot_i, trammel::bus::snapshot::kRest) != 0;
    snapshot_.clock(dut_->snapshot_i, rest ? dut_->left_i : rate);
    compare();
    ticks_ += model_.outputs().tick;
  }

  // Loads rate and floor (6 clocks), waits, swaps the piece in at least `clocks` after the last swap, and loads
  // acceleration and jerk; their last halfword comes 10 to 13 clocks after the swap.
  void piece(const Piece& p, std::uint64_t clocks, std::uint64_t late = 0) {
    using namespace model::feed_target;
    std::uint64_t used = since_swap_ + idle(3);
    used += shift(kRate, p.rate, 4) + shift(kFloor, p.floor, 2);
    idle(clocks > used + 1 ? clocks - used - 1 : 0);
    checker_.event("swap: rate", p.rate);
    checker_.event("  acceleration", p.acceleration);
    checker_.event("  jerk", p.jerk);
    checker_.event("  floor", p.floor);
    model::FeedGenerator::Inputs in;
    in.swap = true;
    clock(in);
    since_swap_ = idle(2 + late) + shift(kAcceleration, p.acceleration, 4) + shift(kJerk, p.jerk, 4);
  }

  // Like the first piece after a barrier: cleared all the time, and completely loaded before its swap.
  void piece_at_rest(const Piece& p, std::uint64_t rest) {
    using namespace model::feed_target;
    resting_ = true;
    idle(3 + rest);
    shift(kRate, p.rate, 4);
    shift(kFloor, p.floor, 2);
    idle(rest % 3);
    shift(kAcceleration, p.acceleration, 4);
    shift(kJerk, p.jerk, 4);
    idle(rest % 5);
    checker_.event("swap at rest: rate", p.rate);
    model::FeedGenerator::Inputs in;
    in.swap = true;
    clock(in);
    resting_ = false;
    since_swap_ = 0;
  }

  void freeze_in(std::uint64_t clocks) { freeze_in_ = clocks; }

  std::uint64_t idle(std::uint64_t clocks) {
    for (std::uint64_t i = 0; i < clocks; ++i) clock({});
    return clocks;
  }

  std::uint64_t ticks() const { return ticks_; }
  void wait(std::uint64_t clocks) { since_swap_ += idle(clocks); }

  void expect_all_compared() const {
    EXPECT_GT(checker_.cycles(), 0U);
    EXPECT_EQ(checker_.comparisons(), kComparedSignals * checker_.cycles() + chained_);
    EXPECT_GT(chained_, checker_.cycles() / 2);
  }

 private:
  void apply(const model::FeedGenerator::Inputs& in) {
    dut_->freeze_i = in.freeze;
    dut_->clear_i = in.clear;
    dut_->enable_i = in.enable;
    // Without its valid bit the bus carries random data.
    dut_->load_i =
        in.load.valid ? lockstep::feed_wire(in.load) : dice_.draw() >> (32 - trammel::bus::feed_load::kValid.offset);
    dut_->swap_i = in.swap;
    dut_->snapshot_i = dice_.snapshot();
    dut_->left_i = dice_.draw();
  }

  void compare() {
    checker_.next_cycle();
    checker_.compare("tick_o", dut_->tick_o, model_.outputs().tick);
    checker_.compare("rate_o", dut_->rate_o, model_.outputs().rate);
    if (!snapshot_.known()) return;
    checker_.compare("snapshot_o, word", get(dut_->snapshot_o, bus::snapshot::kWord), snapshot_.word());
    ++chained_;
  }

  std::uint64_t shift(unsigned target, std::uint64_t value, unsigned halfwords) {
    for (unsigned i = 0; i < halfwords; ++i) {
      model::FeedGenerator::Inputs in;
      in.load = lockstep::halfword(target, value, i);
      clock(in);
    }
    return halfwords;
  }

  lockstep::Checker checker_;
  lockstep::Simulated<Vdut> dut_;
  model::FeedGenerator model_;
  lockstep::SnapshotWord snapshot_;
  lockstep::Dice dice_;
  unsigned enable_of_1024_;
  bool started_ = false;
  bool frozen_ = false;
  std::uint64_t freeze_in_ = 0;   // clocks until a freeze; 0: none
  bool resting_ = false;          // no piece runs
  std::uint64_t since_swap_ = 0;  // clocks
  std::uint64_t ticks_ = 0;
  std::uint64_t chained_ = 0;
};

// Corner values of every field, at each distance from the shortest to more than two updates.
void directed() {
  constexpr std::uint64_t kMax = ~std::uint64_t{0};
  const Piece pieces[] = {
      {kMax, 0, 0, 1},                                 // a tick in every clock except one in 2^48
      {kMax, 1, 0, 1},                                 // reaches 1 exactly at the first update
      {kMax >> 1, std::uint64_t{1} << 62, 0, 1},       // above 1, and up to 8 and beyond
      {kMax, std::uint64_t{1} << 63, 0, 0xFFFF'FFFF},  // down through 0, floor just below 1
      {std::uint64_t{5} << 32, kMax, 0, 5},            // one below the floor at the first update
      {0x8000'0000'8000'0000, 0 - std::uint64_t{0x8001'0000}, 0, 0x7FFF'FFFF},  // low bits above its floor make ticks
      {std::uint64_t{5} << 32, 0, 0, 5},                                        // at the floor
      {0x7FFF'FFFF'FFFF'0000, 0, 0, 0x7FFF'FFFF},  // at the floor except for the low bits, which make the tick
      {0x8000'0000'1000'0000, kMax >> 1, 0, 1},    // to 1 with low bits that would miss a tick
      {1, 0, 0, 0x4000'0000},                      // starts below its floor: the first slope is used as given
      {std::uint64_t{1} << 60, 0xFFFF, kMax, 1},   // jerk alone reverses it
      {0, 0, (std::uint64_t{1} << 63) - 1, 1},
      {0x0123'4567'89AB'CDEF, 0xFEDC'BA98'7654'3211, 0x0000'0FED'CBA9'8765, 0x0765'4321},
  };
  Bench bench(1, 1024);
  for (std::uint64_t distance = kSwapDistance; distance <= 72; ++distance) {
    for (const Piece& p : pieces) bench.piece(p, distance);
  }
  for (const Piece& p : pieces) bench.piece(p, 2000);
  EXPECT_GT(bench.ticks(), 1000U);
  for (const Piece& p : pieces) {
    bench.piece_at_rest(p, 0);
    bench.wait(200);
  }
  // A reset in each clock after a swap, up to the first update: nothing on its way may arrive.
  for (std::uint64_t clocks = 0; clocks <= 40; ++clocks) {
    bench.piece_at_rest(pieces[clocks % std::size(pieces)], 0);
    bench.wait(clocks);
    bench.reset();
    bench.wait(8);
  }
  bench.expect_all_compared();
}

std::uint64_t log_uniform(std::mt19937_64& random) { return random() >> (random() % 64); }

Piece random_piece(std::mt19937_64& random) {
  Piece p{};
  p.rate = random() % 3 == 0 ? random() : log_uniform(random);
  p.acceleration = random() % 4 == 0 ? 0 : log_uniform(random);
  p.jerk = random() % 3 == 0 ? 0 : log_uniform(random);
  if (random() % 2 == 0) p.acceleration = 0 - p.acceleration;
  if (random() % 2 == 0) p.jerk = 0 - p.jerk;
  p.floor = static_cast<std::uint32_t>(random() >> 32 >> (random() % 32));
  // A floor next to the rate: the lowest bits decide the comparison.
  if (random() % 4 == 0) p.floor = static_cast<std::uint32_t>((p.rate >> 32) + random() % 3 - 1);
  return p;
}

// `enable_of_1024`: enabled clocks out of 1,024. `pieces` is scaled.
void random_pieces(unsigned enable_of_1024, std::uint64_t pieces) {
  const std::uint64_t seed = lockstep::seed_from_environment(enable_of_1024);
  std::mt19937_64 random(seed);
  Bench bench(seed, enable_of_1024);
  pieces = lockstep::scaled(pieces);
  for (std::uint64_t i = 0; i < pieces; ++i) {
    std::uint64_t distance = kSwapDistance + random() % 80;
    // One piece in 16 lasts for about 50 updates, also with rare enables.
    if (random() % 16 == 0) distance += random() % (1 + 3'000'000 / enable_of_1024);
    if (random() % 5 == 0) bench.piece_at_rest(random_piece(random), random() % 40);
    if (random() % 5 == 0) bench.freeze_in(1 + random() % distance);
    bench.piece(random_piece(random), distance, random() % 4);
    if (random() % 50 == 0) bench.reset();
  }
  EXPECT_GT(bench.ticks(), pieces);
  bench.expect_all_compared();
}

TEST(FeedGeneratorLockstep, DirectedAndRandom) {
  const std::string complaint = lockstep::judge([] {
    directed();
    random_pieces(1024, 12'000);
    random_pieces(1000, 4'000);
    random_pieces(512, 4'000);
    random_pieces(1, 300);
  });
  EXPECT_EQ(complaint, "");
}

}  // namespace
}  // namespace trammel
