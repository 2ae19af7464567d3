// Properties of the card that the plan uses: classes of pieces, shifts of the slew, engines.
#include "trammel/planner/card_limits.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "plan.hpp"

namespace trammel::planner {
namespace {

std::vector<driver::FeedCommand> pieces_of(const Plan& plan, std::size_t line) {
  std::vector<driver::FeedCommand> found;
  for (const Planned& block : plan.blocks) {
    if (block->line != line) continue;
    for (const driver::FeedCommand& piece : commands<driver::FeedCommand>(block)) found.push_back(piece);
  }
  return found;
}

TEST(PieceClasses, TellRapidsWhereTheCardHasThem) {
  for (const bool classes : {false, true}) {
    CardLimits card = kCard;
    card.classes = classes;
    const Plan plan = plan_text("G1 X30 F6000\nG0 X60\nG1 X90\n", machine::default_machine(), card);
    for (const std::size_t line : {1U, 2U, 3U}) {
      const auto pieces = pieces_of(plan, line);
      ASSERT_FALSE(pieces.empty()) << line;
      const auto expected = classes && line == 2 ? driver::PieceClass::kRapid : driver::PieceClass::kFeed;
      for (const driver::FeedCommand& piece : pieces) EXPECT_EQ(piece.piece_class, expected) << line;
    }
  }
}

// The shift of the longest piece. A hold may use half of each axis's 1,000 mm/s^2 (machine::hold_share()), and the card
// takes hold_clocks() from full rate to rest. A hold from `full` mm/s along an axis uses all of this half. Each halving
// of the speed allows a shift by one more.
TEST(SlewShifts, AreAsLargeAsTheAxesAllow) {
  const double full = 500 * hold_clocks(machine::default_machine(), kClock) / kClock;
  EXPECT_NEAR(full, 150, 10);
  const auto shift = [](const std::string& move, double speed, bool shifts = true) {
    CardLimits card = kCard;
    card.classes = true;
    card.slew_shifts = shifts;
    const Plan plan = plan_text(fmt::format("F{:.3f}\n{}\n", 60 * speed, move), machine::default_machine(), card);
    const auto pieces = pieces_of(plan, 2);
    const auto longer = [](const driver::FeedCommand& a, const driver::FeedCommand& b) { return a.ticks < b.ticks; };
    return static_cast<int>(std::max_element(pieces.begin(), pieces.end(), longer)->slew_shift);
  };
  for (int doublings = 1; doublings <= 3; ++doublings) {
    const double speed = full / (1 << doublings);
    EXPECT_EQ(shift("G1 X100", 0.99 * speed), doublings);
    EXPECT_EQ(shift("G1 X100", 1.01 * speed), doublings - 1);
    EXPECT_EQ(shift("G1 X100 Y100", 0.99 * std::sqrt(2) * speed), doublings) << "each axis has 0.7 of it";
    EXPECT_EQ(shift("G1 X100 Y100", 1.01 * std::sqrt(2) * speed), doublings - 1);
    EXPECT_EQ(shift("G2 I28 J28", 0.99 * speed), doublings) << "an arc turns into each direction, X alone too";
    EXPECT_EQ(shift("G2 I28 J28", 1.01 * speed), doublings - 1);
  }
  EXPECT_EQ(shift("G1 X100", 1), 3) << "the most that there is";
  EXPECT_EQ(shift("G1 X100", 1, false), 0) << "a card without them";
}

TEST(CardLimits, AreThoseOfTheCardsIdentification) {
  driver::Identification card;
  card.clock_hz = 50'000'000;
  card.axes = 6;
  card.geometry_depth = 1000;
  card.feed_depth = 500;
  const CardLimits bare = limits_of(card);
  EXPECT_EQ(bare.clock_hz, 50'000'000U);
  EXPECT_EQ(bare.axes, 6U);
  EXPECT_EQ(bare.geometry_depth, 1000U);
  EXPECT_EQ(bare.feed_depth, 500U);
  const auto flags = [](const CardLimits& limits) {
    return std::vector<bool>{limits.accumulator,      limits.classes,      limits.arc_generator,
                             limits.eight_directions, limits.outputs != 0, limits.pwm};
  };
  EXPECT_EQ(flags(bare), std::vector<bool>(6, false));
  EXPECT_FALSE(bare.slew_shifts);
  namespace engine = card_map::engine;
  const unsigned engines[] = {engine::kAccumulator,  engine::kClasses,      engine::kArcGenerator,
                              engine::kAccumulator8, engine::kPathCommands, engine::kPwm};
  for (std::size_t i = 0; i < std::size(engines); ++i) {
    card.engines = 1U << engines[i];
    std::vector<bool> expected(6, false);
    expected[i] = true;
    EXPECT_EQ(flags(limits_of(card)), expected) << i;
  }
  EXPECT_EQ(limits_of(card).outputs, 0U);
  card.engines = 1U << engine::kPathCommands;
  EXPECT_EQ(limits_of(card).outputs, machine::kMaxOutputs);
}

}  // namespace
}  // namespace trammel::planner
