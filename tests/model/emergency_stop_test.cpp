// The emergency stop and the outputs that become safe at the cause of a stop, over the core's port and pins, against
// docs/reference/behaviour.md.
#include <gtest/gtest.h>

#include "core_bench.hpp"

namespace trammel::model::emergency_stop_test {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;
using testing::CoreBench;
using testing::kOnePulse;

constexpr std::uint64_t kHalf = std::uint64_t{1} << 63;  // a feed tick in two clocks
constexpr std::uint32_t kLaser = 1;
constexpr std::uint32_t kSpindle = 2;
constexpr std::uint32_t kBoth = kLaser | kSpindle;

CardConfig with_emergency_stop(bool level = true) {
  CardConfig config;
  config.engines = RegisterFile::kDefaultEngines | card_map::engines::kEmergencyStop;
  config.emergency_stop_level = level;
  return config;
}

// A core on a line of its first axis, one pulse per 8 clocks, with laser and spindle on.
class Running {
 public:
  explicit Running(const CardConfig& config = with_emergency_stop()) : bench(config) {
    bench.emergency_stop = !config.emergency_stop_level;
    bench.idle(300);
    bench.write(reg::kSlew, 0x100000);  // 1,024 clocks from full ratio to rest
    bench.write(reg::kOutputSafe, kSpindle << 16);
    bench.write(reg::kOutputSafeCause, kLaser << 16);
    bench.write(reg::kSetPlace, 0xF0003);
    bench.output(kBoth, 0);
    bench.line(100'000, {kOnePulse / 4});
    bench.feed(100'000, kHalf);
    bench.idle(2000);
    EXPECT_EQ(bench.core.outputs().output, kBoth);
  }
  void press(bool pressed) { bench.emergency_stop = pressed == bench.core.config().emergency_stop_level; }
  unsigned outputs() const { return bench.core.outputs().output; }
  std::uint32_t fault() const { return bench.core.outputs().fault; }
  void clear() { bench.write(reg::kFault, 0x7FFFF); }

  CoreBench bench;
};

TEST(EmergencyStop, ItIsLatchedIsACauseAfterThreeClocksAndStopsAtOnce) {
  for (const bool level : {true, false}) {
    Running card(with_emergency_stop(level));
    card.press(true);
    card.bench.idle(1);
    card.press(false);
    EXPECT_EQ(card.outputs(), kSpindle) << "the laser, by the latch";
    EXPECT_EQ(card.fault(), 0U);
    card.bench.idle(2);
    EXPECT_EQ(card.fault(), field::kFaultEmergencyStop);
    const std::uint32_t position = card.bench.core.position(0);
    card.bench.idle(200);
    EXPECT_LE(card.bench.core.position(0) - position, 4U) << "ticks that were taken, and no more";
    EXPECT_EQ(card.outputs(), 0U) << "and the spindle at rest";
    EXPECT_EQ(card.bench.read(reg::kStopFault), field::kFaultEmergencyStop);
    EXPECT_EQ(card.bench.read(reg::kRestFault), field::kFaultEmergencyStop);
    EXPECT_EQ(card.bench.read(reg::kPlace) & 0xF0F, 0xE0EU) << "the axis that moved may have lost steps";
  }
}

TEST(EmergencyStop, ItIsNotClearedWhilePressedAndClearingMovesNothing) {
  Running card;
  card.press(true);
  card.bench.idle(200);
  card.clear();
  card.bench.idle(10);
  EXPECT_EQ(card.fault(), field::kFaultEmergencyStop);
  EXPECT_FALSE(card.bench.line(10, {kOnePulse}));
  card.press(false);
  card.bench.idle(10);
  EXPECT_EQ(card.fault(), field::kFaultEmergencyStop) << "released, not cleared";
  const std::uint32_t position = card.bench.core.position(0);
  card.clear();
  card.bench.idle(1000);
  EXPECT_EQ(card.fault(), 0U);
  EXPECT_EQ(card.bench.core.position(0), position);
  EXPECT_EQ(card.outputs(), 0U) << "nothing is switched on again";
  card.bench.write(reg::kControl, field::kControlAbort);
  card.bench.number = 0;
  card.bench.output(kBoth, 0);
  card.bench.idle(30);
  EXPECT_EQ(card.outputs(), kBoth) << "but by a command";
}

// The card first fills its registers: this loses no snapshot, and nothing can begin meanwhile.
TEST(EmergencyStop, PressedAtPowerUpItIsACauseWhenAccessesAreAnswered) {
  CoreBench bench(with_emergency_stop());
  bench.emergency_stop = true;
  bench.idle(250);
  EXPECT_EQ(bench.core.outputs().fault, 0U);
  bench.idle(300);
  EXPECT_EQ(bench.core.outputs().fault, field::kFaultEmergencyStop);
  EXPECT_EQ(bench.read(reg::kStopFault), field::kFaultEmergencyStop);
  EXPECT_EQ(bench.read(reg::kRestFault), field::kFaultEmergencyStop);
  EXPECT_GT(bench.read(reg::time_lo(card_map::Area::Stop)), 250U);
  EXPECT_EQ(bench.read(reg::kHoldLimit), card_map::find_register(reg::kHoldLimit).entry->reset);
}

// A clear after the press clears it; otherwise the press is a new stop. No press is lost.
TEST(EmergencyStop, APressBesideAClearCountsAtEveryClock) {
  for (unsigned at = 0; at < 12; ++at) {
    Running card;
    card.press(true);
    card.bench.idle(100);
    card.press(false);
    card.bench.idle(100);
    CoreModel::Inputs in;
    in.request = in.write = true;
    in.address = reg::kFault;
    in.data = field::kFaultEmergencyStop;
    unsigned cleared_at = 100;
    for (unsigned i = 0; i < 20; ++i) {
      card.press(i == at);
      card.bench.clock(i == 0 ? in : CoreModel::Inputs{});
      if (card.bench.core.answer().ack) cleared_at = i;
    }
    EXPECT_LT(cleared_at, 20U);
    // The clear takes effect one clock after its answer is visible, and uses the pin as it was two clocks before.
    const bool after = at > cleared_at || at + 1 == cleared_at;
    EXPECT_EQ(card.fault() != 0, after) << at << " " << cleared_at;
    EXPECT_EQ(card.bench.core.state().emergency_stop.latched(), after) << at;
  }
}

TEST(EmergencyStop, OnARampThePlaceStaysAndNoOutputComesOnAgain) {
  Running card;
  card.bench.write(reg::kStopReaction, field::kStopReactionEmergencyStop);
  card.press(true);
  card.bench.idle(1);
  card.press(false);
  const std::uint32_t position = card.bench.core.position(0);
  card.bench.idle(100);
  EXPECT_EQ(card.outputs(), kSpindle) << "the laser goes off at once, the spindle at rest";
  card.bench.idle(1500);
  EXPECT_GT(card.bench.core.position(0) - position, 30U);
  EXPECT_EQ(card.outputs(), 0U);
  EXPECT_EQ(card.bench.read(reg::kPlace) & 0xF0F, 0xF0FU);
}

TEST(EmergencyStop, ACardWithoutItHearsNothing) {
  CardConfig config;
  Running card(config);
  card.press(true);
  card.bench.idle(500);
  EXPECT_EQ(card.fault(), 0U);
  EXPECT_EQ(card.outputs(), kBoth);
}

TEST(SafeAtTheCause, TheLaserGoesOffWithFaultAndTheSpindleAtRest) {
  Running card;
  // A watchdog with a ramped stop: another kind of cause.
  card.bench.write(reg::kWatchdog, 1);
  unsigned laser = 0;
  unsigned spindle = 0;
  unsigned fault = 0;
  for (unsigned i = 1; i < 70'000; ++i) {
    card.bench.idle(1);
    if (fault == 0 && card.fault() != 0) fault = i;
    if (laser == 0 && (card.outputs() & kLaser) == 0) laser = i;
    if (spindle == 0 && (card.outputs() & kSpindle) == 0) spindle = i;
  }
  EXPECT_EQ(laser, fault) << "in the clock in which FAULT shows it";
  EXPECT_GT(spindle, fault + 900);
}

TEST(SafeAtTheCause, AnAbortIsCauseAndRest) {
  Running card;
  card.bench.write(reg::kControl, field::kControlAbort);
  card.bench.idle(3);
  EXPECT_EQ(card.outputs(), 0U);
}

TEST(SafeAtTheCause, ItGoesBeforeTheLevelsAtRest) {
  Running card;
  card.bench.write(reg::kOutputSafe, kLaser << 16 | kLaser);
  card.press(true);
  card.bench.idle(200);
  EXPECT_EQ(card.outputs() & kLaser, 0U);
}

TEST(SafeAtTheCause, AnOutputOnTheRampDoesNotSwitchItOn) {
  Running card;
  card.bench.write(reg::kControl, field::kControlAbort);
  card.bench.number = 0;
  card.bench.output(0, kBoth);
  card.bench.line(1130, {kOnePulse / 4});
  card.bench.output(kBoth, 0);  // executed during the ramp
  card.bench.line(100'000, {kOnePulse / 4});
  card.bench.feed(101'130, kHalf);
  card.bench.idle(2000);
  card.bench.write(reg::kStopReaction, field::kStopReactionEmergencyStop);
  EXPECT_EQ(card.outputs(), 0U);
  card.press(true);
  bool spindle = false;
  for (unsigned i = 0; i < 1100; ++i) {
    card.bench.idle(1);
    EXPECT_EQ(card.outputs() & kLaser, 0U);
    spindle = spindle || (card.outputs() & kSpindle) != 0;
  }
  EXPECT_TRUE(spindle) << "the OUTPUT came on the ramp";
}

}  // namespace
}  // namespace trammel::model::emergency_stop_test
