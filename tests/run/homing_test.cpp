#include "trammel/run/homing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <vector>

#include "homing_bench.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::run {
namespace {

using testing::HasSubstr;

class HomingTest : public testing::Test, protected HomingBench {
 protected:
  void begin(const machine::Machine& machine, std::vector<std::int64_t> start = {4000, 1600, -800, 0, 0}) {
    HomingBench::begin(machine, std::move(start), sim::make_model_engine(sim::EngineOptions{5, kHomingClock, false}));
  }
};

TEST_F(HomingTest, OneAxisComesToItsFinalPosition) {
  begin(homing_machine());
  bus_->add({0, 0, 1000});  // pressed at 12.5 mm and below
  const std::vector<HomedAxis> homed = home({0});
  ASSERT_EQ(homed.size(), 1U);
  // The edge at pulse 1000 is at machine coordinate -1. The axis ends at 5, which is 6 mm from the edge.
  EXPECT_NEAR(static_cast<double>(bus_->places()[0] - 1000), 6 * kPerMm, 1);
  EXPECT_NEAR(coordinate(0), 5, 0.013);
  EXPECT_NEAR(homed[0].search_edge, homed[0].edge, 1.01 / kPerMm);
  EXPECT_EQ(card_->read_place().homed, 1);
  EXPECT_EQ(card_->read_faults(), 0U);
  EXPECT_EQ(bus_->places()[1], 1600) << "the others stand";
}

// A second homing reports how many steps were lost since the first. This test moves the switch by 8 pulses instead.
TEST_F(HomingTest, TheEdgeTellsOfStepsThatWereLost) {
  begin(homing_machine());
  bus_->add({0, 0, 1000});
  home({0});
  bus_->move_switch(0, 1008);
  home({0});
  double counted = 0;
  double now = 0;
  ASSERT_EQ(std::sscanf(said().c_str(), "X: the edge was counted at %lf mm, and is %lf mm from now on", &counted, &now),
            2)
      << said();
  EXPECT_EQ(now, -1);
  EXPECT_NEAR(counted, -1 + 8.0 / kPerMm, 1.01 / kPerMm);
}

// Both motors turn for each axis, so no motor is homed before both axes are.
TEST_F(HomingTest, CrossedBeltsHomeAxisByAxis) {
  const std::string corexy = "kinematics.name='corexy';homing.y.sequence=2";
  begin(homing_machine(corexy));
  bus_->add({0, 0, 1000});
  bus_->add({1, 1, -500});
  home({0});
  EXPECT_NEAR(static_cast<double>(bus_->places()[0] - 1000), 6 * kPerMm, 1);
  EXPECT_NEAR(static_cast<double>(bus_->places()[1]), 1600, 1) << "Y stands";
  EXPECT_EQ(card_->read_place().homed, 0);
  begin(homing_machine(corexy));
  bus_->add({0, 0, 1000});
  bus_->add({1, 1, -500});
  home({0, 1});
  EXPECT_NEAR(static_cast<double>(bus_->places()[0] - 1000), 6 * kPerMm, 1);
  EXPECT_NEAR(static_cast<double>(bus_->places()[1]), -500, 1.01);
  EXPECT_EQ(card_->read_place().homed, 3);
  EXPECT_NEAR(coordinate(0), 5, 0.026);
  EXPECT_NEAR(coordinate(1), 0, 0.026);
}

// Both axes home on one path, on which the motors have different speeds.
TEST_F(HomingTest, CrossedBeltsHomeTogether) {
  begin(homing_machine("kinematics.name='corexy';homing.x.sequence=1"));
  bus_->add({0, 0, 1000});
  bus_->add({1, 1, -500});
  home({0, 1});
  EXPECT_NEAR(static_cast<double>(bus_->places()[0] - 1000), 6 * kPerMm, 1);
  EXPECT_NEAR(static_cast<double>(bus_->places()[1]), -500, 1.01);
  EXPECT_EQ(card_->read_place().homed, 3);
}

TEST_F(HomingTest, AxesHomeTogetherAndInSequence) {
  begin(homing_machine());
  bus_->add({0, 0, 1000});
  bus_->add({1, 1, -500});
  bus_->add({2, 2, 400, 1});
  home({0, 1, 2});
  EXPECT_EQ(card_->read_place().homed, 7);
  EXPECT_NEAR(coordinate(0), 5, 0.013);
  for (const std::size_t axis : {1U, 2U}) EXPECT_NEAR(coordinate(axis), 0, 0.013);
  EXPECT_NEAR(static_cast<double>(bus_->places()[1]), -500, 1.01);
  EXPECT_NEAR(static_cast<double>(bus_->places()[2]), 400, 1.01);
}

TEST_F(HomingTest, APressedSwitchIsLeftFirst) {
  begin(homing_machine(), {200, 0, 0, 0, 0});
  bus_->add({0, 0, 1000});
  home({0});
  EXPECT_NEAR(static_cast<double>(bus_->places()[0] - 1000), 6 * kPerMm, 1);
}

TEST_F(HomingTest, TheIndexBehindTheSwitchCounts) {
  begin(homing_machine("homing.x.use_index=true"));
  bus_->add({0, 0, 1000});
  bus_->add({3, 0, 930, -1, 40});
  home({0});
  EXPECT_NEAR(static_cast<double>(bus_->places()[0] - 930), 6 * kPerMm, 1);
}

TEST_F(HomingTest, AGantryIsSquared) {
  begin(homing_machine("axis.x.second_motor=true;inputs.x_second_home=4"));
  bus_->add({0, 0, 1000});
  bus_->add({4, 4, -3070});  // motor 4 starts at 0, and motor 0 at 4000: a skew of 70 pulses
  const std::vector<HomedAxis> homed = home({0});
  EXPECT_NEAR(static_cast<double>(bus_->places()[0] - 1000), 6 * kPerMm, 1);
  EXPECT_NEAR(static_cast<double>(bus_->places()[4] + 3070), 6 * kPerMm, 1);
  EXPECT_NEAR(std::abs(homed[0].squared_by), 70.0 / kPerMm, 1.5 / kPerMm);
  EXPECT_EQ(card_->read_place().homed, 17);
}

TEST_F(HomingTest, ALimitThatIsTheHomeSwitchIsIgnored) {
  begin(homing_machine("homing.x.ignore_limits=true;inputs.x_limit_minus={input=0, normally=\"open\"}"));
  bus_->add({0, 0, 1000});
  home({0});
  EXPECT_NEAR(coordinate(0), 5, 0.013);
  EXPECT_EQ(card_->read_role({driver::AxisRole::kLimitMinus, 0}), 1U) << "it is a limit again";
}

TEST_F(HomingTest, ASwitchThatNeverComesEndsTheSearch) {
  begin(homing_machine());
  bus_->add({1, 1, -500, -1, 1000, 0, true});
  EXPECT_THAT(error_of({1}), HasSubstr("Y: its home switch at input 1 did not become active within 100 mm at 30 mm/s"));
  EXPECT_NEAR(static_cast<double>(bus_->places()[1]), 1600 - 100 * kPerMm, 1);
  EXPECT_EQ(card_->read_place().homed, 0);
  EXPECT_FALSE(card_->busy());
}

TEST_F(HomingTest, WhatHadComeHomeStaysHomedWhenALaterAxisFails) {
  begin(homing_machine("homing.x.sequence=2;homing.x.search_distance=10"));
  bus_->add({2, 2, 400, 1});
  EXPECT_THAT(error_of({0, 2}), HasSubstr("X: "));
  EXPECT_EQ(card_->read_place().homed, 1U << 2);
  EXPECT_EQ(error_of({0}).substr(0, 2), "X:");
  EXPECT_EQ(card_->read_place().homed, 1U << 2);
}

TEST_F(HomingTest, AGantryThatIsTooSkewEndsAtItsBound) {
  begin(homing_machine("axis.x.second_motor=true;inputs.x_second_home=4;homing.x.squaring=3"));
  bus_->add({0, 0, 1000});
  bus_->add({4, 4, -3500});  // 500 pulses, 6.25 mm, later
  EXPECT_THAT(error_of({0}),
              HasSubstr("X, second motor: its home switch at input 4 did not become active within 3 mm"));
  EXPECT_EQ(card_->read_place().homed, 0);
}

TEST_F(HomingTest, ASharedSwitchMustBeFree) {
  begin(homing_machine("homing.x.shared=true"), {200, 0, 0, 0, 0});
  bus_->add({0, 0, 1000});
  EXPECT_THAT(error_of({0}), HasSubstr("is shared, and pressed before it moves"));
  EXPECT_EQ(bus_->places()[0], 200);
}

TEST_F(HomingTest, AStuckSwitchIsNamed) {
  begin(homing_machine("homing.x.search_distance=20"), {200, 0, 0, 0, 0});
  bus_->add({0, 0, 1'000'000});
  EXPECT_THAT(error_of({0}), HasSubstr("X: its home switch at input 0 did not become free within 20 mm at 40 mm/s"));
}

TEST_F(HomingTest, AStallIsLookedAtAtSpeed) {
  begin(homing_machine("homing.x={search_velocity=-40, latch_velocity=0, at_speed=true}"));
  bus_->add({0, 0, 3995, 1, 1000});  // reports during the acceleration
  bus_->add({0, 0, 1000});
  home({0});
  EXPECT_NEAR(static_cast<double>(bus_->places()[0] - 1000), 6 * kPerMm, 1);
}

// The edge is the same for any phase of the ramp, scale, speed, bounce and filter.
TEST_F(HomingTest, TheEdgeIsTheSameWithinAPulse) {
  std::mt19937 random(7);
  const auto draw = [&random](double from, double to) {
    return from + (to - from) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
  };
  const int machines = std::getenv("TRAMMEL_LONG") == nullptr ? 100 : 1000;
  for (int i = 0; i < machines; ++i) {
    const double scale = std::round(draw(20, 400));
    const double search = draw(5, 60);
    const double latch = draw(0.5, std::min(4.0, search));
    const double filter = draw(0, 5);
    begin(
        homing_machine(fmt::format("axis.x.steps_per_mm={};inputs.filter={:.3f};homing.x={{search_velocity=-{:.3f}, "
                                   "latch_velocity=-{:.3f}}}",
                                   scale, filter, search, latch)));
    const auto edge = static_cast<std::int64_t>(4000 - draw(0.5, 20) * scale);
    bus_->add({0, 0, edge, -1, 1'000'000, static_cast<std::uint64_t>(draw(0, filter * 500))});
    const std::vector<HomedAxis> homed = home({0});
    EXPECT_LE(std::abs(homed[0].search_edge - homed[0].edge) * scale, 1.01) << i;
    EXPECT_NEAR(static_cast<double>(bus_->places()[0] - edge), 6 * scale, 1.01) << i;
    EXPECT_EQ(card_->read_faults(), 0U);
  }
}

}  // namespace
}  // namespace trammel::run
