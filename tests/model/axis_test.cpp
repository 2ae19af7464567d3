// The golden model of the axis: both sources of steps move the position; the path's step list follows the generator.
#include "trammel/model/axis.hpp"

#include <gtest/gtest.h>

#include "trammel/skip/axis.hpp"

namespace trammel::model {
namespace {

constexpr unsigned kAxis = 2;

void set(Axis& axis, std::uint32_t address, std::uint32_t value) {
  Axis::Inputs in;
  in.setting = {true, address, value};
  axis.clock(in);
}

Axis make() {
  Axis axis(kAxis);
  set(axis, card_map::reg::step_length(kAxis), 2);
  set(axis, card_map::reg::step_space(kAxis), 1);
  return axis;
}

void begin(Axis& axis, std::int64_t increment) {
  Axis::Inputs in;
  for (int i = 0; i < 3; ++i) {
    const auto word = static_cast<std::uint16_t>(static_cast<std::uint64_t>(increment) >> (16 * i));
    in.load = {true, load_target::increment(kAxis), word};
    axis.clock(in);
  }
  in.load.valid = false;
  in.swap = true;
  in.active = true;
  axis.clock(in);
}

TEST(Axis, LineReachesThePosition) {
  for (const bool back : {false, true}) {
    Axis axis = make();
    const std::int64_t increment = std::int64_t{1} << 36;  // a pulse in 16 ticks
    begin(axis, back ? -increment : increment);
    Axis::Inputs in;
    in.tick = true;
    std::uint32_t path = 0;
    for (int k = 0; k < 1600 + 20; ++k) {
      if (k == 1600) in.tick = false;
      axis.clock(in);
      if (axis.outputs().path_step) path += axis.outputs().path_dir ? ~std::uint32_t{0} : 1U;
    }
    EXPECT_EQ(path, back ? ~std::uint32_t{99} : 100U);
    EXPECT_EQ(axis.outputs().shaper.position, path);
    EXPECT_FALSE(axis.outputs().shaper.fault);
    EXPECT_TRUE(skip::horizon(axis, {}) == skip::kForever);
  }
}

TEST(Axis, EngineStepsPassOneClockLater) {
  Axis axis = make();
  Axis::Inputs in;
  in.engine_step = true;
  in.engine_dir = true;
  axis.clock(in);
  EXPECT_TRUE(axis.outputs().path_step);
  EXPECT_TRUE(axis.outputs().path_dir);
  EXPECT_FALSE(skip::horizon(axis, {}) == skip::kForever);
  in.engine_step = false;
  in.engine_dir = false;
  for (int i = 0; i < 30; ++i) {
    axis.clock(in);
    EXPECT_FALSE(axis.outputs().path_step);
    EXPECT_TRUE(axis.outputs().path_dir) << "held between steps";
  }
  EXPECT_EQ(axis.outputs().shaper.position, ~std::uint32_t{0});
}

TEST(Axis, StepEveryClockIsAFault) {
  Axis axis = make();
  begin(axis, static_cast<std::int64_t>(PulseGenerator::kOne));
  Axis::Inputs in;
  in.tick = true;
  bool fault = false;
  for (int i = 0; i < 50; ++i) {
    axis.clock(in);
    fault = fault || axis.outputs().shaper.fault;
  }
  EXPECT_TRUE(fault);
  in.tick = false;
  for (int i = 0; i < 50; ++i) axis.clock(in);
  EXPECT_FALSE(axis.outputs().shaper.fault) << "an event";
}

// The pins have the level of the strap from the first clock on, and invert when MODE says so.
TEST(Axis, IdleLevels) {
  for (unsigned level = 0; level < 4; ++level) {
    Axis axis(kAxis, level);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(axis.outputs().shaper.step, (level & 1) != 0);
      EXPECT_EQ(axis.outputs().shaper.dir, (level & 2) != 0);
      axis.clock({});
    }
    set(axis, card_map::reg::mode(kAxis), 0);
    axis.clock({});
    EXPECT_FALSE(axis.outputs().shaper.step);
    EXPECT_FALSE(axis.outputs().shaper.dir);
  }
}

// The axis ignores the settings and the increments of other axes.
TEST(Axis, OnlyItsOwn) {
  Axis axis = make();
  for (unsigned other = 0; other < 8; ++other) {
    if (other == kAxis) continue;
    set(axis, card_map::reg::mode(other), 4);
    set(axis, card_map::reg::step_length(other), 9);
  }
  begin(axis, static_cast<std::int64_t>(PulseGenerator::kOne) / 2);
  Axis::Inputs in;
  in.load = {true, load_target::increment(kAxis + 1), 0xFFFF};
  for (int i = 0; i < 3; ++i) axis.clock(in);
  in.load.valid = false;
  in.swap = in.active = true;
  axis.clock(in);
  in.swap = false;
  in.tick = true;
  axis.clock(in);  // preset of 1/2 plus 1/2: a step
  in.tick = false;
  unsigned high = 0;
  for (int i = 0; i < 30; ++i) {
    axis.clock(in);
    high += axis.outputs().shaper.step ? 1U : 0U;
  }
  EXPECT_EQ(high, 2U);
}

}  // namespace
}  // namespace trammel::model
