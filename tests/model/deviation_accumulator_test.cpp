// The golden model of the deviation accumulator against the tables of the source papers and the circle itself.
#include "trammel/model/deviation_accumulator.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>

#include "trammel/skip/path_engines.hpp"

namespace trammel::model {
namespace {

using Inputs = DeviationAccumulator::Inputs;
using State = DeviationPath::State;
__extension__ typedef __int128 int128;

DeviationPath::Word aligned(int128 value) { return static_cast<DeviationPath::Word>(value) << DeviationPath::kAlign; }

int128 value_of(DeviationPath::Word word) { return static_cast<int128>(word) >> DeviationPath::kAlign; }

// F = x^2 + y^2 - n around a centre in whole pulses.
State circle(std::int32_t x, std::int32_t y, std::int64_t n, std::int32_t end_x, std::int32_t end_y,
             std::uint16_t quadrants, bool clockwise) {
  State state;
  state.deviation = aligned(static_cast<int128>(x) * x + static_cast<int128>(y) * y - n);
  state.gradient_x = aligned(2 * x);
  state.gradient_y = aligned(2 * y);
  state.half_x = 1;
  state.half_y = 1;
  state.left_x = static_cast<std::uint32_t>(end_x - x);
  state.left_y = static_cast<std::uint32_t>(end_y - y);
  state.quadrants = quadrants;
  state.clockwise = clockwise;
  return state;
}

// The line of STEER as a conic without second differences. STEER steps in x when F > 0, the table when F >= 0;
// therefore F starts one lower here.
State line(std::int32_t dx, std::int32_t dy) {
  State state;
  state.deviation = aligned(std::abs(dx) - std::abs(dy) - 1);
  state.gradient_x = aligned(dx > 0 ? -std::abs(dy) : std::abs(dy));
  state.gradient_y = aligned(dy > 0 ? std::abs(dx) : -std::abs(dx));
  state.left_x = static_cast<std::uint32_t>(dx);
  state.left_y = static_cast<std::uint32_t>(dy);
  state.clockwise = (dx > 0) == (dy > 0);
  return state;
}

class DeviationRig {
 public:
  void load(const State& state) {
    for (int i = 0; i < 5; ++i)
      shift(load_target::kDeviation, static_cast<std::uint16_t>(state.deviation >> (48 + 16 * i)));
    for (int i = 0; i < 5; ++i)
      shift(load_target::kGradientX, static_cast<std::uint16_t>(state.gradient_x >> (48 + 16 * i)));
    for (int i = 0; i < 5; ++i)
      shift(load_target::kGradientY, static_cast<std::uint16_t>(state.gradient_y >> (48 + 16 * i)));
    for (int i = 0; i < 3; ++i) shift(load_target::kHalfX, static_cast<std::uint16_t>(state.half_x >> (16 * i)));
    for (int i = 0; i < 3; ++i) shift(load_target::kHalfY, static_cast<std::uint16_t>(state.half_y >> (16 * i)));
    for (int i = 0; i < 2; ++i) shift(load_target::kEndX, static_cast<std::uint16_t>(state.left_x >> (16 * i)));
    for (int i = 0; i < 2; ++i) shift(load_target::kEndY, static_cast<std::uint16_t>(state.left_y >> (16 * i)));
    shift(load_target::kQuadrants, state.quadrants);
    shift(load_target::kPlane, state.clockwise ? 1 : 0);
    Inputs in;
    in.start = true;
    block.clock(in);
    while (!block.outputs().ready) block.clock({});
  }

  // One path tick, until the block is ready again. Updates x and y; true when it made a step.
  bool tick() {
    Inputs in;
    in.tick = true;
    block.clock(in);
    int made = 0;
    for (;;) {
      const auto& out = block.outputs();
      if (out.step_x) x += out.dir_x ? -1 : 1;
      if (out.step_y) y += out.dir_y ? -1 : 1;
      made += (out.step_x ? 1 : 0) + (out.step_y ? 1 : 0);
      if (out.ready) break;
      block.clock({});
    }
    EXPECT_LE(made, 1);
    return made == 1;
  }

  DeviationAccumulator block;
  int x = 0;
  int y = 0;

 private:
  void shift(unsigned chain, std::uint16_t word) {
    Inputs in;
    in.load = {true, static_cast<std::uint16_t>(chain), word};
    block.clock(in);
  }
};

// Goldberg & Goldberg, Table 1: the line (0,0) to (3,-7).
TEST(DeviationAccumulator, MakesGoldbergsLine) {
  constexpr std::array<int, 10> kDeviation = {-4, -1, 2, -5, -2, 1, -6, -3, 0, 3};
  constexpr const char* kAxes = "yyxyyxyyyx";
  DeviationPath path;
  path.state = line(3, -7);
  path.begin();
  DeviationRig rig;
  rig.load(path.state);
  for (std::size_t i = 0; i < kDeviation.size(); ++i) {
    EXPECT_EQ(value_of(path.state.deviation) + 1, kDeviation[i]) << "row " << i;
    const auto step = path.step();
    EXPECT_EQ(step.in_x, kAxes[i] == 'x') << "row " << i;
    EXPECT_EQ(step.in_x ? step.negative_x : step.negative_y, !step.in_x) << "row " << i;
    const int x = rig.x + (step.in_x ? 1 : 0);
    const int y = rig.y - (step.in_x ? 0 : 1);
    ASSERT_TRUE(rig.tick());
    EXPECT_EQ(rig.x, x);
    EXPECT_EQ(rig.y, y);
  }
  EXPECT_TRUE(path.at_end());
  EXPECT_TRUE(rig.block.outputs().at_end);
  EXPECT_FALSE(rig.tick());
}

// Every line that moves both axes, against the loop of STEER: a step in x when F > 0.
TEST(DeviationAccumulator, MakesSteersLinesStepByStep) {
  for (int dx = -24; dx <= 24; ++dx) {
    for (int dy = -24; dy <= 24; ++dy) {
      if (dx == 0 || dy == 0) continue;
      DeviationPath path;
      path.state = line(dx, dy);
      path.begin();
      int f = std::abs(dx) - std::abs(dy);
      for (int i = 0; i < std::abs(dx) + std::abs(dy); ++i) {
        ASSERT_FALSE(path.at_end());
        const auto step = path.step();
        ASSERT_EQ(step.in_x, f > 0) << dx << ' ' << dy << " step " << i;
        ASSERT_NE(step.in_x, step.in_y);
        ASSERT_EQ(step.in_x ? step.negative_x : step.negative_y, (step.in_x ? dx : dy) < 0);
        f += f > 0 ? -std::abs(dy) : std::abs(dx);
      }
      ASSERT_TRUE(path.at_end());
    }
  }
}

struct CircleRow {
  int x, y, f, dx, dy;
};

// Goldberg & Goldberg, Table 3: r = 25 from (25,0), D = 0. Its last row prints x = 13, but F = 23 fits only (18,18).
constexpr std::array<CircleRow, 26> kTable3 = {{
    {25, 0, 0, 50, 0},    {24, 0, -49, 48, 0},   {24, 1, -48, 48, 2},   {24, 2, -45, 48, 4},   {24, 3, -40, 48, 6},
    {24, 4, -33, 48, 8},  {24, 5, -24, 48, 10},  {24, 6, -13, 48, 12},  {24, 7, 0, 48, 14},    {23, 7, -47, 46, 14},
    {23, 8, -32, 46, 16}, {23, 9, -15, 46, 18},  {23, 10, 4, 46, 20},   {22, 10, -41, 44, 20}, {22, 11, -20, 44, 22},
    {22, 12, 3, 44, 24},  {21, 12, -40, 42, 24}, {21, 13, -15, 42, 26}, {21, 14, 12, 42, 28},  {20, 14, -29, 40, 28},
    {20, 15, 0, 40, 30},  {19, 15, -39, 38, 30}, {19, 16, -8, 38, 32},  {19, 17, 25, 38, 34},  {18, 17, -12, 36, 34},
    {18, 18, 23, 36, 36},
}};

TEST(DeviationAccumulator, MakesGoldbergsCircle) {
  DeviationPath path;
  path.state = circle(25, 0, 625, 25, 0, 4, false);
  path.begin();
  DeviationRig rig;
  rig.load(path.state);
  rig.x = 25;
  for (const CircleRow& row : kTable3) {
    EXPECT_EQ(rig.x, row.x);
    EXPECT_EQ(rig.y, row.y);
    EXPECT_EQ(value_of(path.state.deviation), row.f);
    EXPECT_EQ(value_of(path.state.gradient_x), row.dx);
    EXPECT_EQ(value_of(path.state.gradient_y), row.dy);
    path.step();
    ASSERT_TRUE(rig.tick());
  }
}

struct Turn {
  int steps;
  double lowest;  // distance from the centre minus the radius, after each step
  double highest;
};

Turn full_turn(int r, bool clockwise, int sx, int sy) {
  DeviationPath path;
  path.state = circle(sx, sy, static_cast<std::int64_t>(r) * r, sx, sy, 4, clockwise);
  path.begin();
  Turn turn{0, 0, 0};
  int x = sx;
  int y = sy;
  while (!path.at_end() && turn.steps <= 16 * r) {
    const auto step = path.step();
    if (step.in_x) x += step.negative_x ? -1 : 1;
    if (step.in_y) y += step.negative_y ? -1 : 1;
    ++turn.steps;
    const double error = std::sqrt(static_cast<double>(x) * x + static_cast<double>(y) * y) - r;
    turn.lowest = std::fmin(turn.lowest, error);
    turn.highest = std::fmax(turn.highest, error);
  }
  return turn;
}

TEST(DeviationAccumulator, FullCirclesTakeEightRadiiStepsWithinOnePulse) {
  for (int r = 2; r <= 399; ++r) {
    for (const bool clockwise : {false, true}) {
      const Turn turn = full_turn(r, clockwise, r, 0);
      ASSERT_EQ(turn.steps, 8 * r) << "r = " << r << " clockwise " << clockwise;
      // The minimum is exactly -1: the first step of the table from (r, 0) leads to (r - 1, 0), as in Table 3.
      ASSERT_GE(turn.lowest, -1.0) << "r = " << r;
      ASSERT_LT(turn.highest, 1.0) << "r = " << r;
    }
  }
}

// STEER never ends for r = 1 counter-clockwise; the end rule of the accumulator does.
TEST(DeviationAccumulator, SmallestCircleEnds) {
  EXPECT_LE(full_turn(1, false, 1, 0).steps, 8);
  EXPECT_LE(full_turn(1, true, 1, 0).steps, 8);
}

TEST(DeviationAccumulator, ClockwiseIsG2WithXRightAndYUp) {
  for (const bool clockwise : {false, true}) {
    DeviationRig rig;
    rig.load(circle(0, 10, 100, 0, -10, 2, clockwise));
    rig.y = 10;
    for (int i = 0; i < 10; ++i) rig.tick();
    EXPECT_EQ(rig.x > 0, clockwise);  // clockwise from the top leads to the right
  }
}

TEST(DeviationAccumulator, KeepsItsLatencies) {
  DeviationRig rig;
  rig.load(circle(5, 0, 25, 5, 0, 4, false));
  Inputs in;
  in.tick = true;
  rig.block.clock(in);
  EXPECT_FALSE(rig.block.outputs().ready);
  for (unsigned age = 2; age < DeviationAccumulator::kTickPeriod; ++age) {
    rig.block.clock({});
    EXPECT_EQ(rig.block.outputs().step_x, age == DeviationAccumulator::kStepLatency) << age;
    EXPECT_FALSE(rig.block.outputs().ready) << age;
    EXPECT_TRUE(rig.block.outputs().dir_x) << age;
  }
  rig.block.clock({});
  EXPECT_TRUE(rig.block.outputs().ready);
  EXPECT_TRUE(skip::at_rest(rig.block));
}

TEST(DeviationAccumulator, ClearAndResetDropTheStep) {
  for (const bool reset : {false, true}) {
    DeviationRig rig;
    rig.load(circle(5, 0, 25, 5, 0, 4, false));
    Inputs in;
    in.tick = true;
    rig.block.clock(in);
    Inputs drop;
    drop.rst = reset;
    drop.clear = !reset;
    rig.block.clock(drop);
    for (int i = 0; i < 20; ++i) {
      EXPECT_FALSE(rig.block.outputs().step_x);
      EXPECT_FALSE(rig.block.outputs().ready);
      rig.block.clock({});
    }
    EXPECT_TRUE(skip::at_rest(rig.block));
  }
}

TEST(DeviationAccumulator, AdvanceEqualsClocks) {
  std::mt19937_64 random(7);
  DeviationRig a;
  a.load(circle(50, 0, 2500, 50, 0, 4, true));
  DeviationRig b = a;
  for (int i = 0; i < 2000; ++i) {
    Inputs in;
    in.tick = a.block.outputs().ready && random() % 2 == 0;
    a.block.clock(in);
    b.block.clock(in);
    const auto idle = random() % 12;
    for (std::uint64_t k = 0; k < idle; ++k) a.block.clock({});
    for (std::uint64_t left = idle; left != 0;) {
      const std::uint64_t some = std::min<std::uint64_t>(left, skip::horizon(b.block, {}));
      if (some == 0) b.block.clock({});
      skip::advance(b.block, {}, some);
      left -= some == 0 ? 1 : some;
    }
    ASSERT_EQ(skip::at_rest(a.block), skip::at_rest(b.block));
    ASSERT_EQ(a.block.outputs().ready, b.block.outputs().ready);
    ASSERT_EQ(a.block.outputs().step_x, b.block.outputs().step_x);
    ASSERT_EQ(a.block.outputs().step_y, b.block.outputs().step_y);
    ASSERT_EQ(a.block.outputs().dir_x, b.block.outputs().dir_x);
    ASSERT_EQ(a.block.outputs().at_end, b.block.outputs().at_end);
  }
}

}  // namespace
}  // namespace trammel::model
