// Lockstep of both sequencers with all their parts (fetches, decoders, counters, barrier, tick gate): random programs
// with random time, engines and axes, cuts and resets at any clock, direct moves; every output in every cycle.
#include <gtest/gtest.h>

#include "sequencers_bench.hpp"

namespace trammel::lockstep {
namespace {

using Bench = SequencersBench;

// Paths, pieces and dwells at the boundaries of their counters' words, with a tick in every clock; each alone to its
// end.
void boundaries() {
  Bench bench(1);
  bench.pace = {1, 1, 1'000'000, 1, 1'000'000};
  const auto run = [&bench](const Halfwords& geometry, const Halfwords& feed) {
    bench.add({{geometry}, {feed}});
    for (unsigned i = 0; i < 200; ++i) bench.clock();
    while (!bench.at_rest()) bench.clock();
  };
  std::uint64_t dwells = 0;
  for (const std::uint64_t count : {0U,
                                    1U,
                                    2U,
                                    3U,
                                    14U,
                                    15U,
                                    16U,
                                    17U,
                                    18U,
                                    31U,
                                    32U,
                                    33U,
                                    255U,
                                    256U,
                                    257U,
                                    65535U,
                                    65536U,
                                    65537U,
                                    65552U,
                                    (1U << 20) - 1,
                                    1U << 20,
                                    (1U << 20) + 1,
                                    (1U << 20) + 17}) {
    const Halfwords dwell = stored_command(card_map::Opcode::Dwell, 0, count);
    run(dwell, dwell);
    dwells += std::max<std::uint64_t>(count, 1);
    if (count == 0) continue;
    run(stored_command(card_map::Opcode::Line, 1, count, {}, {kOnePulse}),
        stored_command(card_map::Opcode::Feed, 0, count, {{"rate", int128{1} << 63}, {"floor", 1}}));
    dwells += count;
  }
  EXPECT_GT(bench.check().cycles(), dwells);
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
}

void random_programs() {
  Bench bench(seed_from_environment(20261116));
  const std::uint64_t length = scaled(1'500'000);
  while (bench.check().cycles() < length) bench.random_clock();
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
  EXPECT_GT(bench.swaps(), length / 500);
  EXPECT_GT(bench.halts(), length / 10'000);
  EXPECT_GT(bench.drops(), length / 2000);
  EXPECT_GT(bench.missing(), length / 20'000);
  EXPECT_GT(bench.late(), length / 50'000);
}

// The next period comes in every clock around the end of the previous one, and long after it.
void late_periods() {
  Bench bench(3);
  for (const unsigned ticks : {1U, 2U, 3U, 17U, 40U}) {
    for (unsigned stale_periods = 0; stale_periods < 4; ++stale_periods) {
      for (unsigned clocks = 0; clocks < 60 + 3 * ticks * (1 + stale_periods); ++clocks)
        bench.stream(ticks, stale_periods, clocks);
    }
  }
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
  EXPECT_GT(bench.missing(), 500U);
  EXPECT_GT(bench.late(), 500U);
}

// A cut or a reset at each clock of two runs, and the clocks after it.
void cuts_at_every_clock() {
  Bench bench(1);
  for (const bool by_reset : {false, true}) {
    for (unsigned run = 0; run < 4000; ++run) {
      bench.restart(1 + run / 500);
      bench.short_programs(run % 500);
      bench.interrupt(by_reset);
      bench.short_programs(60);
    }
  }
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
  EXPECT_GT(bench.swaps(), 2000U);
}

// Paths and all barriers between PROBE and PROBE_END; with `empty`: nothing, so that the END before them is the last
// command.
Programs::Stretch probed_program(bool empty) {
  const auto barrier = [](card_map::Opcode opcode, std::uint64_t count) { return stored_command(opcode, 0, count); };
  const auto line = [](std::uint64_t ticks) {
    return stored_command(card_map::Opcode::Line, 1, ticks, {}, {kOnePulse});
  };
  const auto piece = [](std::uint64_t ticks) {
    return stored_command(card_map::Opcode::Feed, 1, ticks, {{"rate", int128{1} << 63}, {"floor", 1}});
  };
  const Halfwords end = barrier(card_map::Opcode::End, 0);
  const Halfwords dwell = barrier(card_map::Opcode::Dwell, 3);
  const Halfwords wait = stored_command(card_map::Opcode::WaitInput, 0, 5, {{"condition", 0x21}});
  const Halfwords probe_end = barrier(card_map::Opcode::ProbeEnd, 0);
  Programs::Stretch program{{end, stored_command(card_map::Opcode::Probe, 0, 0, {{"condition", 0x20}})}, {end}};
  if (!empty) {
    program.geometry.insert(program.geometry.end(), {dwell, line(4), Programs::mark(), wait, end, line(1), dwell});
    program.feed.insert(program.feed.end(), {dwell, piece(4), wait, end, piece(1), dwell});
  }
  program.geometry.insert(program.geometry.end(), {probe_end, line(3), end});
  program.feed.insert(program.feed.end(), {probe_end, piece(3), end});
  return program;
}

// A probe's edge at each clock of a program; by chance, its commands are already decoded or still in either queue.
void edges_at_every_clock() {
  Bench bench(1);
  const unsigned clocks[] = {400, 120};
  for (unsigned empty = 0; empty < 2; ++empty) {
    for (unsigned run = 0; run < 5 * clocks[empty]; ++run) {
      bench.restart(1 + run);
      bench.probed(probed_program(empty != 0), run / 5);
    }
  }
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
  EXPECT_GT(bench.halts(), 1000U);
  EXPECT_GT(bench.drops(), 2000U);
}

void wait_without_time_out() {
  Bench bench(1);
  bench.wait_beyond_the_count();
  EXPECT_TRUE(bench.waited());
  EXPECT_TRUE(bench.at_rest());
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
}

// The tests that find most bugs come first.
TEST(Sequencers, RandomPrograms) { EXPECT_EQ(judge(random_programs), ""); }
TEST(Sequencers, EdgesAtEveryClock) { EXPECT_EQ(judge(edges_at_every_clock), ""); }
TEST(Sequencers, LatePeriods) { EXPECT_EQ(judge(late_periods), ""); }
TEST(Sequencers, CutsAtEveryClock) { EXPECT_EQ(judge(cuts_at_every_clock), ""); }
TEST(Sequencers, AWaitWithoutTimeOut) { EXPECT_EQ(judge(wait_without_time_out), ""); }
TEST(Sequencers, Boundaries) { EXPECT_EQ(judge(boundaries), ""); }

}  // namespace
}  // namespace trammel::lockstep
