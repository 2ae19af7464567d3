// Compares the path server with the runner on the same programs. Pauses, aborts, overrides, refusals, coordinates.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "path_bench.hpp"
#include "random.hpp"

namespace trammel::linuxcnc {
namespace {

using ::testing::HasSubstr;

// Lines, arcs in three planes, a helix, full circles and each kind of path control, as text and as LinuxCNC's
// operations.
struct BothWays {
  Operations operations;
  std::string text;
};

BothWays every_kind() {
  BothWays both;
  both.operations.rapid({8, 3})
      .feed({10, 4, 1}, 50)
      .arc({14, 8, 1}, {14, 4, 1}, 2, -1, 40)
      .arc({14, 8, 1}, {14, 5, 1}, 2, 1, 40)
      .arc({10, 12, 3}, {10, 8, 1}, 2, 0, 60)
      .control(TRAMMEL_EXACT_PATH)
      .arc({12, 12, 5}, {12, 12, 3}, 1, 0, 20)
      .arc({12, 14, 7}, {12, 14, 5}, 0, -1, 20)
      .control(TRAMMEL_EXACT_STOP)
      .feed({2, 9.3, 1.7}, 50)
      .control(TRAMMEL_BLEND, 0.1)
      .feed({30, 9.3, 1.7}, 100)
      .feed({30, 20, 1.7}, 100)
      .control(TRAMMEL_BLEND)
      .rapid({});
  both.text =
      "G64 G0 X8 Y3\nG1 X10 Y4 Z1 F3000\nG2 X14 Y8 I4 J0 F2400\nG3 J-3 I0 X14 Y8 P2\nG3 X10 Y12 Z3 I-4 J0 F3600\n"
      "G61 G18 G3 X12 Z5 I2 K0 F1200\nG19 G2 Y14 Z7 J2 K0\nG61.1 G17\nG1 X2 Y9.3 Z1.7 F3000\nG64 P0.1\n"
      "G1 X30 F6000\nY20\nG64\nG0 X0 Y0 Z0\nM2\n";
  return both;
}

TEST(PathServer, MakesTheStepsOfTheRunner) {
  PathBench bench;
  const BothWays both = every_kind();
  bench.run(both.operations.all);
  EXPECT_EQ(bench.status.refusals, 0U) << bench.status.text;
  const auto expected = runner_path(both.text, bench.machine);
  ASSERT_GT(expected.size(), 5000U);
  EXPECT_TRUE(path_of(bench.steps) == expected);
  EXPECT_EQ(bench.status.segments_begun, both.operations.segments);
  EXPECT_EQ(bench.status.pose[0], 0);
}

// Programs of random lines and arcs, with more operations than the look-ahead holds.
TEST(PathServer, RandomProgramsMakeTheStepsOfTheRunner) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    BothWays both;
    both.text = "G64\n";
    double x = 0;
    double y = 0;
    for (int n = 0; n < 90; ++n) {
      const double next_x = std::round(random.uniform(-0.3, 0.3) * 1000) / 1000;
      const double next_y = std::round(random.uniform(-0.3, 0.3) * 1000) / 1000;
      if (random.below(3) == 0) {
        const double i = (next_x - x) / 2;
        const double j = (next_y - y) / 2;
        const bool clockwise = random.below(2) == 0;
        both.operations.arc({next_x, next_y}, {x + i, y + j, 0}, 2, clockwise ? -1 : 0, 100);
        both.text +=
            fmt::format("G{} X{:.4f} Y{:.4f} I{:.6f} J{:.6f} F6000\n", clockwise ? 2 : 3, next_x, next_y, i, j);
      } else {
        both.operations.feed({next_x, next_y}, 100);
        both.text += fmt::format("G1 X{:.4f} Y{:.4f} F6000\n", next_x, next_y);
      }
      x = next_x;
      y = next_y;
    }
    machine::Machine machine = machine::default_machine();
    machine.motion.window = 40;
    PathBench bench(machine);
    bench.run(both.operations.all);
    EXPECT_EQ(bench.status.refusals, 0U) << bench.status.text;
    EXPECT_EQ(bench.under_runs, 0U);
    EXPECT_TRUE(path_of(bench.steps) == runner_path(both.text + "M2\n", bench.machine));
  }
}

TEST(PathServer, PauseHoldsOnThePath) {
  PathBench whole;
  whole.run(long_way().all);
  PathBench bench;
  double held_from = 0;
  double held_to = 0;
  bench.run(long_way().all, [&](unsigned period) {
    if (period == 1000) bench.post(TRAMMEL_PAUSE);
    if (period == 1300) held_from = bench.seconds();
    if (period == 2600) held_to = bench.seconds();
    if (period == 2600) bench.post(TRAMMEL_RESUME);
  });
  EXPECT_TRUE(path_of(bench.steps) == path_of(whole.steps));
  ASSERT_GT(held_to, held_from + 1);
  for (const driver::PinStep& step : bench.steps.pins) {
    const double at = static_cast<double>(step.cycle) / kPathClock;
    ASSERT_TRUE(at < held_from || at > held_to) << at;
  }
}

TEST(PathServer, AbortStopsOnThePathAndTheNextMotionBeginsThere) {
  PathBench whole;
  whole.run(long_way().all);
  PathBench bench;
  std::uint64_t asked = 0;
  bench.run(long_way().all, [&](unsigned period) {
    if (period != 2000) return;
    asked = bench.engine->cycles();
    bench.post(TRAMMEL_ABORT);
  });
  const auto made = path_of(bench.steps);
  const auto all = path_of(whole.steps);
  ASSERT_LT(made.size(), all.size());
  EXPECT_TRUE(std::equal(made.begin(), made.end(), all.begin()));
  EXPECT_LT(bench.steps.pins.back().cycle, asked + kPathClock * 3 / 10) << "a ramp, not the end of the queue";
  EXPECT_EQ(bench.status.pose[0] * kPathPulses, bench.steps.position(0));
  EXPECT_EQ(bench.status.pose[1] * kPathPulses, bench.steps.position(1));
  bench.run(Operations().rapid({1, 2, 3}).all);
  EXPECT_EQ(bench.steps.position(0), 80);
  EXPECT_EQ(bench.steps.position(1), 160);
  EXPECT_EQ(bench.steps.position(2), 240);
  EXPECT_EQ(bench.status.refusals, 0U) << bench.status.text;
}

TEST(PathServer, OverridesActOnTheCardsRatio) {
  const auto run_at = [](double feed, unsigned from) {
    machine::Machine machine = machine::default_machine();
    machine.motion.max_override = 1.2;
    PathBench bench(machine);
    bench.run(long_way().all, [&](unsigned period) { bench.scales(period >= from ? feed : 1, 1); });
    EXPECT_EQ(bench.steps.position(1), 8 * kPathPulses);
    return static_cast<double>(bench.steps.pins.back().cycle - bench.steps.pins.front().cycle) / kPathClock;
  };
  const double whole = run_at(1, 0);
  EXPECT_NEAR(run_at(0.5, 0), 2 * whole, 0.02 * whole);
  EXPECT_NEAR(run_at(1.2, 0), whole / 1.2, 0.02 * whole);
  EXPECT_NEAR(run_at(9, 0), whole / 1.2, 0.02 * whole) << "no more than the machine's max_override";
}

TEST(PathServer, AFeedOfZeroHolds) {
  PathBench bench;
  std::size_t before = 0;
  bench.run(long_way().all, [&](unsigned period) {
    bench.scales(period >= 1000 && period < 2000 ? 0 : 1, period >= 1000 && period < 2000 ? 0 : 1);
    if (period == 1400) before = bench.steps.pins.size();
    if (period == 1999) {
      EXPECT_EQ(bench.steps.pins.size(), before);
    }
  });
  EXPECT_EQ(bench.steps.position(1), 8 * kPathPulses);
}

TEST(PathServer, RefusesByNameAndGoesOnAfterAnAbort) {
  PathBench bench;
  Operations bad;
  bad.feed({5}, 50).feed({5, 0, 0, 90}, 50).feed({9}, 50);
  bench.run(bad.all, [&](unsigned period) {
    if (period == 500) bench.post(Operations().feed({8}, 50).all.front());
    if (period < 1000) bench.post(TRAMMEL_RESUME);
  });
  EXPECT_EQ(bench.status.refusals, 1U);
  EXPECT_EQ(bench.status.refusal, 2);
  EXPECT_THAT(std::string(bench.status.text), HasSubstr("axis A"));
  EXPECT_EQ(bench.steps.position(0), 400) << "what stands before it is made, what comes behind it is not";
  bench.post(TRAMMEL_ABORT);
  bench.run(Operations().feed({6}, 50).all);
  EXPECT_EQ(bench.steps.position(0), 480);
  bench.run(Operations().probe({0}, 50).all);
  EXPECT_EQ(bench.status.refusals, 2U);
  EXPECT_THAT(std::string(bench.status.text), HasSubstr("probe"));
  EXPECT_EQ(std::string(bench.status.text).find("linuxcnc"), std::string::npos);
}

TEST(PathServer, APoseIsSnappedToThePulsesAndDoesNotDrift) {
  PathBench bench;
  bench.post(TRAMMEL_SET_POSE, {100, -50.003});
  bench.run({});
  EXPECT_EQ(bench.status.pose[0], 100);
  EXPECT_EQ(bench.status.pose[1], -50);
  for (int jog = 0; jog < 100; ++jog) {
    bench.post(TRAMMEL_SET_POSE, {100 + 0.6 / kPathPulses, -50 - 0.6 / kPathPulses});
    bench.run({});
    ASSERT_EQ(bench.status.pose[0], 100);
  }
  bench.run(Operations().rapid({101, -50}).all);
  EXPECT_EQ(bench.steps.position(0), 80);
  EXPECT_EQ(bench.steps.position(1), 0);
}

TEST(PathServer, Inches) {
  PathBench bench(machine::default_machine(), PathUnits::kInches);
  bench.run(Operations().feed({1, 2}, 2).arc({1, 2}, {1.5, 2, 0}, 2, 0, 2).all);
  EXPECT_EQ(bench.status.refusals, 0U) << bench.status.text;
  EXPECT_EQ(bench.steps.position(0), 2032);
  EXPECT_EQ(bench.steps.position(1), 4064);
  EXPECT_EQ(bench.status.pose[1], 2);
}

// The owner is told to end because the machine was switched off.
TEST(PathServer, EndsAtRestWhenItIsToldTo) {
  PathBench bench;
  for (const trammel_operation& operation : long_way().all) bench.post(operation);
  unsigned periods = 0;
  bench.server.serve([&] { return ++periods < 1000; });
  EXPECT_FALSE(bench.card.busy());
  EXPECT_GT(bench.steps.pins.size(), 100U);
  EXPECT_LT(bench.steps.position(1), 7.5 * kPathPulses);
}

TEST(PathServer, RefusesOtherKinematics) {
  machine::Machine machine = machine::default_machine();
  machine.kinematics.name = "corexy";
  EXPECT_THROW(PathBench{machine}, std::invalid_argument);
}

// Outputs switch in the clock in which the motion before them ends, without a stop. M64 and M65 switch after a stop.
TEST(PathServer, SwitchesOutputsInTheirPlaces) {
  machine::Machine machine = machine::default_machine();
  machine::apply_override(machine, "outputs.p1=3");
  PathBench bench(machine);
  Operations operations;
  operations.feed({1}, 20).feed({2}, 20).feed({3}, 20).command(TRAMMEL_SWITCH).feed({4}, 20);
  const auto switches = [&](std::size_t n, bool on) {
    operations.all[n].outputs = 6;
    operations.all[n].levels = on ? 6 : 0;
  };
  switches(1, true);
  switches(2, false);
  switches(3, true);
  bench.run(operations.all);
  EXPECT_EQ(bench.status.refusals, 0U) << bench.status.text;
  EXPECT_EQ(bench.status.segments_begun, 4U);
  ASSERT_EQ(bench.steps.outputs.size(), 3U);
  const auto cycle_of = [&](std::size_t step) { return bench.steps.path.at(step).cycle; };
  constexpr double kBetweenSteps = kPathClock / (20 * kPathPulses);
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
    const driver::OutputChange& change = bench.steps.outputs[n];
    EXPECT_EQ(change.levels, n == 1 ? 0 : 8) << n;
    const std::size_t before = 80 * (n + 1);
    EXPECT_GT(change.cycle, cycle_of(before - 1)) << n;
    EXPECT_LT(change.cycle, cycle_of(before)) << n;
    const double gap = static_cast<double>(cycle_of(before) - cycle_of(before - 1));
    EXPECT_EQ(gap < 1.1 * kBetweenSteps, n < 2) << n << ": " << gap;
  }
}

}  // namespace
}  // namespace trammel::linuxcnc
