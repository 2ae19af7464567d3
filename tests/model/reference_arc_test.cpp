// Tests of the statements about ARC in docs/reference/behaviour.md and about ARC_CHORD in commands.md, on the golden
// model of the whole card, through its bus only.
#include <cmath>
#include <tuple>

#include "reference_page.hpp"
#include "trammel/driver/arc.hpp"

namespace trammel::reference_page {
namespace {

// The documented rule in plain integers.
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

// Runs an arc on the card; returns its steps, and FAULT in `fault`.
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

// With integer radii some steps start at F = 0, the tie.
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
  // A quarter of R = 25, counter-clockwise from (25, 0) to (0, 25): 50 steps and no change of sign, because zero is
  // positive.
  std::uint32_t fault = 0;
  const driver::ArcCommand good = arc(25, 0, 0, 25, 625, 0, false, 50);
  EXPECT_EQ(steps_of(good, fault).size(), 50U);
  EXPECT_EQ(fault, 0U);
  // path_ticks is only compared with the count; the prescaler determines the number of path ticks.
  driver::ArcCommand other = good;
  other.path_ticks = 1;
  EXPECT_EQ(steps_of(other, fault).size(), 50U);
  EXPECT_EQ(fault, 0U);
  // Surplus path ticks make no step. Too few path ticks: PATH_INCOMPLETE.
  other.prescale = good.prescale * 2;
  EXPECT_EQ(steps_of(other, fault).size(), 50U);
  EXPECT_EQ(fault, 0U);
  other.prescale = good.prescale / 2;
  EXPECT_EQ(steps_of(other, fault).size(), 25U);
  EXPECT_EQ(fault, field::kFaultPathIncomplete);
  // With Q too large the arc goes on round. With Q too small it goes straight to the end as soon as one coordinate has
  // the value of the end.
  other = good;
  other.quadrants = 1;
  steps_of(other, fault);
  EXPECT_EQ(fault, field::kFaultPathIncomplete);
  // To (-25, 0): x changes its sign, y ends at zero, which is positive.
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

// The documented arithmetic of ARC_CHORD.
class ChordWalk {
 public:
  explicit ChordWalk(const driver::ArcChordCommand& arc) : arc_(arc), x_(arc.x), y_(arc.y) {
    dy_ = next_dy();
    dx_ = next_dx();
  }

  // Increments at a path tick; call it for ticks 1, 2, ... in order.
  std::pair<std::int64_t, std::int64_t> at(std::uint64_t tick) {
    const std::uint64_t chord = std::uint64_t{1} << arc_.m;
    const std::uint64_t before = (tick - 1) % chord;
    if (before == chord / 2) dy_ = next_dy();
    if (before == 0 && tick != 1) dx_ = next_dx();
    if (tick == 1) return {arc_.first_x, arc_.first_y};
    return {dx_ + arc_.closing_x, dy_ + arc_.closing_y};
  }
  // Increments of the chords, without the closing increment.
  std::int64_t dx() const { return dx_; }
  std::int64_t dy() const { return dy_; }

 private:
  std::int64_t turned(std::int64_t value) const { return (value + (std::int64_t{1} << (arc_.k - 1))) >> arc_.k; }
  std::int64_t next_dy() {
    const std::int64_t dy = turned(x_) * (arc_.clockwise ? -1 : 1);
    y_ += dy;
    return dy;
  }
  std::int64_t next_dx() {
    const std::int64_t dx = turned(y_) * (arc_.clockwise ? 1 : -1);
    x_ += dx;
    return dx;
  }

  driver::ArcChordCommand arc_;
  std::int64_t x_;
  std::int64_t y_;
  std::int64_t dx_;
  std::int64_t dy_;
};

using Point = std::pair<std::int64_t, std::int64_t>;  // pulses

// A quarter turn around (0, 0) from the documented formulas alone; the third axis makes `further` pulses.
driver::ArcChordCommand quarter_about_origin(Point start, Point end, bool clockwise, std::uint8_t k,
                                             std::int64_t further) {
  constexpr double kQuarter = 1.5707963267948966;  // rad
  driver::ArcChordCommand arc;
  arc.mask = 0b111;
  arc.clockwise = clockwise;
  arc.k = k;
  arc.m = 6;
  const auto x = static_cast<double>(start.first);
  const auto y = static_cast<double>(start.second);
  const double radius = std::hypot(x, y);
  const double angle = std::atan2(y, x);
  const double half_chord = std::asin(std::ldexp(1, -k - 1));
  arc.x = std::llround(std::ldexp(radius * std::cos(angle), 40 - arc.m));
  arc.y = std::llround(std::ldexp(radius * std::sin(angle - (clockwise ? -1 : 1) * half_chord), 40 - arc.m));
  arc.path_ticks = static_cast<std::uint64_t>(std::llround(std::ldexp(kQuarter / (2 * half_chord), arc.m)));
  arc.ticks = 2 * arc.path_ticks;
  arc.prescale = kOnePulse / 2;
  ChordWalk walk(arc);
  arc.first_x = walk.dx();
  arc.first_y = walk.dy();
  Point sum{arc.first_x, arc.first_y};
  for (std::uint64_t tick = 2; tick <= arc.path_ticks; ++tick) {
    const Point by = walk.at(tick);
    sum = {sum.first + by.first, sum.second + by.second};
  }
  const auto share = [&arc](std::int64_t pulses, std::int64_t made) {
    return std::llround(static_cast<double>(pulses * kOnePulse - made) / static_cast<double>(arc.path_ticks));
  };
  arc.closing_x = share(end.first - start.first, sum.first);
  arc.closing_y = share(end.second - start.second, sum.second);
  arc.first_x += arc.closing_x;
  arc.first_y += arc.closing_y;
  arc.increment[2] = share(further, 0);
  return arc;
}

using Step = std::tuple<std::uint64_t, unsigned, int>;  // path tick, axis, direction

std::vector<Step> steps_of(const std::vector<PathStep>& path) {
  std::vector<Step> steps;
  for (const PathStep& step : path) steps.emplace_back(step.tick, step.axis, step.direction);
  std::sort(steps.begin(), steps.end());
  return steps;
}

std::vector<Step> steps_of(const driver::ArcChordCommand& arc) {
  std::vector<Step> steps;
  ChordWalk walk(arc);
  std::int64_t sums[3] = {};
  for (std::uint64_t tick = 1; tick <= arc.path_ticks; ++tick) {
    const Point by = walk.at(tick);
    const std::int64_t increments[3] = {by.first, by.second, arc.increment[2]};
    for (unsigned axis = 0; axis < 3; ++axis) {
      const auto position = [&] { return (sums[axis] + kOnePulse / 2) >> 40; };
      const std::int64_t before = position();
      sums[axis] += increments[axis];
      if (position() != before) steps.emplace_back(tick, axis, static_cast<int>(position() - before));
    }
  }
  return steps;
}

// One path tick per two feed ticks. Each axis steps in those path ticks in which the documented sums pass a pulse, and
// ends at the commanded position.
TEST(ReferencePage, AnArcInChordsTickForTick) {
  for (const bool clockwise : {false, true}) {
    for (const std::uint8_t k : {std::uint8_t{3}, std::uint8_t{5}}) {
      const int side = clockwise ? -1 : 1;
      const driver::ArcChordCommand arc = quarter_about_origin({30, 40}, {-40 * side, 30 * side}, clockwise, k, -7);
      Host host(4, model::RegisterFile::kMaxEngines);
      host.send(arc);
      host.send(feed(arc.ticks, 20));
      host.send(driver::EndCommand{});
      host.idle();
      EXPECT_EQ(host.read(reg::kFault), 0U);
      EXPECT_EQ(host.position(0), -40 * side - 30);
      EXPECT_EQ(host.position(1), 30 * side - 40);
      EXPECT_EQ(host.position(2), -7);
      const auto made = steps_of(host.path);
      EXPECT_GT(made.size(), 50U);
      EXPECT_EQ(made, steps_of(arc));
    }
  }
}

}  // namespace
}  // namespace trammel::reference_page
