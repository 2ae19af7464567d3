// The hand-over of operations stalls, or is slower than the card. Compares the times of the pulses.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "path_bench.hpp"

namespace trammel::linuxcnc {
namespace {

// Times of the pulses, counted from the first one.
std::vector<std::uint64_t> pulse_times(const PathBench& bench) {
  std::vector<std::uint64_t> times;
  for (const driver::PinStep& step : bench.steps.pins) times.push_back(step.cycle - bench.steps.pins.front().cycle);
  return times;
}

// The realtime process is stopped three times for 300 ms, in which neither operations nor beats come.
TEST(PathServer, StallsOfTheRealtimeSideChangeNoPulse) {
  PathBench quiet;
  quiet.run(long_way().all);
  PathBench stalled;
  stalled.run(long_way().all, [&](unsigned period) {
    stalled.stalled =
        (period >= 10 && period < 310) || (period >= 1000 && period < 1300) || (period >= 2000 && period < 2300);
  });
  PathBench later;
  later.run(long_way().all, [&](unsigned period) { later.stalled = period >= 1000 && period < 1900; });
  EXPECT_TRUE(pulse_times(later) == pulse_times(quiet));
  EXPECT_TRUE(path_of(stalled.steps) == path_of(quiet.steps)) << "an early one may part the motion, never the path";
}

// The stall is in the middle of the hand-over. The card then has enough motion for longer than the stall.
TEST(PathServer, StallsWhileOperationsComeChangeNoPulse) {
  Operations many;
  for (int n = 0; n < 400; ++n) many.feed({(n % 20) * 0.2, n * 0.01}, 100);
  machine::Machine machine = machine::default_machine();
  machine.motion.window = 40;
  PathBench at_once(machine);
  for (const trammel_operation& operation : many.all) at_once.post(operation);
  at_once.run({});
  PathBench quiet(machine);
  quiet.run(many.all);
  EXPECT_TRUE(pulse_times(quiet) == pulse_times(at_once)) << "handed over one by one";
  PathBench stalled(machine);
  stalled.run(many.all, [&](unsigned period) { stalled.stalled = period >= 300 && period < 600; });
  EXPECT_TRUE(pulse_times(stalled) == pulse_times(quiet));
  EXPECT_EQ(quiet.under_runs + stalled.under_runs, 0U);
}

// One feed piece spans many of these lines, and arrives with a later one.
TEST(PathServer, SlowLinesBehindOneAnotherComeToTheirEnd) {
  machine::Machine machine = machine::default_machine();
  machine.motion.window = 40;
  for (machine::MachineAxis& axis : machine.axes) axis.max_acceleration = 100'000;  // a stop takes almost no time
  Operations many;
  for (int n = 1; n <= 150; ++n) many.feed({n * 0.1}, 5);
  PathBench bench(machine);
  bench.run(many.all);
  EXPECT_EQ(bench.steps.position(0), 15 * kPathPulses);
  EXPECT_EQ(bench.under_runs, 0U);
}

}  // namespace
}  // namespace trammel::linuxcnc
