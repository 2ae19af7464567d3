// The world alone, without a card: pins follow carriages, buttons and events, and quiet_until() keeps its promise.
#include "trammel/world/world.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "random.hpp"

namespace trammel::world {
namespace {

using ::testing::HasSubstr;

constexpr std::uint32_t kClock = 1'000'000;

// Two axes with 80 pulses per mm. The switches of the first axis are at -1 and +5 mm, each with a stop behind it.
Description two_axes() {
  Description d;
  AxisDescription axis;
  axis.carriage.low = -120;
  axis.carriage.high = 480;
  d.axes.push_back(axis);
  axis = {};
  axis.letter = 'Y';
  axis.card_axis = 1;
  d.axes.push_back(axis);
  const ContactParameters closed{true, 5e-4, 3};
  d.switches.push_back({"minus", 0, 0, -80, false, 8, closed});
  d.switches.push_back({"plus", 1, 0, 400, true, 8, closed});
  d.switches.push_back({"probe", 2, 1, -40, false, 0, {false, 0, 0}});
  d.buttons.push_back({"estop", {}, true, {true, 0, 0}});
  d.buttons.push_back({"hold", 6, false, {false, 1e-3, 2}});
  d.buttons.push_back({"x_alarm", 7, false, {false, 0, 0}});
  return d;
}

std::string error_of(const std::function<void(Description&)>& change) {
  Description d = two_axes();
  change(d);
  try {
    const World world(d, kClock);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

// Makes `pulses` at an even rate, beginning at the present time of the world.
void run_pulses(World& world, unsigned axis, int pulses, std::uint64_t clocks_a_pulse) {
  for (int n = 0; n < std::abs(pulses); ++n) {
    world.pulse(world.now() + clocks_a_pulse, axis, pulses < 0 ? -1 : +1);
  }
}

TEST(World, AtRestTheLevelsAreThoseOfItsContacts) {
  const World world(two_axes(), kClock);
  EXPECT_EQ(world.wired(), 0b11000111U);
  // A closed contact reads 0: the two limits are closed, the others are open.
  EXPECT_EQ(world.levels(), 0b11000100U);
  EXPECT_FALSE(world.emergency_stop());
  EXPECT_TRUE(world.has_emergency_stop());
  Description high = two_axes();
  high.closed_level = true;
  EXPECT_EQ(World(high, kClock).levels(), 0b00000011U);
}

TEST(World, ACarriagePressesItsSwitchAndReleasesItFurtherBack) {
  World world(two_axes(), kClock);
  run_pulses(world, 0, 398, 2000);
  world.run_to(world.now() + 100'000);
  EXPECT_FALSE(world.pressed("plus"));
  run_pulses(world, 0, 4, 2000);
  world.run_to(world.now() + 100'000);
  EXPECT_THAT(world.pressed(), ::testing::ElementsAre("plus"));
  EXPECT_EQ(world.levels(), 0b11000110U);
  EXPECT_EQ(world.carriage(0).place(), 402);
  run_pulses(world, 0, -8, 2000);  // at pulse 394
  world.run_to(world.now() + 100'000);
  EXPECT_TRUE(world.pressed("plus"));
  run_pulses(world, 0, -4, 2000);  // at pulse 390
  world.run_to(world.now() + 100'000);
  EXPECT_FALSE(world.pressed("plus"));
  EXPECT_EQ(world.levels(), 0b11000100U);
}

TEST(World, ASwitchThatIsPressedAtTheBeginningDoesNotBounce) {
  Description d = two_axes();
  d.switches[0].at = 0;
  World world(d, kClock);
  EXPECT_TRUE(world.pressed("minus"));
  EXPECT_EQ(world.levels(), 0b11000101U);
  EXPECT_GE(world.quiet_until(), 20U);
}

TEST(World, OtherAxesOfTheCardMoveNothing) {
  World world(two_axes(), kClock);
  run_pulses(world, 3, 100, 100);
  run_pulses(world, 1, 100, 100);
  world.run_to(1'000'000);
  EXPECT_EQ(world.carriage(0).place(), 0);
  EXPECT_EQ(world.carriage(1).place(), 100);
  EXPECT_TRUE(world.carriage(1).still());
}

TEST(World, ButtonsAndEvents) {
  Description d = two_axes();
  d.events = {{2'000'000'000, "estop", false}, {1'500'000'000, "estop", true}};
  World world(d, kClock);
  EXPECT_LE(world.quiet_until(), 1'500'000U);
  world.run_to(1'499'999);
  EXPECT_FALSE(world.emergency_stop());
  world.run_to(1'500'000);
  EXPECT_TRUE(world.emergency_stop());
  world.run_to(2'000'000);
  EXPECT_FALSE(world.emergency_stop());
  world.press("hold");
  EXPECT_EQ(world.levels() >> 6 & 1, 0U);
  EXPECT_THROW(world.press("plus"), std::invalid_argument);
  EXPECT_THROW(world.pressed("nothing"), std::invalid_argument);
}

TEST(World, WithoutPowerCarriagesStay) {
  World world(two_axes(), kClock);
  world.press("estop");
  run_pulses(world, 0, 20, 1000);
  world.run_to(world.now() + 1'000'000);
  EXPECT_EQ(world.carriage(0).place(), 0);
  world.release("estop");
  world.run_to(world.now() + 1'000'000);
  EXPECT_EQ(world.carriage(0).place(), 20);
}

// As with a delayed safety relay: until the delay ends the motors are powered and pulses move the carriages.
TEST(World, ThePowerGoesBehindTheDelayOfItsButton) {
  Description d = two_axes();
  d.buttons[0].power_delay = 0.1;
  World world(d, kClock);
  world.press("estop");
  EXPECT_TRUE(world.emergency_stop());
  EXPECT_LE(world.quiet_until(), 100'000U);
  run_pulses(world, 0, 20, 1000);
  world.run_to(50'000);
  world.press("estop");  // already pressed: the delay does not restart
  world.run_to(99'999);
  EXPECT_TRUE(world.carriage(0).motor().powered());
  EXPECT_EQ(world.carriage(0).place(), 20);
  world.run_to(100'000);
  EXPECT_FALSE(world.carriage(0).motor().powered());
  run_pulses(world, 0, 20, 1000);
  world.run_to(world.now() + 500'000);
  EXPECT_EQ(world.carriage(0).place(), 20);
  world.release("estop");
  EXPECT_TRUE(world.carriage(0).motor().powered());
  world.press("estop");  // a new press
  EXPECT_TRUE(world.carriage(0).motor().powered());
  world.release("estop");
  world.run_to(world.now() + 500'000);
  EXPECT_TRUE(world.carriage(0).motor().powered()) << "released before its delay was over";
  EXPECT_NE(error_of([](Description& wrong) { wrong.buttons[0].power_delay = -1; }), "none");
}

TEST(World, ADriveThatWatchesItsMotorRaisesItsAlarm) {
  Description d = two_axes();
  d.axes[0].alarm_at = 1.5;  // full steps: 24 pulses
  World world(d, kClock);
  run_pulses(world, 0, 26, 1);
  world.run_to(world.now() + 20);
  EXPECT_TRUE(world.pressed("x_alarm"));
  EXPECT_EQ(world.levels() >> 7 & 1, 0U);
  world.run_to(world.now() + 1'000'000);
  EXPECT_TRUE(world.pressed("x_alarm"));  // until it is cleared
  EXPECT_LT(world.carriage(0).place(), 26);
  EXPECT_LE(world.quiet_until() - world.now(), 1000U);
}

// Checks the promise of quiet_until(): with random pulses, the pins are compared in each clock. None changes earlier
// than announced, and the result is the same if the world runs in one piece or clock by clock.
TEST(World, NoPinChangesBeforeItSays) {
  for (const std::uint32_t clock_hz : {1'000U, 30'000U, 1'000'000U}) {
    test::Random random(clock_hz);
    Description d = two_axes();
    d.events = {{500'000'000, "hold", true}, {501'000'000, "estop", true}, {600'000'000, "estop", false}};
    World world(d, clock_hz);
    World pieces(d, clock_hz);
    const std::uint64_t end = clock_hz == 1'000'000 ? 1'500'000 : 30 * std::uint64_t{clock_hz};
    int direction = 1;
    std::uint64_t changes = 0;
    for (std::uint64_t clock = 0; clock < end;) {
      const std::uint64_t until = world.quiet_until();
      ASSERT_GT(until, clock);
      const std::uint32_t levels = world.levels();
      const bool stop = world.emergency_stop();
      while (clock < until && clock < end) {
        ++clock;
        if (random.below(clock_hz / (clock_hz == 1'000'000 ? 50 : 1)) == 0) direction = -direction;
        if (random.below(clock_hz < 1'000'000 ? 3 : 60) == 0) {
          const unsigned axis = random.below(4) == 0 ? 1 : 0;
          world.pulse(clock, axis, direction);
          pieces.pulse(clock, axis, direction);
        }
        world.run_to(clock);
        if (clock < until) {
          ASSERT_EQ(world.levels(), levels) << "clock " << clock << " of " << until;
          ASSERT_EQ(world.emergency_stop(), stop);
        }
      }
      changes += world.levels() != levels ? 1U : 0U;
    }
    pieces.run_to(end);
    EXPECT_EQ(pieces.levels(), world.levels());
    EXPECT_EQ(pieces.carriage(0).position(), world.carriage(0).position());
    EXPECT_GT(changes, 10U) << clock_hz;
  }
}

TEST(World, RefusesPartsByName) {
  EXPECT_EQ(error_of([](Description&) {}), "none");
  EXPECT_THAT(error_of([](Description& d) { d.buttons[1].input = 1; }), HasSubstr("button hold: something else"));
  EXPECT_THAT(error_of([](Description& d) { d.switches[1].input = 32; }), HasSubstr("switch plus: inputs are 0 to 31"));
  EXPECT_THAT(error_of([](Description& d) { d.axes[1].card_axis = 0; }), HasSubstr("axis Y: axis 0 of the card"));
  EXPECT_THAT(error_of([](Description& d) { d.axes[0].carriage.low = 1; }), HasSubstr("axis X: a carriage begins"));
  EXPECT_THAT(error_of([](Description& d) { d.axes[1].alarm_at = 1; }), HasSubstr("axis Y: a drive that watches"));
  EXPECT_THAT(error_of([](Description& d) { d.buttons[1].name = "plus"; }), HasSubstr("button plus: another one"));
  EXPECT_THAT(error_of([](Description& d) {
                d.events = {{0, "stop", true}};
              }),
              HasSubstr("stop: no such button: estop, hold, x_alarm"));
}

}  // namespace
}  // namespace trammel::world
