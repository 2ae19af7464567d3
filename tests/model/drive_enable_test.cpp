// Enable and brake of the drives, charge pump and health, over the core's port and pins, against
// docs/reference/behaviour.md.
#include "trammel/model/drive_enable.hpp"

#include <gtest/gtest.h>

#include "core_bench.hpp"
#include "trammel/skip/card.hpp"

namespace trammel::model::drive_enable_test {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;
using testing::CoreBench;
using testing::kOnePulse;

constexpr std::uint64_t kUnit = std::uint64_t{1} << DriveEnable::kDelayBits;
constexpr std::uint64_t kIdleUnit = std::uint64_t{1} << DriveEnable::kIdleBits;
constexpr std::uint64_t kHalf = std::uint64_t{1} << 63;  // a feed tick in two clocks
constexpr std::uint32_t kEnable = 1;                     // outputs
constexpr std::uint32_t kBrake = 2;
constexpr std::uint32_t kPump = 4;
constexpr std::uint32_t kHealthy = 8;

CardConfig with_enables() {
  CardConfig config;
  config.engines = RegisterFile::kDefaultEngines | card_map::engines::kEmergencyStop | card_map::engines::kEnables;
  config.output_idle = kBrake;  // a high level sets the brake
  return config;
}

// Axes 0 and 1 have drives with an enable and a brake.
class Drives {
 public:
  explicit Drives(std::uint32_t idle = 0) : bench(with_enables()) {
    bench.idle(300);
    bench.write(reg::kOutputRoles, kBrake << 16 | kEnable);
    bench.write(reg::kBrakeReleaseDelay, 1);
    bench.write(reg::kEnableDelay, 2);
    bench.write(reg::kStopDelay, 3);
    bench.write(reg::kBrakeSetDelay, 4);
    bench.write(reg::kEnableIdle, idle);
    bench.write(reg::kEnableAxes, 0b11);
    bench.write(reg::kSetPlace, 0xF0003);
  }
  bool enabled() const { return (bench.core.outputs().output & kEnable) != 0; }
  bool released() const { return (bench.core.outputs().output & kBrake) == 0; }
  std::uint32_t status() const { return bench.core.outputs().status; }
  std::uint32_t place() { return bench.read(reg::kPlace) & 0xF0F; }
  void line(std::uint64_t ticks) {
    bench.feed(ticks, kHalf);
    bench.line(ticks, {kOnePulse / 4, -kOnePulse / 4});
  }
  void run(std::uint64_t clocks) { skip::run(bench.core, clocks, {0, bench.emergency_stop}); }
  // Clocks until the condition holds, at most `limit`.
  template <class Condition>
  std::uint64_t until(const Condition& condition, std::uint64_t limit = 100'000) {
    std::uint64_t clocks = 0;
    for (; !condition() && clocks < limit; ++clocks) bench.idle(1);
    return clocks;
  }

  CoreBench bench;
};

TEST(DriveEnable, MotionWaitsForTheDrivesAndLosesNothing) {
  Drives card;
  EXPECT_FALSE(card.enabled());
  EXPECT_FALSE(card.released());
  card.line(1000);
  card.until([&] { return card.enabled(); });
  EXPECT_NE(card.status() & field::kStatusEnabled, 0U);
  EXPECT_NE(card.status() & field::kStatusEnableWaits, 0U);
  EXPECT_EQ(card.until([&] { return card.released(); }), kUnit + 1);
  EXPECT_EQ(card.bench.core.position(0), 0U);
  const std::uint64_t to_tick = card.until([&] { return card.bench.core.outputs().tick; });
  EXPECT_GT(to_tick, 2 * kUnit);
  EXPECT_LT(to_tick, 2 * kUnit + 20);
  EXPECT_EQ(card.status() & field::kStatusEnableWaits, 0U);
  EXPECT_TRUE(card.bench.finish(10'000));
  EXPECT_EQ(card.bench.core.position(0), 250U);
  EXPECT_EQ(card.bench.core.position(1), static_cast<std::uint32_t>(-250));
  EXPECT_TRUE(card.enabled()) << "for ever, with ENABLE_IDLE 0";
}

TEST(DriveEnable, ADirectMoveWaitsToo) {
  Drives card;
  card.bench.write(reg::frequency_hi(0), 0x10);
  card.bench.write(reg::count(0), 20);
  card.bench.write(reg::kLengthLo, 2000);
  ASSERT_TRUE(card.bench.write(reg::kStart, 1));
  card.bench.idle(3 * kUnit - 100);
  EXPECT_EQ(card.bench.core.position(0), 0U);
  EXPECT_TRUE(card.bench.finish(10'000));
  EXPECT_EQ(card.bench.core.position(0), 20U);
}

TEST(DriveEnable, AfterTheIdleTimeTheBrakeIsSetAndTheDrivesLoseTheirPlace) {
  Drives card(1);
  card.line(100);
  EXPECT_TRUE(card.bench.finish(100'000));
  card.run(kIdleUnit - 100);
  EXPECT_TRUE(card.released());
  EXPECT_EQ(card.place(), 0xF0FU);
  card.run(200);
  EXPECT_TRUE(card.released()) << "STOP_DELAY";
  card.run(3 * kUnit);
  EXPECT_FALSE(card.released());
  EXPECT_TRUE(card.enabled()) << "BRAKE_SET_DELAY";
  EXPECT_EQ(card.place(), 0xF0FU);
  card.run(4 * kUnit);
  EXPECT_FALSE(card.enabled());
  EXPECT_EQ(card.place(), 0xC0CU) << "the axes that the sequence serves";
}

TEST(DriveEnable, KeepsPlaceNamesAxesWhoseDrivesMayBeDisabled) {
  Drives card(1);
  card.bench.write(reg::kKeepsPlace, 0b10);
  card.line(100);
  EXPECT_TRUE(card.bench.finish(100'000));
  card.run(kIdleUnit + 8 * kUnit);
  EXPECT_FALSE(card.enabled());
  EXPECT_EQ(card.place(), 0xE0EU);
}

TEST(DriveEnable, TheHostsOrderEnablesAndKeepsEnabled) {
  Drives card(1);
  card.bench.write(reg::kEnable, field::kEnableOn);
  card.run(2 * kIdleUnit);
  EXPECT_TRUE(card.enabled());
  card.bench.write(reg::kEnable, 0);
  card.run(20 * kUnit);
  EXPECT_FALSE(card.enabled());
  // With the bit `manual`, motion waits for the host to enable the drives.
  card.bench.write(reg::kEnable, field::kEnableManual);
  card.line(100);
  card.run(kIdleUnit);
  EXPECT_FALSE(card.enabled());
  EXPECT_EQ(card.bench.core.position(0), 0U);
  EXPECT_NE(card.status() & field::kStatusEnableWaits, 0U);
  card.bench.write(reg::kEnable, field::kEnableManual | field::kEnableOn);
  EXPECT_TRUE(card.bench.finish(10 * kUnit));
  EXPECT_EQ(card.bench.core.position(0), 25U);
}

TEST(DriveEnable, TheEmergencyStopDisablesAtOnceAndNothingEnablesAgainByItself) {
  Drives card;
  card.line(100'000);
  card.run(4 * kUnit);
  ASSERT_TRUE(card.enabled());
  card.bench.emergency_stop = true;
  card.bench.idle(1);
  card.bench.emergency_stop = false;
  EXPECT_FALSE(card.enabled());
  EXPECT_FALSE(card.released());
  card.bench.idle(200);
  EXPECT_EQ(card.place(), 0xC0CU);
  const std::uint32_t position = card.bench.core.position(0);
  card.bench.write(reg::kFault, 0x7FFFF);
  card.bench.write(reg::kControl, field::kControlAbort);
  card.run(10 * kUnit);
  EXPECT_FALSE(card.enabled());
  EXPECT_EQ(card.bench.core.position(0), position);
  card.bench.number = 0;
  card.line(100);
  EXPECT_TRUE(card.bench.finish(10 * kUnit));
  EXPECT_TRUE(card.enabled());
}

TEST(DriveEnable, OtherFaultsDisableAtRestAndBarWhileTheyStand) {
  Drives card;
  card.bench.write(reg::kDisableCauses, field::kFaultWatchdog);
  card.line(1'000'000);
  card.run(4 * kUnit);
  card.bench.write(reg::kSlew, 0x10000);  // a ramp of 16,384 clocks
  card.bench.write(reg::kWatchdog, 1);
  card.run(66'000);
  ASSERT_EQ(card.bench.core.outputs().fault, field::kFaultWatchdog);
  ASSERT_NE(card.status() & field::kStatusStopping, 0U);
  EXPECT_TRUE(card.enabled()) << "on the ramp";
  card.run(17'000 + 8 * kUnit);
  EXPECT_FALSE(card.enabled());
  card.bench.write(reg::kEnable, field::kEnableOn);
  card.run(8 * kUnit);
  EXPECT_FALSE(card.enabled()) << "barred";
  card.bench.write(reg::kEnable, 0);
  card.bench.write(reg::kWatchdog, 0);
  card.bench.write(reg::kFault, 0x7FFFF);
  card.run(8 * kUnit);
  EXPECT_FALSE(card.enabled()) << "clearing enables nothing";
}

TEST(DriveEnable, AResetDisablesAndRolesAreGone) {
  Drives card;
  card.line(100'000);
  card.run(4 * kUnit);
  ASSERT_TRUE(card.enabled());
  CoreModel::Inputs in;
  in.rst = true;
  card.bench.clock(in);
  card.bench.idle(1);
  EXPECT_EQ(card.bench.core.outputs().output, kBrake) << "the strap";
  card.run(10'000);
  EXPECT_EQ(card.bench.core.outputs().output, kBrake);
}

TEST(DriveEnable, WithoutAxesNothingWaits) {
  CoreBench bench(with_enables());
  bench.idle(300);
  bench.line(100, {kOnePulse / 4});
  bench.feed(100, kHalf);
  EXPECT_TRUE(bench.finish(1000));
  EXPECT_EQ(bench.core.position(0), 25U);
  EXPECT_EQ(bench.core.outputs().status & field::kStatusEnabled, 0U);
}

TEST(CardHealth, TheWaveRunsWhileTheCardIsHealthy) {
  CoreBench bench(with_enables());
  bench.idle(300);
  bench.write(reg::kHealthRoles, kHealthy << 16 | kPump);
  bench.write(reg::kHealthCauses, field::kFaultEmergencyStop | field::kHealthCausesNoWatchdog);
  bench.write(reg::kChargePump, 50);
  const auto edges = [&](unsigned clocks) {
    unsigned count = 0;
    for (; clocks != 0; --clocks) {
      const bool before = (bench.core.outputs().output & kPump) != 0;
      bench.idle(1);
      count += before != ((bench.core.outputs().output & kPump) != 0) ? 1U : 0U;
    }
    return count;
  };
  EXPECT_EQ(edges(500), 0U) << "the watchdog does not run";
  bench.write(reg::kWatchdog, 100);
  bench.idle(60);
  EXPECT_EQ(edges(5000), 100U);
  EXPECT_NE(bench.core.outputs().output & kHealthy, 0U);
  bench.emergency_stop = true;
  bench.idle(10);
  EXPECT_EQ(bench.core.outputs().output & (kHealthy | kPump), 0U);
  EXPECT_EQ(edges(500), 0U);
}

TEST(OutputRoles, CommandsDoNotChangeThem) {
  CoreBench bench(with_enables());
  bench.idle(300);
  bench.write(reg::kOutputRoles, kEnable);
  bench.output(0xF, 0);
  bench.idle(30);
  EXPECT_EQ(bench.core.outputs().output, 0xFU & ~kEnable);
}

}  // namespace
}  // namespace trammel::model::drive_enable_test
