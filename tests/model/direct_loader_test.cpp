// The model of the direct loader against the description of START in the reference: what it reads, what it loads, every
// check and their order, and the clocks in closed form.
#include "trammel/model/direct_loader.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "trammel/card_map.hpp"
#include "trammel/skip/commands.hpp"

namespace {

using trammel::card_map::Reason;
using trammel::model::DirectLoader;
using trammel::model::LoadWord;
namespace reg = trammel::card_map::reg;
namespace target = trammel::model::load_target;

struct Move {
  std::array<std::uint64_t, 8> frequency{};
  std::array<std::uint32_t, 8> count{};
  std::array<bool, 8> negative{};
  std::uint64_t length = 1;
};

// The registers that the loader reads; data comes two clocks after the address.
class Bench {
 public:
  explicit Bench(unsigned axes) : loader_(axes) {}

  void set(const Move& move) {
    for (std::uint32_t n = 0; n < 8; ++n) {
      memory_[0xCF0 - 0x10 * n] = static_cast<std::uint32_t>(move.frequency[n]);
      memory_[0xCF4 - 0x10 * n] = static_cast<std::uint32_t>(move.frequency[n] >> 32);
      memory_[0xCF8 - 0x10 * n] = move.count[n];
      memory_[0xCFC - 0x10 * n] = move.negative[n] ? 1 : 0;
    }
    memory_[0xD00] = static_cast<std::uint32_t>(move.length);
    memory_[0xD04] = static_cast<std::uint32_t>(move.length >> 32);
  }

  // Clocks from START to its answer.
  unsigned start(std::uint8_t mask) {
    loads.clear();
    in.mask = mask;
    in.start = true;
    unsigned clocks = 0;
    do {
      if (clocks == busy_only_at || clocks == busy_from) in.busy = true;
      if (clocks == busy_only_at + 1) in.busy = false;
      if (clocks == closed_from) in.closed = true;
      clock();
      in.start = false;
      ++clocks;
    } while (!loader_.outputs().done && clocks < 1000);
    return clocks;
  }

  void clock() {
    in.data = pipe_[1];
    pipe_[1] = pipe_[0];
    const std::uint32_t address = loader_.outputs().address * 4U;
    pipe_[0] = memory_.count(address) != 0 ? memory_[address] : 0xDEADDEAD;
    loader_.clock(in);
    if (loader_.outputs().load.valid) loads.push_back(loader_.outputs().load);
  }

  Reason reason() const {
    const DirectLoader::Outputs& out = loader_.outputs();
    EXPECT_NE(out.go, out.error);
    return out.error ? static_cast<Reason>(out.reason) : Reason::None;
  }
  const DirectLoader& loader() const { return loader_; }

  static constexpr unsigned kNever = 100000;
  unsigned busy_only_at = kNever;
  unsigned busy_from = kNever;
  unsigned closed_from = kNever;
  DirectLoader::Inputs in;
  std::vector<LoadWord> loads;

 private:
  DirectLoader loader_;
  std::map<std::uint32_t, std::uint32_t> memory_;
  std::array<std::uint32_t, 2> pipe_{};
};

constexpr std::uint64_t kMaxFrequency = std::uint64_t{1} << 40;

Move good_move() {
  Move move;
  for (unsigned n = 0; n < 8; ++n) {
    move.frequency[n] = kMaxFrequency / (n + 2);
    move.count[n] = 1000 + n;
    move.negative[n] = n % 2 == 1;
  }
  move.length = 0x12'3456'789A;
  return move;
}

void expect_loads(const Bench& bench, const Move& move, std::uint8_t mask) {
  std::vector<LoadWord> expected;
  const auto add = [&expected](unsigned chain, std::uint64_t value, int halfwords) {
    for (int i = 0; i < halfwords; ++i) {
      expected.push_back({true, static_cast<std::uint16_t>(chain), static_cast<std::uint16_t>(value >> (16 * i))});
    }
  };
  for (unsigned n = 0; n < 8; ++n) {
    if ((mask >> n & 1) == 0) continue;
    add(target::increment(n), move.negative[n] ? 0 - move.frequency[n] : move.frequency[n], 3);
    add(target::count(n), move.count[n], 2);
  }
  add(target::kTicks, move.length, 3);
  ASSERT_EQ(bench.loads.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(bench.loads[i].target, expected[i].target) << i;
    EXPECT_EQ(bench.loads[i].word, expected[i].word) << i;
  }
}

TEST(DirectLoader, LoadsTheMaskedAxesAndTheLength) {
  for (unsigned mask = 1; mask < 256; ++mask) {
    Bench bench(8);
    bench.set(good_move());
    const auto axes = static_cast<std::uint8_t>(mask);
    EXPECT_EQ(bench.start(axes), 33 + 16 * trammel::card_map::axes_in(axes));
    EXPECT_EQ(bench.reason(), Reason::None);
    EXPECT_EQ(bench.loader().outputs().mask, mask);
    expect_loads(bench, good_move(), axes);
    bench.clock();
    EXPECT_FALSE(bench.loader().outputs().done || bench.loader().outputs().go);
  }
}

TEST(DirectLoader, RandomMoves) {
  std::mt19937_64 random(1);
  Bench bench(8);
  for (int i = 0; i < 2000; ++i) {
    Move move;
    move.length = random() >> (24 + random() % 40);
    bool bad = move.length == 0;
    const auto mask = static_cast<std::uint8_t>(random() % 255 + 1);
    for (unsigned n = 0; n < 8; ++n) {
      // Values around 2^40 are frequent: the limit itself, and a high word with a low word of 0.
      const std::uint64_t near = kMaxFrequency + random() % 3 - 1;
      move.frequency[n] = random() % 8 == 0 ? 0 : random() % 4 == 0 ? near : random() % (kMaxFrequency + 1);
      move.count[n] = random() % 4 == 0 ? 0 : static_cast<std::uint32_t>(random());
      move.negative[n] = random() % 2 == 0;
      if ((mask >> n & 1) != 0) {
        bad = bad || move.frequency[n] > kMaxFrequency || (move.frequency[n] == 0 && move.count[n] != 0);
      }
    }
    bench.set(move);
    bench.start(mask);
    EXPECT_EQ(bench.reason(), bad ? Reason::BadValue : Reason::None);
    if (!bad) expect_loads(bench, move, mask);
  }
}

TEST(DirectLoader, ChecksOfTheMask) {
  for (unsigned axes = 1; axes <= 8; ++axes) {
    for (unsigned mask = 0; mask < 256; ++mask) {
      Bench bench(axes);
      bench.set(good_move());
      const bool good = mask != 0 && mask < 1U << axes;
      const unsigned clocks = bench.start(static_cast<std::uint8_t>(mask));
      EXPECT_EQ(bench.reason(), good ? Reason::None : Reason::BadValue) << axes << " axes, mask " << mask;
      if (!good) {
        EXPECT_EQ(clocks, 17U);
        EXPECT_TRUE(bench.loads.empty());
      }
    }
  }
}

// Every combination of errors: the answer names the first one in the documented order.
TEST(DirectLoader, TheOrderOfItsChecks) {
  for (unsigned wrong = 0; wrong < 16; ++wrong) {
    Bench bench(4);
    Move move = good_move();
    if ((wrong & 1) != 0) move.length = 0;
    bench.set(move);
    bench.in.busy = (wrong & 2) != 0;
    bench.in.closed = (wrong & 4) != 0;
    const unsigned clocks = bench.start((wrong & 8) != 0 ? 0x10 : 0x5);
    Reason expected = (wrong & 1) != 0 ? Reason::BadValue : Reason::None;
    if ((wrong & 2) != 0) expected = Reason::Busy;
    if ((wrong & 4) != 0) expected = Reason::Faulted;
    if ((wrong & 8) != 0) expected = Reason::BadValue;
    EXPECT_EQ(bench.reason(), expected) << wrong;
    EXPECT_EQ(clocks, wrong < 2 ? 33U + 32U : 17U) << wrong;
  }
}

TEST(DirectLoader, LooksAtTheCardInTheSeventhClock) {
  for (unsigned clock = 1; clock < 20; ++clock) {
    Bench bench(4);
    bench.set(good_move());
    bench.busy_only_at = clock;
    bench.start(1);
    EXPECT_EQ(bench.reason(), clock == 7 ? Reason::Busy : Reason::None) << clock;
  }
}

// A fault during START must not leave a move that begins when FAULT is cleared.
TEST(DirectLoader, AFaultInTheMeantimeRefusesTheMove) {
  const unsigned answer = 33 + 16;
  for (unsigned clock = 8; clock < answer; ++clock) {
    Bench bench(4);
    bench.set(good_move());
    bench.closed_from = clock;
    EXPECT_EQ(bench.start(1), answer);
    EXPECT_EQ(bench.reason(), Reason::Faulted) << clock;
    EXPECT_FALSE(bench.loader().outputs().go);
  }
}

// A reset in any clock of a START: neither an answer nor a move follows.
TEST(DirectLoader, AResetLeavesNothing) {
  for (unsigned clock = 0; clock < 60; ++clock) {
    Bench bench(4);
    bench.set(good_move());
    bench.in.mask = 1;
    bench.in.start = true;
    for (unsigned i = 0; i <= clock; ++i) {
      bench.in.reset = i == clock;
      bench.clock();
      bench.in.start = false;
    }
    bench.in.reset = false;
    bench.loads.clear();
    EXPECT_FALSE(bench.loader().outputs().go);
    for (int i = 0; i < 100; ++i) {
      bench.clock();
      EXPECT_FALSE(bench.loader().outputs().done || bench.loader().outputs().go) << clock;
    }
    EXPECT_TRUE(bench.loads.empty());
    EXPECT_TRUE(trammel::skip::horizon(bench.loader(), {}) != 0);
  }
}

}  // namespace
