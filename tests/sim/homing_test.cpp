// Homing on the RTL, in lockstep with the model.
#include "trammel/run/homing.hpp"

#include <gtest/gtest.h>

#include "homing_bench.hpp"
#include "trammel/sim/engines.hpp"

namespace trammel::run {
namespace {

TEST(HomingOnTheRtl, FindsTheEdgeWithinAPulse) {
  sim::SimulationOptions options;
  options.axes = 5;
  options.clock_hz = kHomingClock;
  HomingBench bench;
  bench.begin(homing_machine(), {1200, 0, 0, 0, 0}, sim::make_engine(options));
  bench.bus().add({0, 0, 1000, -1, 1'000'000, 200});
  const std::vector<HomedAxis> homed = bench.home({0});
  ASSERT_EQ(homed.size(), 1U);
  EXPECT_NEAR(static_cast<double>(bench.bus().places()[0] - 1000), 6 * HomingBench::kPerMm, 1);
  EXPECT_NEAR(homed[0].search_edge, homed[0].edge, 1.01 / HomingBench::kPerMm);
  EXPECT_EQ(bench.card().read_place().homed, 1);
  EXPECT_GT(bench.engine().lockstep_cycles().value_or(0), 500'000U);
}

}  // namespace
}  // namespace trammel::run
