// The 8-direction rule of the accumulator against the method of minimum deviation: two forms of one rule, with the same
// steps on circles of whole radius.
#include <gtest/gtest.h>

#include <cstdint>

#include "trammel/interpolation/conic_arc.hpp"
#include "trammel/model/deviation_accumulator.hpp"

namespace trammel::interpolation {
namespace {

TEST(CardsRule, TakesTheStepsOfMinimumDeviation) {
  using model::DeviationPath;
  std::uint64_t steps = 0;
  for (std::int64_t r = 1; r <= 1000; ++r) {
    for (const bool clockwise : {false, true}) {
      MinDeviationCircle method(make_circle(r, clockwise));
      DeviationPath card;
      card.state.gradient_x = static_cast<DeviationPath::Word>(2 * r) << DeviationPath::kAlign;
      card.state.half_x = card.state.half_y = 1;
      card.state.quadrants = 4;
      card.state.clockwise = clockwise;
      card.state.eight_directions = true;
      card.begin();
      while (!method.done()) {
        ASSERT_FALSE(card.at_end()) << "r " << r;
        const Step theirs = method.next();
        const DeviationPath::Step ours = card.step();
        ASSERT_EQ(theirs.direction[0], ours.in_x ? (ours.negative_x ? -1 : 1) : 0) << "r " << r;
        ASSERT_EQ(theirs.direction[1], ours.in_y ? (ours.negative_y ? -1 : 1) : 0) << "r " << r;
        ++steps;
      }
      ASSERT_TRUE(card.at_end()) << "r " << r;
    }
  }
  EXPECT_GT(steps, 5'000'000u);  // 4 sqrt(2) R per circle
}

}  // namespace
}  // namespace trammel::interpolation
