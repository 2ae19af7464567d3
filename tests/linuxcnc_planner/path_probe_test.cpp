// Compares probing segments with the pins of the simulated card.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "path_bench.hpp"

namespace trammel::linuxcnc {
namespace {

class PathProbe : public testing::Test {
 protected:
  static machine::Machine probing() {
    machine::Machine machine = machine::default_machine();
    machine.probe.input = 2;
    return machine;
  }
  void touch_at(double seconds) {
    bench.bus.at(static_cast<std::uint64_t>(seconds * kPathClock),
                 [](sim::Engine& engine) { engine.set_inputs(0b100); });
  }
  PathBench bench{probing()};
};

TEST_F(PathProbe, TellsTheCardsCapture) {
  touch_at(2);
  bench.run(Operations().rapid({3}).probe({3, 0, -10}, 2).all);
  EXPECT_EQ(bench.status.probes, 1U);
  EXPECT_EQ(bench.status.probe_tripped, 1U);
  EXPECT_EQ(bench.status.probe_pose[2] * kPathPulses, bench.steps.position(2, 2 * kPathClock + 8));
  EXPECT_LT(bench.steps.position(2), bench.steps.position(2, 2 * kPathClock + 8)) << "the ramp behind the edge";
  EXPECT_EQ(bench.status.pose[2] * kPathPulses, bench.steps.position(2));
}

// LinuxCNC sees the probe's pin and aborts the motion after the edge.
TEST_F(PathProbe, AnAbortBehindTheEdgeKeepsTheCapture) {
  touch_at(2);
  bool aborted = false;
  bench.run(Operations().probe({0, 0, -10}, 2).all, [&](unsigned) {
    if (aborted || bench.engine->cycles() < 2 * kPathClock + 100) return;
    aborted = true;
    bench.post(TRAMMEL_ABORT);
  });
  EXPECT_TRUE(aborted);
  EXPECT_EQ(bench.status.probes, 1U);
  EXPECT_EQ(bench.status.probe_pose[2] * kPathPulses, bench.steps.position(2, 2 * kPathClock + 8));
}

TEST_F(PathProbe, MissesAndIsAborted) {
  bench.run(Operations().probe({0, 0, -2}, 10).all);
  EXPECT_EQ(bench.status.probes, 1U);
  EXPECT_EQ(bench.status.probe_tripped, 0U);
  EXPECT_EQ(bench.status.probe_pose[2], -2);
  bench.run(Operations().probe({0, 0, -20}, 2).all, [&](unsigned period) {
    if (period == 1000) bench.post(TRAMMEL_ABORT);
  });
  EXPECT_EQ(bench.status.probes, 1U) << "aborted before the edge: no result";
  EXPECT_GT(bench.status.pose[2], -20);
}

}  // namespace
}  // namespace trammel::linuxcnc
