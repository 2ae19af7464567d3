// The golden model in a world: effects of the machine on the card, and their times.
#include "trammel/world/engine_in_world.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "trammel/card_map.hpp"
#include "world_card.hpp"

namespace trammel::world {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kPulsesAMm = 80;

// The switch at +10 mm, and the end of the travel at +15 mm.
std::string near_plus() { return changed_world("above = 300", "above = 10", changed_world("high = 305", "high = 15")); }

TEST(EngineInWorld, ACarriageFollowsTheCard) {
  WorldCard c(default_world_text());
  EXPECT_EQ(c.end_of("G1 X12 Y-3 F6000\nG2 X14 Y-1 I2\nG1 Z2\n"), "its end");
  const std::vector<std::int64_t> at = c.engine.positions();
  EXPECT_EQ(at[0], 14 * kPulsesAMm);
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_EQ(c.world.carriage(n).place(), at[n]) << n;
    EXPECT_EQ(c.world.carriage(n).commanded(), at[n]) << n;
    EXPECT_TRUE(c.world.carriage(n).still());
  }
}

TEST(EngineInWorld, ACarriageRunsIntoItsLimitAndTheCardStops) {
  WorldCard c(near_plus());
  EXPECT_THAT(c.end_of("G1 X100 F3000\n"), HasSubstr("LIMIT (X plus)"));
  EXPECT_TRUE(c.world.pressed("x_plus"));
  const Carriage& x = c.world.carriage(0);
  const std::int64_t at = c.engine.positions()[0];
  EXPECT_EQ(x.commanded(), at);
  EXPECT_EQ(x.place(), at);
  EXPECT_EQ(x.lost(), 0);
  // At 4,000 pulses/s the filter, the scans and the delay of the carriage take the axis past the switch.
  EXPECT_GT(at, 10 * kPulsesAMm);
  EXPECT_LT(at, 10 * kPulsesAMm + 20);
  // Moving away from the switch is allowed and releases it.
  c.card.clear_faults();
  EXPECT_EQ(c.end_of("G91\nG1 X-5 F3000\n"), "its end");
  EXPECT_FALSE(c.world.pressed("x_plus"));
  EXPECT_EQ(c.world.carriage(0).place(), at - 5 * kPulsesAMm);
}

// The switch bounces for less than the filter, so the card stops once.
TEST(EngineInWorld, BouncesReachThePin) {
  WorldCard c(near_plus());
  const std::uint32_t before = c.card.read_raw_inputs();
  c.end_of("G1 X9.9 F3000\nG4 P0.1\n");
  EXPECT_EQ(c.card.read_raw_inputs(), before);
  for (int n = 0; n < 10; ++n) c.world.pulse(c.world.now(), 0, +1);  // past the switch, without the card
  int changes = 0;
  std::uint32_t level = before;
  for (int n = 0; n < 200; ++n) {
    c.engine.wait(8);
    const std::uint32_t now = c.card.read_raw_inputs();
    changes += now != level ? 1 : 0;
    level = now;
  }
  EXPECT_EQ(level ^ before, 2U);
  EXPECT_GE(changes, 3);
}

TEST(EngineInWorld, AWeakMotorLosesStepsAndThePulsesPartFromTheCarriage) {
  WorldCard c(changed_world("torque = 0.40", "torque = 0.045"));
  EXPECT_EQ(c.end_of("G1 X30 F9000\n"), "its end");
  const Carriage& x = c.world.carriage(0);
  EXPECT_EQ(x.commanded(), 30 * kPulsesAMm);
  EXPECT_EQ(c.engine.positions()[0], 30 * kPulsesAMm);
  EXPECT_GT(x.lost(), 0);
  EXPECT_EQ(x.lost() % 64, 0);
  EXPECT_EQ(x.place(), 30 * kPulsesAMm - x.lost());
  EXPECT_EQ(c.world.carriage(1).lost(), 0);
}

TEST(EngineInWorld, TheEndOfTheTravelHoldsWhatNoSwitchHasStopped) {
  WorldCard c(near_plus());
  machine::apply_override(c.machine, "inputs.x_limit_plus=15");  // an input without a switch
  EXPECT_EQ(c.end_of("G1 X40 F3000\n"), "its end");
  EXPECT_LE(c.world.carriage(0).place(), 15 * kPulsesAMm);
  EXPECT_GT(c.world.carriage(0).lost(), 20 * kPulsesAMm);
}

TEST(EngineInWorld, TheEmergencyStopAtItsTime) {
  const std::string at_once = changed_world("power_off_after = 500", "power_off_after = 0");
  WorldCard c("events = [\"at 0.25 s press estop\", \"at 1.5 s release estop\"]\n" + at_once);
  EXPECT_THAT(c.end_of("G1 X100 F3000\n"), HasSubstr("EMERGENCY_STOP"));
  const std::uint64_t pressed = kCardClock / 4;
  ASSERT_FALSE(c.steps.pins.empty());
  EXPECT_LE(c.steps.pins.back().cycle, pressed + 40);
  EXPECT_GE(c.steps.pins.back().cycle, pressed - 200);
  EXPECT_TRUE(c.world.emergency_stop());
  EXPECT_EQ(c.world.carriage(0).commanded(), c.engine.positions()[0]);
  // Without power the carriage rolled on by some pulses.
  EXPECT_GT(c.world.carriage(0).place(), c.engine.positions()[0]);
  c.engine.wait(kCardClock);
  EXPECT_FALSE(c.world.emergency_stop());
  c.card.clear_faults();
  EXPECT_FALSE(c.card.read_status().faulted);
}

TEST(EngineInWorld, ADrivesAlarmStopsTheCard) {
  const std::string text = changed_world("# alarm = 8 ", "alarm = 8 ");
  WorldCard c("events = [\"at 300 ms alarm X\"]\n" + text);
  machine::apply_override(c.machine, "inputs.x_drive_fault=8");
  EXPECT_THAT(c.end_of("G1 X100 F3000\n"), HasSubstr("DRIVE"));
}

TEST(EngineInWorld, AProbeFindsItsPlate) {
  WorldCard c(default_world_text());
  EXPECT_EQ(c.end_of("G38.2 Z-30 F600\n"), "its end");
  EXPECT_TRUE(c.world.pressed("probe"));
  EXPECT_LT(c.engine.positions()[2], -20 * kPulsesAMm);
  EXPECT_GT(c.engine.positions()[2], -20 * kPulsesAMm - 30);
  EXPECT_EQ(c.world.carriage(2).place(), c.engine.positions()[2]);
}

// A world that wires no input of the program does not change the timing of the card by a single clock.
TEST(EngineInWorld, ClockByClockTheCardInside) {
  const std::string program = "G1 X3 Y2 F6000\nG1 X0\n";
  const std::string world = "[axis.x]\n[axis.y]\n[switch.a]\ninput = 15\naxis = \"x\"\nabove = 2\n";
  WorldCard in(world);
  EXPECT_EQ(in.end_of(program), "its end");
  const auto bare = model_card();
  test::Steps steps;
  bare->set_sink(&steps);
  driver::Card card = driver::Card::open(*bare);
  run::Runner runner([&] { return std::make_unique<gcode::TextLines>(program, "p.ngc"); }, in.machine,
                     planner::limits_of(card.identification()));
  runner.plan();
  runner.run(card);
  bare->wait(kCardClock / 2);
  EXPECT_EQ(in.engine.cycles(), bare->cycles());
  ASSERT_EQ(in.steps.pins.size(), steps.pins.size());
  for (std::size_t n = 0; n < steps.pins.size(); ++n) ASSERT_EQ(in.steps.pins[n].cycle, steps.pins[n].cycle);
  EXPECT_EQ(in.steps.path.size(), steps.path.size());
}

TEST(EngineInWorld, WhatTheWorldWiresIsTheWorlds) {
  WorldCard c(default_world_text());
  const std::uint32_t before = c.card.read_raw_inputs();
  c.engine.set_input(1, true);
  c.engine.wait(200);
  EXPECT_EQ(c.card.read_raw_inputs(), before);
  c.engine.set_inputs(before | 3U | 1U << 15);
  c.engine.set_emergency_stop(true);
  c.engine.wait(200);
  EXPECT_EQ(c.card.read_raw_inputs(), before | 1U << 15);
  EXPECT_FALSE(c.card.read_status().faulted);
  c.world.press("cycle_start");
  c.engine.wait(2000);
  EXPECT_EQ(c.card.read_raw_inputs(), (before | 1U << 15) & ~(1U << 7));
}

// A pin that changes during a transfer is visible in the later accesses of the transfer.
TEST(EngineInWorld, APinChangesBetweenTheAccessesOfOneTransfer) {
  constexpr std::uint64_t kPressed = 8000;  // clocks: 20 ms
  World world(parse_world("events = [\"at 20 ms press feed_hold\"]\n" + default_world_text(), "test world"),
              kCardClock);
  EngineInWorld engine(model_card(), world);
  engine.wait(kPressed - 300 - engine.cycles());
  std::vector<driver::Access> reads(100, driver::read_of(card_map::reg::kRawInputs));
  ASSERT_EQ(engine.transfer(reads.data(), reads.size()), reads.size());
  ASSERT_GT(engine.cycles(), kPressed + 300);
  EXPECT_EQ(reads.front().data >> 6 & 1U, 1U);
  EXPECT_TRUE(std::any_of(reads.begin(), reads.end(), [](auto& read) { return (read.data >> 6 & 1U) == 0; }));
}

// A closed contact reads 0, also if the machine file makes this the active level; an unwired input would be 1.
TEST(EngineInWorld, FromTheBeginningEachWiredInputHasItsLevel) {
  World world(default_world(), kCardClock);
  EngineInWorld engine(model_card(), world);
  driver::Card card = driver::Card::open(engine);
  card.set_input_polarity(0b10);
  engine.wait(2000);
  EXPECT_EQ(card.read_inputs() & 0b10U, 0b10U);
}

TEST(EngineInWorld, AResetOfTheCardLeavesTheMachineWhereItIs) {
  WorldCard c(default_world_text());
  ASSERT_EQ(c.end_of("G1 X5 F3000\n"), "its end");
  const std::uint64_t before = c.world.now();
  c.engine.reset();
  EXPECT_EQ(c.engine.positions()[0], 0);
  EXPECT_EQ(c.world.carriage(0).place(), 5 * kPulsesAMm);
  EXPECT_GE(c.world.now(), before);
  EXPECT_LE(c.world.now(), before + 4);
  c.card = driver::Card::open(c.engine);
  EXPECT_EQ(c.end_of("G1 X5 F3000\n"), "its end");
  EXPECT_EQ(c.world.carriage(0).place(), 10 * kPulsesAMm);
}

TEST(EngineInWorld, WaitsForTheInterruptAsTheEngineInside) {
  // An event in the middle interrupts the wait.
  World world(parse_world("events = [\"at 30 ms press feed_hold\"]\n" + default_world_text(), "test world"),
              kCardClock);
  EngineInWorld engine(model_card(true), world);
  EXPECT_TRUE(engine.has_interrupt());
  const std::uint64_t before = engine.cycles();
  EXPECT_FALSE(engine.wait_for_interrupt(std::chrono::milliseconds(100)));
  EXPECT_EQ(engine.cycles() - before, kCardClock / 10);
  EXPECT_TRUE(world.pressed("feed_hold"));
  EXPECT_EQ(world.now(), engine.cycles());
}

TEST(EngineInWorld, RefusesInputsThatTheCardDoesNotHave) {
  Description d = default_world();
  d.switches[0].input = 16;
  World world(d, kCardClock);
  EXPECT_THROW(EngineInWorld(model_card(), world), std::invalid_argument);
}

}  // namespace
}  // namespace trammel::world
