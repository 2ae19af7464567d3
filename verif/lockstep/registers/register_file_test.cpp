// Lockstep of the register file: random traffic, and cases that are rare by chance.
#include <gtest/gtest.h>

#include <utility>

#include "register_file_bench.hpp"

namespace trammel::lockstep {
namespace {

// A snapshot requested `before` clocks before the lower `bits` bits of the time carry.
void snapshot_before_a_carry(Bench& bench, std::uint32_t bits, std::uint32_t before) {
  bench.reset();
  for (std::uint64_t i = 0; i < kFilled; ++i) bench.clock();
  bench.skip_to((std::uint64_t{1} << bits) - 1 - before);
  bench.access(true, reg::kControl, card_map::field::kControlSnapshot);
  bench.access(false, reg::kSnapTimeLo, 0);
  bench.access(false, reg::kSnapTimeHi, 0);
}

// In every clock around the carry into the time's high word, whose halves the card writes in turn; then around each
// carry within the high word.
void snapshots_around_carries(Bench& bench) {
  for (std::uint32_t before = 0; before < 16; ++before) snapshot_before_a_carry(bench, 32, before);
  for (std::uint32_t bits = 33; bits < 64; ++bits) snapshot_before_a_carry(bench, bits, bits % 4);
}

// A reset in each clock of a write: its effect never appears, whether a setting, an event or a refusal.
void resets_in_writes(Bench& bench) {
  constexpr std::pair<std::uint32_t, std::uint32_t> kWritten[] = {
      {reg::kIrqEnable, 1}, {reg::kControl, 1}, {reg::kControl, card_map::field::kControlProbeClear},
      {reg::kFault, 1},     {reg::kRefusal, 1}, {reg::kAxes, 1}};
  constexpr std::uint32_t kLongest = 8;  // clocks, more than such a write takes
  for (const auto& [address, data] : kWritten) {
    for (std::uint32_t after = 0; after < kLongest; ++after) {
      bench.reset();
      for (std::uint64_t i = 0; i < kFilled; ++i) bench.clock();
      bench.ask(true, address, data);
      for (std::uint32_t i = 0; i < after; ++i) bench.clock();
      bench.reset();
      for (std::uint32_t i = 0; i < kLongest; ++i) bench.clock();
    }
  }
}

TEST(RegisterFile, LockstepUnderTraffic) {
  const std::uint64_t seed = seed_from_environment(1);
  EXPECT_EQ("", judge([&] {
              Bench bench(seed);
              snapshots_around_carries(bench);
              resets_in_writes(bench);
              const std::uint64_t length = scaled(400'000);
              for (std::uint64_t i = 0; i < length; ++i) bench.random_clock();
              EXPECT_EQ(bench.checker().comparisons(), bench.expected());
            }));
}

TEST(RegisterFile, ReadsEveryAddressAfterReset) {
  EXPECT_EQ("", judge([] {
              Bench bench(1);
              for (std::uint32_t address = 0; address < card_map::kWindowBytes; address += 4)
                bench.access(false, address, 0);
              EXPECT_GT(bench.checker().cycles(), card_map::kWindowBytes);
            }));
}

// Each writable word receives a number of its own and keeps it while all others are written, but not over a reset.
// Writes of the stream and of START are left out, because they wait for blocks that are missing here.
TEST(RegisterFile, EveryWordIsItsOwn) {
  EXPECT_EQ("", judge([] {
              Bench bench(1);
              for (std::uint32_t address = 0; address < card_map::kWindowBytes; address += 4) {
                if (address == reg::kStream || address == reg::kStart) continue;
                bench.access(true, address, address / 4 % 251 + 1);
              }
              for (std::uint32_t address = 0; address < card_map::kWindowBytes; address += 4)
                bench.access(false, address, 0);
              bench.reset();
              for (std::uint32_t address = 0; address < card_map::kWindowBytes; address += 4)
                bench.access(false, address, 0);
              EXPECT_GT(bench.checker().cycles(), 3 * card_map::kWindowBytes);
            }));
}

// An absent axis has no register, for every initial state of the flip-flops.
void absent_axis() {
  for (int state = 1; state <= 8; ++state) {
    Bench bench(1, state);
    bench.access(false, reg::mode(kAxes), 0);
    EXPECT_TRUE(bench.refused());
  }
}

// The order of both does not depend on the snapshot before the reset.
void captures_beside_marks() {
  if (!kCaptures) return;
  Bench bench(1);
  for (int i = 0; i < 2; ++i) {
    bench.reset();
    for (std::uint64_t clock = 0; clock < kFilled; ++clock) bench.clock();
    bench.capture(true);
    bench.capture(false);
  }
}

TEST(RegisterFile, AbsentAxis) { EXPECT_EQ("", judge(absent_axis)); }
TEST(RegisterFile, CapturesBesideMarks) { EXPECT_EQ("", judge(captures_beside_marks)); }

// A snapshot and its time, twice in a row: the difference is the number of clocks between the two snapshots.
void snapshot_time_counts_clocks() {
  Bench bench(1);
  bench.access(true, reg::kControl, card_map::field::kControlSnapshot);
  const std::uint32_t first = bench.access(false, reg::kSnapTimeLo, 0);
  const std::uint64_t start = bench.checker().cycles();
  for (int i = 0; i < 1000; ++i) bench.clock();
  bench.access(true, reg::kControl, card_map::field::kControlSnapshot);
  const std::uint64_t between = bench.checker().cycles() - start;
  const std::uint32_t second = bench.access(false, reg::kSnapTimeLo, 0);
  EXPECT_GT(second - first, between);
  EXPECT_LT(second - first, between + 32);
}

// LINK_TIMEOUT passes in units of 2^16 clocks; only the clocks around their ends are run.
void link_timeout_counts_units() {
  Bench bench(1);
  for (std::uint64_t i = 0; i < kFilled; ++i) bench.clock();
  bench.skip_to(0xFFC0);
  bench.access(true, reg::kLinkTimeout, 1);
  for (std::uint64_t units = 1; units <= 2; ++units) {
    EXPECT_FALSE(bench.link_lost());
    bench.skip_to((units << 16) - 0x20);
    for (int i = 0; i < 0x40; ++i) bench.clock();
  }
  EXPECT_TRUE(bench.link_lost());
}

TEST(RegisterFile, LinkTimeoutCountsUnits) { EXPECT_EQ("", judge(link_timeout_counts_units)); }
TEST(RegisterFile, SnapshotTimeCountsClocks) { EXPECT_EQ("", judge(snapshot_time_counts_clocks)); }

}  // namespace
}  // namespace trammel::lockstep
