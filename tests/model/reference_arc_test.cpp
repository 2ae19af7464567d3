// What docs/reference/behaviour.md says of ARC, tried on the golden model of the whole card over its bus alone.
#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "page_host.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/arc.hpp"
#include "trammel/driver/commands.hpp"

namespace {

using namespace trammel;
using trammel::testing::feed;
using trammel::testing::line;
using trammel::testing::PathStep;
using Host = trammel::testing::PageHost;
namespace reg = card_map::reg;
namespace field = card_map::field;

// The page's rule, in its own words, on plain integers.
struct Walk {
  std::int64_t f, gx, gy, hx, hy, left_x, left_y;
  int q;
  bool clockwise;
  bool straight = false;

  bool at_end() const { return q == 0 && left_x == 0 && left_y == 0; }
  std::pair<int, int> step() {
    const int turn = clockwise ? -1 : 1;
    const int sx = gy >= 0 ? -turn : turn;
    const int sy = gx >= 0 ? turn : -turn;
    if (q == 0 && (sx * left_x <= 0 || sy * left_y <= 0)) straight = true;
    std::pair<int, int> s{0, 0};
    if (straight) {
      if (left_x != 0)
        s.first = left_x > 0 ? 1 : -1;
      else
        s.second = left_y > 0 ? 1 : -1;
    } else {
      const bool x_to_zero = sx != (gx >= 0 ? 1 : -1);
      if (x_to_zero == (f >= 0))
        s.first = sx;
      else
        s.second = sy;
    }
    const bool x_sign = gx >= 0;
    const bool y_sign = gy >= 0;
    f += s.first * gx + s.second * gy + (s.first != 0 ? hx : hy);
    gx += 2 * s.first * hx;
    gy += 2 * s.second * hy;
    left_x -= s.first;
    left_y -= s.second;
    if (((gx >= 0) != x_sign || (gy >= 0) != y_sign) && q > 0) --q;
    return s;
  }
};

driver::ArcCommand arc(std::int32_t x, std::int32_t y, std::int32_t end_x, std::int32_t end_y, std::int64_t square,
                       unsigned q, bool clockwise, std::uint64_t path_ticks) {
  driver::ArcCommand result;
  result.clockwise = clockwise;
  result.quadrants = static_cast<std::uint16_t>(q);
  result.end_x = end_x - x;
  result.end_y = end_y - y;
  result.deviation = std::int64_t{x} * x + std::int64_t{y} * y - square;
  result.gradient_x = 2 * x;
  result.gradient_y = 2 * y;
  result.half_x = result.half_y = 1;
  result.path_ticks = path_ticks;
  return driver::with_ticks(result, 4 * path_ticks);
}

// The steps of an arc on the card; FAULT in `fault`.
std::vector<std::pair<int, int>> steps_of(const driver::ArcCommand& command, std::uint32_t& fault) {
  Host host;
  host.send(command);
  host.send(feed(command.ticks, 8));
  host.send(driver::EndCommand{});
  host.idle();
  fault = host.read(reg::kFault);
  std::vector<std::pair<int, int>> steps;
  for (const PathStep& step : host.path) {
    steps.emplace_back(step.axis == 0 ? step.direction : 0, step.axis == 1 ? step.direction : 0);
  }
  return steps;
}

Walk walk_of(const driver::ArcCommand& a) {
  return {static_cast<std::int64_t>(a.deviation),
          static_cast<std::int64_t>(a.gradient_x),
          static_cast<std::int64_t>(a.gradient_y),
          static_cast<std::int64_t>(a.half_x),
          static_cast<std::int64_t>(a.half_y),
          a.end_x,
          a.end_y,
          a.quadrants,
          a.clockwise};
}

// Integer radii put F = 0, the tie, on the way.
TEST(ReferencePage, TheArcRuleStepForStep) {
  for (const bool clockwise : {false, true}) {
    for (const int radius : {5, 13, 25}) {
      const unsigned steps = 8 * static_cast<unsigned>(radius);
      const driver::ArcCommand full = arc(radius, 0, radius, 0, radius * radius, 4, clockwise, steps);
      std::uint32_t fault = 0;
      const auto made = steps_of(full, fault);
      EXPECT_EQ(fault, 0U);
      ASSERT_EQ(made.size(), steps);
      Walk walk = walk_of(full);
      bool ties = false;
      for (const auto& step : made) {
        ties = ties || walk.f == 0;
        EXPECT_EQ(step, walk.step());
      }
      EXPECT_TRUE(walk.at_end());
      EXPECT_TRUE(ties);
    }
  }
}

TEST(ReferencePage, WhatWrongNumbersOfAnArcDo) {
  // A quarter of R = 25, counter-clockwise from (25, 0) to (0, 25): 50 steps and no change of sign, as zero is
  // positive.
  std::uint32_t fault = 0;
  const driver::ArcCommand good = arc(25, 0, 0, 25, 625, 0, false, 50);
  EXPECT_EQ(steps_of(good, fault).size(), 50U);
  EXPECT_EQ(fault, 0U);
  // path_ticks is only compared with the count; the prescaler decides how many there are.
  driver::ArcCommand other = good;
  other.path_ticks = 1;
  EXPECT_EQ(steps_of(other, fault).size(), 50U);
  EXPECT_EQ(fault, 0U);
  // Too many path ticks: those at the end make no step. Too few: PATH_INCOMPLETE.
  other.prescale = good.prescale * 2;
  EXPECT_EQ(steps_of(other, fault).size(), 50U);
  EXPECT_EQ(fault, 0U);
  other.prescale = good.prescale / 2;
  EXPECT_EQ(steps_of(other, fault).size(), 25U);
  EXPECT_EQ(fault, field::kFaultPathIncomplete);
  // Q too large: it goes on round; too small: straight to the end as soon as one coordinate has reached the end's.
  other = good;
  other.quadrants = 1;
  steps_of(other, fault);
  EXPECT_EQ(fault, field::kFaultPathIncomplete);
  // On to (-25, 0): x changes its sign, y ends at zero, which is positive.
  const driver::ArcCommand half = arc(25, 0, -25, 0, 625, 1, false, 100);
  EXPECT_EQ(steps_of(half, fault).size(), 100U);
  EXPECT_EQ(fault, 0U);
  other = half;
  other.quadrants = 0;
  const auto straight = steps_of(other, fault);
  EXPECT_EQ(fault, 0U);
  EXPECT_EQ(straight.size(), 50U);
  for (const auto& step : straight) EXPECT_EQ(step, (std::pair<int, int>{-1, 0}));
}

}  // namespace
