// Judges the queue of captures from the pins alone. Each edge of a watched input must be in the queue with its level,
// its time and the positions at that time, in the order of the filters; otherwise the card must report it as lost.
#include "trammel/model/capture_fifo.hpp"

#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <random>
#include <vector>

#include "core_bench.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr unsigned kWatched = 4;  // units; unit k watches input k; inputs 2 and 3 have filters
constexpr std::uint64_t kClocksOfScan = 64;
constexpr std::uint64_t kFromPin = 2;           // clocks from the first sample of the edge to the time of its snapshot
constexpr std::uint64_t kLongestWait = 6 * 20;  // clocks: the snapshots of the other units, and two of the host

struct EdgeAtPin {
  std::uint64_t clock = 0;  // the first clock that samples it
  bool active = false;
};

class QueueJudge : public CoreBench {
 public:
  // `fast`: edges of inputs without a filter may be one clock apart.
  QueueJudge(bool fast, std::uint64_t seed) : CoreBench(config()), fast_(fast), random_(seed) {
    skips = false;
    idle(700);
    for (unsigned k = 2; k < kWatched; ++k) write(reg::input_filter(k), k);
    idle(4 * kClocksOfScan);
    for (unsigned k = 0; k < kWatched; ++k) {
      EXPECT_TRUE(write(reg::capture_select(k), k | field::kCaptureSelectToActive | field::kCaptureSelectToInactive |
                                                    field::kCaptureSelectContinuous | field::kCaptureSelectQueue));
      left_[k] = 400 + below(400);
    }
    idle(6 * kClocksOfScan);
    before_clock = [this] { move_inputs(); };
    after_clock = [this] {
      positions_.resize(core.cycles() + 1);
      positions_.back() = static_cast<std::int32_t>(core.position(0));
    };
  }

  // Looks at the queue at least once in `pause` clocks.
  void run(std::uint64_t clocks, std::uint64_t pause) {
    for (const std::uint64_t end = core.cycles() + clocks; core.cycles() < end;) {
      if ((core.outputs().status & field::kStatusBusy) == 0) {
        EXPECT_TRUE(line(3000, {random_() % 2 == 0 ? kOnePulse / 3 : -kOnePulse / 5}));
        EXPECT_TRUE(feed(3000, ~std::uint64_t{0} / 4));
      }
      idle(below(pause));
      drain();
    }
    stands_ = true;
    idle(1000);
    drain();
    for (unsigned k = 0; k < kWatched; ++k) judge_rest(k);
  }

  std::uint64_t taken = 0, lost = 0, missing = 0, exact = 0;

 private:
  static model::CardConfig config() {
    model::CardConfig config;
    config.axes = 8;
    config.engines = model::RegisterFile::kMaxEngines;
    config.inputs = 8;
    return config;
  }
  std::uint64_t below(std::uint64_t count) { return random_() % count; }

  void move_inputs() {
    for (unsigned k = 0; k < kWatched; ++k) {
      if (stands_ || left_[k]-- != 0) continue;
      pins ^= 1U << k;
      edges_[k].push_back({core.cycles() + 1, (pins >> k & 1) != 0});
      // Inputs without a filter have no edge while the previous one is still being captured, unless `fast_` is set.
      left_[k] = k >= 2 ? kClocksOfScan * (k + 3) + below(1000) : kLongestWait + 10 + below(1000);
      if (fast_ && k < 2 && below(4) == 0) left_[k] = below(60);
    }
  }

  void drain() {
    for (std::uint32_t queue = read(reg::kCaptureQueue); (queue & field::kCaptureQueueCaptures) != 0;
         queue = read(reg::kCaptureQueue)) {
      take(queue);
      const std::uint32_t oldest = queue >> field::kCaptureQueueOldestShift & 0xF;
      EXPECT_EQ(oldest, taken++ % 16);
      EXPECT_TRUE(write(reg::kCaptureNext, oldest));
    }
    const std::uint32_t empty = read(reg::kCaptureQueue);
    lost = empty >> field::kCaptureQueueLostShift;
    EXPECT_TRUE((empty & field::kCaptureQueueCaptures) != 0 || read(reg::kCaptureHeadTimeLo) == 0 || queue_grew());
  }
  bool queue_grew() { return (read(reg::kCaptureQueue) & field::kCaptureQueueCaptures) != 0; }

  // The oldest entry belongs to the first edge that fits its time; earlier edges are lost.
  void take(std::uint32_t queue) {
    const unsigned k = queue >> field::kCaptureQueueUnitNumberShift & 3;
    const bool active = (queue & field::kCaptureQueueActive) != 0;
    const std::uint64_t time = read(reg::kCaptureHeadTimeLo);
    std::deque<EdgeAtPin>& edges = edges_[k];
    while (!edges.empty() && (edges.front().clock + kFromPin + kLongestWait < time || edges.front().active != active)) {
      edges.pop_front();
      ++gone_[k];
    }
    ASSERT_FALSE(edges.empty()) << "unit " << k << ": a capture of no edge, time " << time;
    EXPECT_GE(time, edges.front().clock + kFromPin);
    if (time == edges.front().clock + kFromPin) ++exact;
    edges.pop_front();
    // Read before the comparison: each read clocks the card and may move `positions_` in memory.
    const auto captured = static_cast<std::int32_t>(read(reg::capture_head_position(0)));
    EXPECT_EQ(captured, positions_.at(time));
  }

  void judge_rest(unsigned k) {
    gone_[k] += edges_[k].size();
    missing += gone_[k];
    EXPECT_EQ((read(reg::kCaptureState) >> (8 + k) & 1) != 0, gone_[k] != 0) << "unit " << k << ": " << gone_[k];
  }

  bool fast_;
  std::mt19937_64 random_;
  std::array<std::uint64_t, kWatched> left_{};  // clocks to the next edge
  std::array<std::deque<EdgeAtPin>, kWatched> edges_{};
  std::array<std::uint64_t, kWatched> gone_{};
  std::vector<std::int32_t> positions_;  // indexed by clock
  bool stands_ = false;
};

TEST(CaptureFifo, AHostInTimeGetsEachEdge) {
  QueueJudge card(false, seed());
  card.run(400'000, 400);
  EXPECT_GT(card.taken, 2000U);
  EXPECT_GT(card.exact, card.taken / 2);
  EXPECT_EQ(card.lost, 0U);
  EXPECT_EQ(card.missing, 0U);
}

TEST(CaptureFifo, AHostTooLateSeesWhatItLost) {
  QueueJudge card(false, seed());
  card.run(400'000, 8000);
  EXPECT_GT(card.taken, 500U);
  EXPECT_GT(card.lost, 100U);
  EXPECT_EQ(card.missing, card.lost);
}

TEST(CaptureFifo, EdgesTooFastAreTold) {
  QueueJudge card(true, seed());
  card.run(400'000, 400);
  EXPECT_GT(card.taken, 2000U);
  EXPECT_EQ(card.lost, 0U);
  EXPECT_GT(card.missing, 20U);
}

// A repeated or late write of CAPTURE_NEXT drops nothing else.
TEST(CaptureFifo, OnlyTheNumberNamedIsDropped) {
  model::CaptureFifo queue;
  const std::uint32_t area[model::CaptureFifo::kWords] = {7};
  for (unsigned n = 0; n < 3; ++n) queue.clock({1, 1, {}}, area);
  const model::CaptureFifo::Inputs drops{0, 0, {true, reg::kCaptureNext, 0}};
  for (unsigned n = 0; n < 3; ++n) queue.clock(drops, nullptr);
  queue.clock({}, nullptr);
  EXPECT_EQ(queue.word() & field::kCaptureQueueCaptures, 2U);
  EXPECT_EQ(queue.word() >> field::kCaptureQueueOldestShift & 0xF, 1U);
  EXPECT_EQ(queue.oldest(0), 7U);
}

}  // namespace
}  // namespace trammel::testing
