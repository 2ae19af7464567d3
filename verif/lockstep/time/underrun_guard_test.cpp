// Lockstep of the under-run hold: commands arrive; pieces are decoded, begin and take ticks at any clock; stop
// distances and ratios of every size, cuts and resets; every output in every cycle.
#include "trammel/model/underrun_guard.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include <vector>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

constexpr std::uint64_t kComparedSignals = 4;
constexpr bool kProbing = TRAMMEL_PROBING != 0;  // otherwise nothing is ever lost
// Minimum clocks that the rest of the card keeps: from a commit to the next command's count, from a swap to the next
// piece's stop distance, from a swap to the next swap.
constexpr unsigned kAfterCommit = 13;
constexpr unsigned kAfterSwap = 14;
constexpr unsigned kSwaps = 24;

class Bench {
 public:
  using Inputs = model::UnderrunGuard::Inputs;

  explicit Bench(std::uint64_t seed) : check_("underrun_guard", seed), dice_(seed) { reset(); }

  void random_clock() {
    if (dice_.chance(5000)) random_pace();
    in_.cut = dice_.chance(cut_every_);
    in_.lost = kProbing && dice_.chance(1500);
    in_.idle = dice_.chance(20);
    if (dice_.chance(in_.gone ? 200 : 3000)) in_.gone = !in_.gone;
    if (dice_.chance(400)) in_.full = dice_.chance(3);
    if (dice_.chance(2000)) underruns_near_a_carry();
    random_ratio();
    random_arrival();
    random_piece();
    if (dice_.chance(50 * cut_every_))
      reset();
    else
      clock();
  }

  // A piece that ends at rest, with nothing queued, is cut. The next one, which does not end at rest, begins `later`
  // clocks after it.
  void ending_piece_is_cut(unsigned later) {
    reset();
    in_ = {};
    in_.ratio = 0x10000;
    begin_piece(0);
    for (unsigned i = 0; i < 70; ++i) clock();
    in_.cut = true;
    clock();
    in_.cut = false;
    for (unsigned i = 0; i < later; ++i) clock();
    begin_piece(1000);
    for (unsigned i = 0; i < 70; ++i) clock();
    in_.cut = true;
    clock();
    in_ = {};
  }

  // A reset after queued commands were lost; then a piece that waits for more.
  void reset_while_lost() {
    reset();
    in_ = {};
    in_.ratio = 0x10000;
    in_.lost = kProbing;
    clock();
    in_.lost = false;
    for (unsigned i = 0; i < 4; ++i) clock();
    reset();
    load_distance(1000);
    in_.decoded = true;
    for (unsigned i = 0; i < 70; ++i) clock();
    in_ = {};
  }

  Checker& check() { return check_; }
  std::uint64_t holds() const { return holds_; }
  std::uint64_t ends() const { return ends_; }
  std::uint64_t waits() const { return waits_; }
  std::uint64_t lost() const { return lost_; }

 private:
  void load_distance(std::uint32_t distance) {
    for (unsigned i = 0; i < 2; ++i) {
      in_.load = halfword(model::feed_target::kStopDistance, distance, i);
      clock();
    }
    in_.load = {};
  }

  // Loads the stop distance of a piece, which then begins from rest.
  void begin_piece(std::uint32_t distance) {
    load_distance(distance);
    for (unsigned i = 0; i < 2; ++i) clock();
    in_.active = in_.swap = true;
    clock();
    in_.swap = false;
  }

  // The port is the register itself.
  void underruns_near_a_carry() {
    dut_->underruns_o = static_cast<IData>(dice_.before_carry(32));
    underruns_ahead_ = dut_->underruns_o - model_.outputs().underruns;
  }

  void random_pace() {
    cut_every_ = dice_.chance(3) ? 100 + dice_.below(300) : 5000;
    take_every_ = 1 + dice_.below(dice_.chance(2) ? 2 : 30);
    count_bits_ = dice_.chance(4) ? 40 : 6 + dice_.below(8);
    distance_bits_ = dice_.chance(4) ? 32 : 4 + dice_.below(10);
    zero_every_ = 1 + dice_.below(12);
    arrive_every_ = 1 + dice_.below(dice_.chance(2) ? 2 : 100);
    near_ = dice_.chance(3);
    if (near_) take_every_ = 10 + dice_.below(90);
  }

  void random_ratio() {
    if (!dice_.chance(8)) return;
    if (dice_.chance(20)) in_.ratio = dice_.chance(2) ? 0 : 0x10000;
    if (dice_.chance(20)) in_.ratio = (dice_.below(256) << 8) + dice_.below(2);
    const std::uint32_t step = dice_.below(0x800);
    if (model_.outputs().hold)
      in_.ratio = in_.ratio > step ? in_.ratio - step : 0;
    else
      in_.ratio = in_.ratio + step > 0x10000 ? 0x10000 : in_.ratio + step;
  }

  // Commands arrive halfword by halfword; sometimes a refusal drops one before its end.
  void random_arrival() {
    in_.arrival = {};
    ++since_commit_;
    if (left_.empty() && !committing_) {
      if (since_commit_ < kAfterCommit || !dice_.chance(arrive_every_)) return;
      random_command();
    }
    if (dice_.chance(2)) return;
    if (dice_.chance(200)) {
      in_.arrival.drop = true;
      left_.clear();
      committing_ = false;
      since_commit_ = 0;
    } else if (!left_.empty()) {
      in_.arrival.halfword = left_.back();
      in_.arrival.geometry_write = to_geometry_;
      in_.arrival.feed_write = to_feed_;
      left_.pop_back();
    } else {
      in_.arrival.geometry_commit = to_geometry_;
      in_.arrival.feed_commit = to_feed_;
      committing_ = false;
      since_commit_ = 0;
    }
  }
  void random_command() {
    const unsigned kind = dice_.below(10);
    to_geometry_ = kind < 6;
    to_feed_ = kind > 4;
    std::uint64_t count = dice_.log_uniform(count_bits_);
    if (dice_.chance(20) && count_bits_ == 40) count = std::uint64_t{1} << 32;
    // Close to the limit at which the queues are short.
    const std::uint64_t queued = (to_geometry_ ? paths_ : pieces_) - taken_;
    const std::uint64_t limit = card_map::constant::kUnderrunReserveTicks + dice_.below(4);
    if (near_ && queued < limit) count = limit - queued;
    if (kind < 5) paths_ += count;
    if (kind > 5) pieces_ += count;
    const std::uint32_t distance = random_distance();
    const std::size_t halfwords = kind == 5 ? 4 : kind < 5 ? 7 + 3 * dice_.below(4) : 20;
    left_.assign(halfwords, 0);
    for (std::uint16_t& word : left_) word = static_cast<std::uint16_t>(dice_.draw());
    const auto put = [&](std::size_t index, std::uint64_t value) {
      left_[halfwords - 1 - index] = static_cast<std::uint16_t>(value);
    };
    for (unsigned i = 0; i < 3; ++i) put(1 + i, count >> 16 * i);
    if (halfwords == 20) {
      put(10, distance);
      put(11, distance >> 16);
    }
    committing_ = true;
    check_.event(kind == 5 ? "barrier" : to_feed_ ? "piece" : "path", count);
  }
  std::uint32_t random_distance() {
    if (near_ && !dice_.chance(4)) return 1 + dice_.below(4);
    if (dice_.chance(20)) return (1 + dice_.below(9)) << 16;
    return dice_.chance(zero_every_) ? 0 : static_cast<std::uint32_t>(dice_.log_uniform(distance_bits_));
  }

  // A piece is loaded, decoded a few clocks later, and begins: at once if no piece gives ticks, otherwise with a last
  // tick.
  void random_piece() {
    ++since_swap_;
    in_.swap = swaps_;
    if (swaps_) in_.active = true;
    if (ended_) in_.active = false;
    swaps_ = ended_ = false;
    if (in_.swap) in_.decoded = false;
    in_.load = {};
    in_.take = in_.active && dice_.chance(take_every_);
    if (loaded_ < 2 && since_swap_ >= kAfterSwap && (loaded_ == 1 || dice_.chance(20))) {
      if (loaded_ == 0) distance_ = random_distance();
      in_.load = halfword(model::feed_target::kStopDistance, distance_, loaded_++);
      if (loaded_ == 2 && dice_.chance(2)) in_.decoded = true;
    } else if (loaded_ == 2 && !in_.decoded) {
      in_.decoded = dice_.chance(8);
    }
    taken_ += in_.take ? 1U : 0U;
    // Loads for other blocks, and bus contents without a load.
    if (!in_.load.valid && dice_.chance(3)) {
      const auto target = static_cast<std::uint8_t>(dice_.below(8));
      in_.load = {target != model::feed_target::kStopDistance && dice_.chance(2), target,
                  static_cast<std::uint16_t>(dice_.draw())};
    }
    const bool last = in_.take && dice_.chance(30);
    const bool may_begin = in_.decoded && since_swap_ >= kSwaps && !model_.waits(in_.active);
    if (may_begin && (!in_.active || last)) {
      swaps_ = true;
      loaded_ = 0;
      since_swap_ = 0;
    } else {
      ended_ = last;
    }
  }

  void reset() {
    check_.event("reset");
    dut_->rst_i = 1;
    apply();
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::UnderrunGuard();
    underruns_ahead_ = 0;
    forget();
    compare();
  }
  void forget() {
    left_.clear();
    committing_ = swaps_ = ended_ = false;
    since_commit_ = since_swap_ = 0;
    paths_ = pieces_ = taken_ = 0;
    loaded_ = 0;
    in_.active = in_.decoded = in_.swap = false;
    in_.load = {};
    in_.arrival = {};
  }

  void clock() {
    apply();
    const bool held = model_.outputs().hold;
    dut_.clock();
    model_.clock(in_);
    compare();
    holds_ += !held && model_.outputs().hold ? 1U : 0U;
    ends_ += held && !model_.outputs().hold && !in_.cut ? 1U : 0U;
    waits_ += model_.outputs().shown && !model_.outputs().hold ? 1U : 0U;
    if (!held && model_.outputs().hold) check_.event("hold begins");
    // After a probe's halt nothing runs or begins.
    if (in_.lost) {
      check_.event("what is queued is lost");
      swaps_ = false;
      ended_ = true;
      in_.decoded = false;
      loaded_ = since_swap_ = 0;
      paths_ = pieces_ = taken_ = 0;
      ++lost_;
    }
    if (in_.cut) {
      check_.event("cut");
      forget();
    }
  }

  void apply() {
    dut_->cut_i = in_.cut;
    dut_->lost_i = in_.lost;
    dut_->idle_i = in_.idle;
    dut_->gone_i = in_.gone;
    dut_->arrival_i = arrival_wire(in_.arrival, in_.full);
    dut_->load_i = feed_wire(in_.load);
    dut_->take_i = in_.take;
    dut_->swap_i = in_.swap;
    dut_->active_i = in_.active;
    dut_->decoded_i = in_.decoded;
    dut_->ratio_i = in_.ratio;
  }

  void compare() {
    check_.next_cycle();
    const auto& out = model_.outputs();
    check_.compare("wait_o", dut_->wait_o, model_.waits(dut_->active_i != 0));
    check_.compare("hold_o", dut_->hold_o, out.hold);
    check_.compare("shown_o", dut_->shown_o, out.shown);
    check_.compare("underruns_o", dut_->underruns_o, out.underruns + underruns_ahead_);
  }

  Checker check_;
  Dice dice_;
  Simulated<Vdut> dut_;
  model::UnderrunGuard model_;
  Inputs in_;
  std::vector<std::uint16_t> left_;  // halfwords still to come, the next one last
  bool committing_ = false;
  bool to_geometry_ = false;
  bool to_feed_ = false;
  unsigned since_commit_ = 0;
  unsigned since_swap_ = 0;
  unsigned loaded_ = 0;  // halfwords of the next piece's stop distance that were loaded
  std::uint32_t distance_ = 0;
  bool swaps_ = false;
  bool ended_ = false;
  bool near_ = false;
  std::uint64_t paths_ = 0;  // ticks of paths that arrived
  std::uint64_t pieces_ = 0;
  std::uint64_t taken_ = 0;
  unsigned cut_every_ = 5000;
  unsigned take_every_ = 2;
  unsigned count_bits_ = 10;
  unsigned distance_bits_ = 12;
  unsigned zero_every_ = 6;
  unsigned arrive_every_ = 20;
  std::uint32_t underruns_ahead_ = 0;  // the RTL's count minus the model's
  std::uint64_t holds_ = 0;
  std::uint64_t ends_ = 0;
  std::uint64_t waits_ = 0;
  std::uint64_t lost_ = 0;
};

void random_inputs() {
  Bench bench(seed_from_environment(20261122));
  const std::uint64_t length = scaled(3'000'000);
  while (bench.check().cycles() < length) bench.random_clock();
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * bench.check().cycles());
  EXPECT_GT(bench.holds(), length / 10'000);
  EXPECT_GT(bench.ends(), length / 20'000);
  EXPECT_GT(bench.waits(), length / 100);
  EXPECT_EQ(bench.lost() > length / 3000, kProbing);
}

// The next piece is judged by itself, in whichever clock of a round it begins.
void ending_pieces_are_cut() {
  Bench bench(1);
  for (unsigned later = 0; later < 32; ++later) bench.ending_piece_is_cut(later);
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * bench.check().cycles());
  EXPECT_EQ(bench.holds(), 32U);
}

// The first round after a reset judges its counts like any other.
void reset_finds_what_is_lost() {
  Bench bench(1);
  bench.reset_while_lost();
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * bench.check().cycles());
  EXPECT_GT(bench.waits(), 30U);
}

TEST(UnderrunGuard, ResetFindsWhatIsLost) { EXPECT_EQ(judge(reset_finds_what_is_lost), ""); }
TEST(UnderrunGuard, EndingPiecesAreCut) { EXPECT_EQ(judge(ending_pieces_are_cut), ""); }
TEST(UnderrunGuard, RandomInputs) { EXPECT_EQ(judge(random_inputs), ""); }

}  // namespace
}  // namespace trammel::lockstep
