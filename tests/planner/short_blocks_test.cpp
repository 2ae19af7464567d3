// Blocks shorter than a pulse between others: they neither stop the machine nor cost time.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "plan.hpp"

namespace trammel::planner {
namespace {

constexpr double kBackwards = -0.999;  // cosine of the angle between two motions: the second one goes back

// Moves of mm and of 0.004 mm, in XY and of Z alone.
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

Plan plan_at(const std::string& text, double steps_per_mm) {
  const std::string steps = fmt::format("steps_per_mm={}", steps_per_mm);
  return plan_text(text, machine_with({"axis.x." + steps, "axis.y." + steps, "axis.z." + steps}), kCard);
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

// The machine with few steps drops the blocks without a pulse. Where a motion goes back after them it stops, and there
// alone; the one with many steps creeps round the same place and is no quicker.
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

}  // namespace
}  // namespace trammel::planner
