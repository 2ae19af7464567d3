// Lockstep of the counters with their closed forms: the next tick is the last one if one is left, for any count and
// at its word boundaries; three clocks after a tick the number of ticks left is correct; the zero flag is that of the
// chain; commands begun are counted, and are 0 after a cut.
#include <Vdut.h>
#include <gtest/gtest.h>

#include "counters_inside.hpp"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

constexpr std::uint64_t kCountMask = (std::uint64_t{1} << 40) - 1;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("counters", seed), dice_(seed) { reset(); }

  void reset() {
    check_.event("reset");
    dut_->rst_i = 1;
    drive();
    dut_->cut_i = dice_.chance(2);
    dut_->take_i = 0;
    dut_.clock();
    dut_->rst_i = 0;
    left_ = 0;
    begun_ = 0;
    snapshot_ = {};
    compare();
  }

  // Shifts a count in while the previous one still runs.
  void load(std::uint64_t count, unsigned take_of_16) {
    check_.event("count", count);
    for (unsigned i = 0; i < 3; ++i) {
      dut_->load_i = 1;
      dut_->word_i = static_cast<SData>(count >> (16 * i) | (i == 2 ? dice_.draw() << 8 : 0));
      settled_ = 0;
      clock(take_of_16, false);
    }
    dut_->load_i = 0;
    next_ = count & kCountMask;
    for (int i = 0; i < 3; ++i) clock(take_of_16, false);
  }

  // Takes the count loaded last; a tick in the same clock still belongs to the previous one. Then runs up to `clocks`
  // clocks.
  void begin(unsigned take_of_16, std::uint64_t clocks) {
    check_.event("swap");
    clock(take_of_16, true);
    for (std::uint64_t i = 0; i < clocks && left_ != 0; ++i) clock(take_of_16, false);
  }

  // Ticks until none is left.
  void finish(unsigned take_of_16) {
    while (left_ != 0) clock(take_of_16, false);
  }

  // Sets a count of 2^bit, bit 5 to 39, with all fast bits set, and runs the ticks that make it borrow from that bit.
  void borrow_from(unsigned bit) {
    load(kCountMask, 0);
    begin(0, 4);
    left_ = std::uint64_t{1} << bit | 0xF;
    set_slow_count(*dut_, left_ >> 4);
    for (unsigned i = 0; i < 20; ++i) clock(16, false);
    for (unsigned i = 0; i < 4; ++i) clock(0, false);
    check_.compare("slow bits of the count", slow_count(*dut_), left_ >> 4);
    ++expected_;
  }

  Checker& check() { return check_; }
  Dice& dice() { return dice_; }
  std::uint64_t comparisons() const { return expected_; }
  std::uint64_t lasts() const { return lasts_; }

 private:
  void drive() {
    dut_->cut_i = dice_.chance(100);
    dut_->begin_i = dice_.chance(3);
    const bool ahead = dice_.chance(50);
    if (ahead) begun_ = dut_->begun_o = static_cast<IData>(dice_.before_carry(32));  // the register itself
    dut_->snapshot_i = dice_.snapshot();
    // In a mutated block Verilator keeps a copy of the register for the snapshot, which is updated at the next edge.
    if (ahead) dut_->snapshot_i &= ~in_place(bus::snapshot::kStrobe, 1);
  }

  void clock(unsigned take_of_16, bool swap) {
    const bool take = left_ != 0 && dice_.below(16) < take_of_16;
    dut_->take_i = take;
    dut_->swap_i = swap;
    drive();
    snapshot_.clock(dut_->snapshot_i, begun_);
    begun_ = dut_->cut_i != 0 ? 0 : begun_ + dut_->begin_i;
    still_ = take || swap ? 0 : still_ + 1;
    if (take) --left_;
    if (swap) left_ = next_;
    if (settled_ < 3) ++settled_;
    dut_.clock();
    compare();
    lasts_ += left_ == 1 ? 1U : 0U;
  }

  void compare() {
    check_.next_cycle();
    check_.compare("last_o", dut_->last_o, left_ == 1);
    check_.compare("begun_o", dut_->begun_o, begun_);
    expected_ += 2;
    if (still_ >= 3 && left_ != 0) {
      check_.compare("left_o", dut_->left_o, left_);
      ++expected_;
    }
    if (snapshot_.known()) {
      check_.compare("snapshot_o, word", get(dut_->snapshot_o, bus::snapshot::kWord), snapshot_.word());
      ++expected_;
    }
    if (settled_ < 3 || dut_->load_i != 0) return;
    check_.compare("zero_o", dut_->zero_o, next_ == 0);
    check_.compare("count_o", dut_->count_o, next_);
    expected_ += 2;
  }

  Simulated<Vdut> dut_;
  Checker check_;
  Dice dice_;
  SnapshotWord snapshot_;
  std::uint64_t next_ = 0;
  std::uint64_t left_ = 0;
  std::uint32_t begun_ = 0;
  std::uint64_t still_ = 0;  // clocks without a tick or a swap
  unsigned settled_ = 0;     // clocks since the chain's last halfword, up to 3
  std::uint64_t expected_ = 0;
  std::uint64_t lasts_ = 0;
};

// Every count around each boundary of the counter's parts and of the chain's halfwords, with a tick in every clock to
// the end.
void boundaries() {
  Bench bench(1);
  std::uint64_t paths = 0;
  const auto run = [&](std::uint64_t count) {
    bench.load(count, 16);
    bench.finish(16);
    bench.begin(16, 0);
    bench.finish(16);
    ++paths;
  };
  for (std::uint64_t count = 1; count <= 600; ++count) run(count);
  for (const unsigned bit : {10U, 12U, 16U, 17U}) {
    for (std::uint64_t count = (1U << bit) - 2; count <= (1U << bit) + 18; ++count) run(count);
  }
  for (const unsigned beside : {0U, 1U, 15U, 16U}) run((1U << 20) + beside);
  // Two rounds of the upper part, with all borrows in between.
  run((std::uint64_t{2} << 20) + 0x10000);
  EXPECT_EQ(bench.lasts(), paths);
  EXPECT_EQ(bench.check().comparisons(), bench.comparisons());
  EXPECT_GT(bench.check().cycles(), 6U << 20U);
}

// Resets with one tick left, some with a cut in the same clock: a count can begin at once.
void resets() {
  Bench bench(seed_from_environment(20261121));
  const std::uint64_t paths = scaled(1000);
  for (std::uint64_t i = 0; i < paths; ++i) {
    bench.load(1, 16);
    bench.begin(0, 1);
    bench.reset();
  }
  EXPECT_GE(bench.lasts(), paths);
  EXPECT_EQ(bench.check().comparisons(), bench.comparisons());
}

// Counts whose end is far away: `last` stays low, and the next count begins before the end (a cut).
void random_counts() {
  Bench bench(seed_from_environment(20261118));
  Dice& dice = bench.dice();
  const std::uint64_t paths = scaled(10'000);
  for (std::uint64_t i = 0; i < paths; ++i) {
    const unsigned density = 1 + dice.below(16);
    std::uint64_t count = dice.log_uniform(dice.chance(2) ? 40 : 10);
    if (dice.chance(4)) count = std::uint64_t{1} << dice.below(40);
    if (dice.chance(4)) count |= std::uint64_t{1} << (20 + dice.below(20));
    bench.load(count, density);
    if (dice.chance(100)) bench.reset();
    bench.begin(density, dice.below(300));
  }
  EXPECT_EQ(bench.check().comparisons(), bench.comparisons());
  EXPECT_GT(bench.lasts(), paths / 10);
}

void borrows() {
  Bench bench(2);
  for (unsigned bit = 5; bit < 40; ++bit) bench.borrow_from(bit);
  EXPECT_EQ(bench.check().comparisons(), bench.comparisons());
}

TEST(Counters, Borrows) { EXPECT_EQ(judge(borrows), ""); }
TEST(Counters, Resets) { EXPECT_EQ(judge(resets), ""); }
TEST(Counters, RandomCounts) { EXPECT_EQ(judge(random_counts), ""); }
TEST(Counters, Boundaries) { EXPECT_EQ(judge(boundaries), ""); }

}  // namespace
}  // namespace trammel::lockstep
