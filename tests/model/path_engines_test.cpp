// The path engines against the documented clocks: the 3 clocks of the path domain, path ticks from the prescaler, and
// the signals to the sequencer.
#include "trammel/model/path_engines.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "trammel/skip/path_engines.hpp"

namespace trammel::model {
namespace {

constexpr std::int64_t kOne = std::int64_t{1} << 40;

void load(PathEngines& engines, unsigned target, std::uint64_t value, int halfwords) {
  for (int i = 0; i < halfwords; ++i) {
    PathEngines::Inputs in;
    in.load = {true, static_cast<std::uint16_t>(target), static_cast<std::uint16_t>(value)};
    value >>= 16;
    engines.clock(in);
  }
}

// A circle of radius r around (-r, 0) in the plane of axes 1 and 0 (x is axis 1); `prescale` is in path ticks per feed
// tick.
void begin_circle(PathEngines& engines, std::uint64_t r, std::int64_t prescale) {
  load(engines, load_target::kPrescale, static_cast<std::uint64_t>(prescale), 3);
  load(engines, load_target::kPlane, 1U << 4, 1);
  load(engines, load_target::kQuadrants, 4, 1);
  load(engines, load_target::kEndX, 0, 2);
  load(engines, load_target::kEndY, 0, 2);
  load(engines, load_target::kDeviation, 0, 5);
  load(engines, load_target::kGradientX, 2 * r, 5);
  load(engines, load_target::kGradientY, 0, 5);
  load(engines, load_target::kHalfX, 1, 3);
  load(engines, load_target::kHalfY, 1, 3);
  PathEngines::Inputs in;
  in.swap = true;
  in.engine = card_map::engine::kAccumulator;
  engines.clock(in);
}

TEST(PathEngines, TicksAndSwapsLeaveThreeClocksLater) {
  PathEngines engines;
  std::mt19937 random(1);
  std::vector<PathEngines::Inputs> past(3);
  for (int i = 0; i < 1000; ++i) {
    PathEngines::Inputs in;
    in.tick = random() % 2 == 0;
    in.swap = random() % 20 == 0;
    engines.clock(in);
    EXPECT_EQ(engines.outputs().tick, past[past.size() - 2].tick);
    EXPECT_EQ(engines.outputs().swap, past[past.size() - 2].swap);
    past.push_back(in);
  }
}

TEST(PathEngines, ACutDropsWhatIsOnItsWay) {
  for (int clocks = 0; clocks < 3; ++clocks) {
    PathEngines engines;
    PathEngines::Inputs in;
    in.tick = in.swap = true;
    engines.clock(in);
    for (int i = 0; i < clocks; ++i) engines.clock({});
    in = {};
    in.cut = true;
    engines.clock(in);
    for (int i = 0; i < 6; ++i) {
      EXPECT_FALSE(engines.outputs().tick || engines.outputs().swap);
      engines.clock({});
    }
  }
}

// A feed tick at c that is a path tick reaches the accumulator at c+5 and makes its step at c+8.
TEST(PathEngines, APathTickTakesItsClocks) {
  PathEngines engines;
  begin_circle(engines, 10, kOne);
  for (int i = 0; i < 5; ++i) engines.clock({});
  PathEngines::Inputs in;
  in.tick = true;
  engines.clock(in);
  for (int clock = 1; clock < 30; ++clock) {
    const auto& o = engines.outputs();
    EXPECT_EQ(o.path_tick, clock == 5) << clock;
    EXPECT_EQ(o.step, clock == 8 ? 2U : 0U) << "x is axis 1, and steps first where F is 0; clock " << clock;
    // The accumulator got the tick at 5: payload_ready from 5 + 6, done from 5 + 10.
    EXPECT_EQ(o.payload_ready, clock >= 11) << clock;
    EXPECT_EQ(o.done, clock >= 15) << clock;
    EXPECT_TRUE(o.ready);
    engines.clock({});
  }
  EXPECT_TRUE(engines.outputs().missed_end);
}

// Ticks at the highest rate: every path tick makes a step, none is lost, and the circle ends at its start.
TEST(PathEngines, ACircleAsFastAsItGoes) {
  for (const std::uint64_t r : {1U, 5U, 30U}) {
    PathEngines engines;
    begin_circle(engines, r, kOne);
    std::int64_t at[2] = {0, 0};
    std::uint64_t given = 0;
    std::uint64_t steps = 0;
    for (std::uint64_t clock = 0; clock < 10 * 8 * r + 60; ++clock) {
      PathEngines::Inputs in;
      in.tick = clock > 6 && engines.outputs().ready && given < 8 * r;
      given += in.tick ? 1U : 0U;
      engines.clock(in);
      for (unsigned axis = 0; axis < 2; ++axis) {
        if ((engines.outputs().step >> axis & 1) == 0) continue;
        ++steps;
        at[axis] += (engines.outputs().dir >> axis & 1) != 0 ? -1 : 1;
      }
    }
    EXPECT_EQ(steps, 8 * r);
    EXPECT_EQ(at[0], 0);
    EXPECT_EQ(at[1], 0);
    EXPECT_TRUE(engines.outputs().done);
    EXPECT_FALSE(engines.outputs().missed_end);
  }
}

TEST(PathEngines, TicksOfLinesLeaveEnginesReadyAndDone) {
  PathEngines engines;
  PathEngines::Inputs in;
  in.swap = true;
  engines.clock(in);
  in = {};
  in.tick = true;
  for (int i = 0; i < 20; ++i) {
    engines.clock(in);
    EXPECT_TRUE(engines.outputs().payload_ready);
    EXPECT_TRUE(engines.outputs().done);
  }
}

// Jumps over ticks in flight and ticks of the prescaler without a carry.
TEST(PathEngines, JumpEqualsClock) {
  std::mt19937_64 random(3);
  for (int n = 0; n < 500; ++n) {
    PathEngines clocked;
    begin_circle(clocked, 10, kOne / 5000);
    for (int i = 0; i < 20; ++i) clocked.clock({});
    PathEngines jumping = clocked;
    ASSERT_TRUE(skip::only_ticks_move(jumping));
    const int clocks = 10 + static_cast<int>(random() % 200);
    std::uint64_t ticks = 0;
    unsigned in_flight = 0;
    for (int i = 0; i < clocks; ++i) {
      PathEngines::Inputs in;
      in.tick = random() % 3 != 0;
      clocked.clock(in);
      ticks += in.tick ? 1U : 0U;
      in_flight = in_flight << 1 | (in.tick ? 1U << 6 : 0U);
    }
    skip::EngineTicks(jumping).jump(ticks, in_flight & 0x3FF);
    for (int i = 0; i < 3000; ++i) {
      ASSERT_EQ(jumping.outputs().tick, clocked.outputs().tick);
      ASSERT_EQ(jumping.outputs().path_tick, clocked.outputs().path_tick);
      ASSERT_EQ(jumping.outputs().done, clocked.outputs().done) << i;
      ASSERT_EQ(jumping.outputs().payload_ready, clocked.outputs().payload_ready);
      PathEngines::Inputs in;
      in.tick = i > 8;
      clocked.clock(in);
      jumping.clock(in);
    }
  }
}

}  // namespace
}  // namespace trammel::model
