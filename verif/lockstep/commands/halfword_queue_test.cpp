// The queue in lockstep with its model: a writer that commits, drops and clears, a reader that reads with pauses.
#include "trammel/model/halfword_queue.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "Vdut.h"
#include "trammel/sim/lockstep.hpp"

namespace {

using trammel::lockstep::Checker;
using trammel::model::HalfwordQueue;

constexpr std::size_t kDepth = TRAMMEL_DEPTH;
constexpr std::uint64_t kSignals = 2;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : checker_("halfword_queue", seed), model_(kDepth) {
    HalfwordQueue::Inputs in;
    in.reset = true;
    clock(in);
  }

  void clock(const HalfwordQueue::Inputs& in) {
    rtl_->rst_i = in.reset;
    rtl_->clear_i = in.clear;
    rtl_->drop_i = in.drop;
    rtl_->commit_i = in.commit;
    rtl_->write_i = in.write;
    rtl_->halfword_i = in.word;
    rtl_->read_i = in.read;
    if (in.write) checker_.event("write", in.word);
    if (in.commit) checker_.event("commit");
    if (in.drop) checker_.event("drop");
    if (in.read) checker_.event("read");
    if (in.clear) checker_.event("clear");
    word_known_ = ram_known_;
    ram_known_ = ram_known_ || (in.read && !model_.outputs().empty);
    rtl_.clock();
    model_.clock(in);
    checker_.next_cycle();
    if (word_known_) {
      checker_.compare("word_o", rtl_->word_o, model_.outputs().word);
      ++words_;
    }
    checker_.compare("empty_o", rtl_->empty_o, model_.outputs().empty);
    checker_.compare("room_o", rtl_->room_o, model_.outputs().room);
  }

  bool full() const { return model_.free() == 0; }
  const Checker& checker() const { return checker_; }
  std::uint64_t expected() const { return kSignals * checker_.cycles() + words_; }

 private:
  Checker checker_;
  trammel::lockstep::Simulated<Vdut> rtl_;
  HalfwordQueue model_;
  // A halfword has been read: the RAM's output is defined, and one clock later the port.
  bool ram_known_ = false;
  bool word_known_ = false;
  std::uint64_t words_ = 0;
};

void fill_and_drain(Bench& bench, std::uint16_t first) {
  HalfwordQueue::Inputs in;
  in.write = true;
  for (std::size_t i = 0; !bench.full(); ++i) {
    in.word = static_cast<std::uint16_t>(first + i);
    bench.clock(in);
  }
  in = {};
  in.commit = true;
  bench.clock(in);
  in = {};
  in.read = true;  // continues when the queue is empty: this must have no effect
  for (std::size_t i = 0; i < kDepth + 4; ++i) bench.clock(in);
}

void random_traffic(Bench& bench, std::mt19937_64& random, std::uint64_t clocks) {
  std::uint64_t read_share = 50;
  std::uint64_t write_share = 50;
  for (std::uint64_t i = 0; i < clocks; ++i) {
    if (i % 500 == 0) {
      read_share = random() % 101;
      write_share = random() % 101;
    }
    HalfwordQueue::Inputs in;
    in.write = !bench.full() && random() % 100 < write_share;
    in.word = static_cast<std::uint16_t>(random());
    in.read = random() % 100 < read_share;
    in.commit = random() % 6 == 0;
    in.drop = random() % 40 == 0;
    in.clear = random() % 900 == 0;
    in.reset = random() % 3000 == 0;
    bench.clock(in);
  }
}

TEST(HalfwordQueueLockstep, EqualsModelInEveryCycle) {
  const std::string complaint = trammel::lockstep::judge([] {
    const std::uint64_t seed = trammel::lockstep::seed_from_environment(20260101);
    Bench bench(seed);
    for (std::uint16_t lap = 0; lap < 5; ++lap) fill_and_drain(bench, static_cast<std::uint16_t>(1000 * lap));
    std::mt19937_64 random(seed);
    const std::uint64_t length = trammel::lockstep::scaled(200'000);
    random_traffic(bench, random, length);
    ASSERT_EQ(bench.checker().comparisons(), bench.expected());
    ASSERT_GT(bench.checker().cycles(), length);
  });
  EXPECT_EQ(complaint, "");
}

}  // namespace
