// Lockstep of the motion core, from queue words to steps: random programs, direct moves, settings, holds, faults with
// each reaction, clears and aborts in either order, cuts and resets at any clock; every output in every cycle.
#include <gtest/gtest.h>

#include "motion_core_bench.hpp"

namespace trammel::lockstep {
namespace {

// On a bench of their own, so that the random programs do not depend on them.
void separate_scenarios() {
  MotionCoreBench bench(1);
  if (kEnables) bench.health_follows_the_watchdog();
  if (kStreaming) bench.streaming_set_before_the_piece();
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
}

void random_programs() {
  separate_scenarios();
  MotionCoreBench bench(seed_from_environment(20261115));
  const std::uint64_t length = scaled(1'000'000);
  if (kPathCommands) bench.commands_around_ends();
  if (kPathCommands) bench.mark_behind_a_cause();
  if (kPathCommands) bench.edges_around_the_end();
  if (kStreaming) bench.streaming_set_around_the_begin();
  if (kClasses) bench.holds_before_the_path();
  if (kEnables) bench.drives_disabled_in_motion();
  if (kEnables && kDirectMode) bench.direct_move_waits_for_drives();
  if (kEnables && kPwm) bench.pulses_while_drives_wait();
  // The directed scenarios above make most of the steps of a short run, and do not grow in a long one.
  const std::uint64_t directed_clocks = bench.check().cycles();
  const std::uint64_t directed_steps = bench.counts().steps;
  if (kPathCommands) {
    EXPECT_GT(directed_steps, 5000U);
  }
  while (bench.check().cycles() < length) bench.random_clock();
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
  EXPECT_GT(bench.counts().steps - directed_steps, (length - directed_clocks) / 500);
  if (kDirectMode) {
    EXPECT_GT(bench.counts().moves, length / 20'000);
  }
  EXPECT_GT(bench.counts().faults, length / 20'000);
  EXPECT_GT(bench.counts().lost_places, length / 50'000);
  if (kPathCommands) {
    EXPECT_GT(bench.counts().marks, length / 5000);
    EXPECT_GT(bench.counts().halts, length / 20'000);
  }
  if (kEnables) {
    EXPECT_GT(bench.counts().waits, length / 2000);
  }
  if (kMachineInputs) {
    EXPECT_GT(bench.counts().limits, length / 60'000);
    EXPECT_GT(bench.counts().beyond, length / 300'000);
  }
  if (kSoftLimits) {
    EXPECT_GT(bench.counts().soft_limits, length / 80'000);
  }
  if (kStreaming) {
    EXPECT_GT(bench.counts().missing, length / 200'000);
    EXPECT_GT(bench.counts().stale, length / 5000);
  }
}

TEST(MotionCore, RandomPrograms) { EXPECT_EQ(judge(random_programs), ""); }

}  // namespace
}  // namespace trammel::lockstep
