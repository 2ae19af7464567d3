// The path engines' model by closed forms: the path domain is the feed's three clocks late; N feed ticks make
// floor(1/2 + N * prescale / 2^40) path ticks; a full circle of radius r has 8 r steps and ends where it began.
#include "trammel/model/path_engines.hpp"

#include <gtest/gtest.h>

#include <array>

namespace trammel::model {
namespace {

__extension__ typedef unsigned __int128 uint128;

constexpr std::uint64_t kOnePulse = std::uint64_t{1} << 40;

class Engines {
 public:
  void clock(const PathEngines::Inputs& in = {}) {
    engines.clock(in);
    const PathEngines::Outputs& out = engines.outputs();
    path_ticks += out.path_tick ? 1U : 0U;
    for (unsigned axis = 0; axis < 8; ++axis) {
      if ((out.step >> axis & 1) == 0) continue;
      ++steps;
      place[axis] += (out.dir >> axis & 1) != 0 ? -1 : 1;
    }
  }
  void load(unsigned target, std::uint64_t value, unsigned halfwords) {
    for (unsigned i = 0; i < halfwords; ++i) {
      PathEngines::Inputs in;
      in.load = {true, static_cast<std::uint8_t>(target), static_cast<std::uint16_t>(i < 4 ? value >> (16 * i) : 0)};
      clock(in);
    }
  }
  // A circle in the plane of two axes, from its rightmost point, and `ticks` feed ticks as soon as they may be taken.
  void circle(std::uint64_t radius, std::uint64_t prescale, std::uint64_t ticks, unsigned x, unsigned y) {
    load(load_target::kPrescale, prescale, 3);
    load(load_target::kPlane, y << 8 | x << 4, 1);
    load(load_target::kQuadrants, 4, 1);
    load(load_target::kEndX, 0, 2);
    load(load_target::kEndY, 0, 2);
    load(load_target::kDeviation, 0, 5);
    load(load_target::kGradientX, 2 * radius, 5);
    load(load_target::kGradientY, 0, 5);
    load(load_target::kHalfX, 1, 3);
    load(load_target::kHalfY, 1, 3);
    PathEngines::Inputs swap;
    swap.swap = swap.accumulator = swap.start = true;
    clock(swap);
    while (ticks != 0) {
      PathEngines::Inputs in;
      in.tick = engines.outputs().ready;
      ticks -= in.tick ? 1 : 0;
      clock(in);
    }
    for (int i = 0; i < 200; ++i) clock();
  }

  PathEngines engines;
  std::uint64_t path_ticks = 0;
  std::uint64_t steps = 0;
  std::array<std::int64_t, 8> place{};
};

TEST(PathEngines, PathDomainIsThreeClocksLate) {
  Engines e;
  for (int i = 0; i < 4; ++i) {
    PathEngines::Inputs in;
    in.tick = i == 0 || i == 2;
    in.swap = i == 1;
    e.clock(in);
    EXPECT_EQ(e.engines.outputs().tick, i == 2);
    EXPECT_EQ(e.engines.outputs().swap, i == 3);
  }
  e.clock();
  EXPECT_TRUE(e.engines.outputs().tick);
}

TEST(PathEngines, ACutDropsWhatIsOnItsWay) {
  Engines e;
  PathEngines::Inputs in;
  in.tick = in.swap = true;
  e.clock(in);
  in = {};
  in.cut = true;
  e.clock(in);
  for (int i = 0; i < 8; ++i) {
    e.clock();
    EXPECT_FALSE(e.engines.outputs().tick || e.engines.outputs().swap);
  }
}

TEST(PathEngines, CirclesCloseAndAreDone) {
  for (const std::uint64_t radius : {1U, 2U, 7U, 40U}) {
    const std::uint64_t wanted = 8 * radius;
    for (const std::uint64_t ticks : {wanted, wanted + 1, 3 * wanted + 5}) {
      Engines e;
      const std::uint64_t prescale = (wanted * kOnePulse + ticks / 2) / ticks;
      e.circle(radius, prescale, ticks, 2, 5);
      EXPECT_EQ(e.path_ticks, static_cast<std::uint64_t>((uint128{ticks} * prescale + kOnePulse / 2) >> 40));
      EXPECT_EQ(e.path_ticks, wanted);
      EXPECT_EQ(e.steps, wanted);
      EXPECT_EQ(e.place, (std::array<std::int64_t, 8>{}));
      EXPECT_TRUE(e.engines.outputs().done && !e.engines.outputs().elsewhere && e.engines.outputs().payload_ready);
    }
  }
}

TEST(PathEngines, AnArcCutShortIsElsewhere) {
  Engines e;
  e.circle(5, kOnePulse, 39, 0, 1);
  EXPECT_EQ(e.path_ticks, 39U);
  EXPECT_TRUE(e.engines.outputs().done && e.engines.outputs().elsewhere);
}

}  // namespace
}  // namespace trammel::model
