// Blocks shorter than a pulse, between others: they must neither stop the machine nor cost time.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "plan.hpp"

namespace trammel::planner {
namespace {

constexpr double kBackwards = -0.999;  // cosine of the angle between two motions: the second one goes back

// Moves of some millimetres and of 0.004 mm, in X and Y or in Z alone.
std::string mixed_program(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto tiny = [&] { return 0.004 * (static_cast<double>(random() % 5) - 2) / 2; };
  const auto wide = [&] { return (static_cast<double>(random() % 2001) - 1000) / 1000; };
  std::string text = "G64 G1 F1000\n";
  double x = 0;
  double y = 0;
  double z = 0;
  for (unsigned i = 0; i < 60; ++i) {
    const auto kind = random() % 10;
    x += kind < 5 ? tiny() : kind < 8 ? wide() : 0;
    y += kind < 5 ? tiny() : kind < 8 ? wide() : 0;
    z += kind < 8 ? 0 : random() % 2 == 0 ? tiny() : wide();
    text += fmt::format("G1 X{:.4f} Y{:.4f} Z{:.4f}\n", x, y, z);
  }
  return text;
}

// A raster over heights: blocks of 0.004 mm along X, with Z where the height changes slowly; walls as moves of Z alone;
// a step of 0.004 mm in Y at the end of each row.
std::string relief(std::uint64_t seed) {
  constexpr double kStep = 0.004;
  std::mt19937_64 random(seed);
  const auto share = [&] { return static_cast<double>(random() % 1'000'001) / 1e6; };
  const double first = 6 * share();
  const double second = 6 * share();
  std::string text = "G64 G1 F1000\n";
  double x = 0;
  double wall = 0;
  for (int row = 0; row < 6; ++row) {
    const double y = kStep * row;
    text += fmt::format("Y{:.4f}\n", y);
    for (int column = 0; column < 120; ++column) {
      x += row % 2 == 0 ? kStep : -kStep;
      const double z = wall + 0.05 * std::sin(40 * x + first) + 0.03 * std::sin(200 * x + second);
      text += fmt::format("X{:.4f} Z{:.4f}\n", x, z);
      if (random() % 25 != 0) continue;
      const double change = (wall == 0 ? 0.1 + 0.4 * share() : 0) - wall;
      wall += change;
      text += fmt::format("Z{:.4f}\n", z + change);
    }
  }
  return text + "M2\n";
}

Plan plan_at(const std::string& text, double steps_per_mm, double jerk = 0) {
  const std::string steps = fmt::format("steps_per_mm={}", steps_per_mm);
  machine::Machine machine = machine_with({"axis.x." + steps, "axis.y." + steps, "axis.z." + steps});
  for (machine::MachineAxis& axis : machine.axes) axis.max_jerk = jerk;
  return plan_text(text, machine, kCard);
}

double seconds(const Plan& plan) {
  double sum = 0;
  for (const Planned& block : plan.blocks) sum += block.planned.seconds;
  return sum;
}

// Stops between two motions of which the second does not go back.
unsigned needless_stops(const Plan& plan) {
  unsigned stops = 0;
  for (std::size_t i = 0; i + 1 < plan.blocks.size(); ++i) {
    const Block& to = plan.blocks[i + 1].planned.block;
    if (!plan.blocks[i].planned.stop || !moves(to)) continue;
    double cosine = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) cosine += plan.blocks[i]->exit[axis] * to.entry[axis];
    stops += cosine > kBackwards ? 1U : 0U;
  }
  return stops;
}

// The machine with few steps/mm drops the blocks without a pulse. It stops only where the motion after them goes back.
// The machine with many steps/mm moves slowly around the same place and is not faster.
TEST(ShortBlocks, StopOnlyWhereTheWayGoesBack) {
  unsigned stops = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const std::string text = mixed_program(seed);
    const Plan coarse = plan_at(text, 80);
    const Plan fine = plan_at(text, 400);
    ASSERT_FALSE(coarse.error) << gcode::describe(*coarse.error);
    EXPECT_EQ(needless_stops(coarse), 0U) << "seed " << seed;
    EXPECT_LE(seconds(coarse), 1.001 * seconds(fine)) << "seed " << seed;
    for (const Planned& block : coarse.blocks) stops += block.planned.stop ? 1U : 0U;
  }
  EXPECT_GT(stops, 130U);
}

// A wall up, a block without a pulse and a wall down make two corners and not a reversal. If each block has pulses,
// steps/mm do not change the time. With fewer steps/mm, blocks are joined, so that their corners are farther apart and
// may be passed faster.
TEST(ShortBlocks, AReliefStopsAtItsEndAloneWhateverThePulse) {
  double least = 1;
  double worst = 0;
  for (const double jerk : {0.0, 50'000.0}) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      const std::string text = relief(seed);
      const double fine = seconds(plan_at(text, 400, jerk));
      for (const double steps_per_mm : {20.0, 80.0, 2000.0}) {
        const Plan plan = plan_at(text, steps_per_mm, jerk);
        ASSERT_FALSE(plan.error) << gcode::describe(*plan.error);
        const auto stops = std::count_if(plan.blocks.begin(), plan.blocks.end(),
                                         [](const Planned& block) { return block.planned.stop; });
        EXPECT_EQ(stops, 1) << "seed " << seed << " steps/mm " << steps_per_mm << " jerk " << jerk;
        const double share = seconds(plan) / fine;
        EXPECT_LE(share, 1.001) << "seed " << seed << " steps/mm " << steps_per_mm << " jerk " << jerk;
        if (steps_per_mm == 80) least = std::min(least, share);
        if (steps_per_mm == 2000) worst = std::max(worst, std::abs(share - 1));
      }
    }
  }
  EXPECT_LE(worst, 0.001);
  EXPECT_GE(least, 0.8);
  RecordProperty("least_at_80", fmt::format("{:.4f}", least));
  RecordProperty("worst_at_2000", fmt::format("{:.6f}", worst));
}

// A dwell, an exact stop or a reversal between the two moves stops the motion, as it does with more pulses.
TEST(ShortBlocks, WaysRoundDoNotPassWhatStops) {
  const auto stops = [](const std::string& between, double steps_per_mm) {
    const Plan plan = plan_at("G64 G1 F1000 Z1\n" + between + "Z0\nM2\n", steps_per_mm);
    return std::count_if(plan.blocks.begin(), plan.blocks.end(), [](const Planned& one) { return one.planned.stop; });
  };
  for (const double steps_per_mm : {80.0, 2000.0}) {
    EXPECT_EQ(stops("X0.004\n", steps_per_mm), 1);
    EXPECT_EQ(stops("X0.002\nX0.004 Y0.002\n", steps_per_mm), 1);
    EXPECT_EQ(stops("", steps_per_mm), 2);
    EXPECT_EQ(stops("X0.004\nG4 P0.1\n", steps_per_mm), 2);
    EXPECT_GE(stops("X0.004\nX0\n", steps_per_mm), 2);
    EXPECT_GE(stops("G61\nX0.004\n", steps_per_mm), 2);
    EXPECT_GE(stops("G61.1\nX0.004\n", steps_per_mm), 2);
  }
}

}  // namespace
}  // namespace trammel::planner
