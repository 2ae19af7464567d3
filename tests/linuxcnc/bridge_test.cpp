// The bridge on the golden model, in simulated time: compares LinuxCNC's targets with the card's steps, and tests the
// causes that stop and start a machine.
#include "trammel/linuxcnc/bridge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "servo_bench.hpp"
#include "trammel/driver/low_level/card_parts.hpp"

namespace trammel::linuxcnc {
namespace {

bool is_stopped(const ServoBench& bench) { return (bench.status().flags & TRAMMEL_STATUS_FAULT) != 0; }

// Runs periods until the card is at rest.
void come_to_rest(ServoBench& bench, std::uint32_t flags = 0) {
  for (int n = 0; n < 2000 && bench.card->busy(); ++n) bench.period({}, flags);
  EXPECT_FALSE(bench.card->busy());
}

// 4,000 periods, each target met within half a pulse. The clocks of the model and of LinuxCNC differ by up to 50 ppm.
TEST(Bridge, MeetsEveryTargetWithinHalfAPulse) {
  for (const int drift : {0, 1, -1}) {
    ServoBench bench;
    bench.enable();
    constexpr int kPeriods = 4'000;
    for (int n = 0; n < kPeriods; ++n) {
      bench.post(servo_sines(n, kPeriods));
      bench.bridge->turn(std::chrono::nanoseconds(0));
      bench.pass(kServoClocks + static_cast<std::uint64_t>(n % 20 == 0 ? drift : 0));
    }
    for (int n = 0; n < 20; ++n) bench.period(servo_sines(1, 1));
    EXPECT_FALSE(is_stopped(bench)) << bench.status().text;
    EXPECT_GT(bench.lines.size(), 3'900U);
    EXPECT_LE(bench.farthest(), 0.5);
    EXPECT_GT(bench.steps.size(), 9'000U);
    EXPECT_EQ(bench.status().late, 0U);
    EXPECT_EQ(bench.status().missing, 0U);
    EXPECT_GE(bench.status().ahead, 1U);
    EXPECT_LE(bench.status().ahead, 3U);
  }
}

TEST(Bridge, PositionsCountFromTheCardsMachineZero) {
  ServoBench bench;
  bench.enable();
  for (int n = 1; n <= 100; ++n) bench.period({n * 1.0});
  for (int n = 0; n < 10; ++n) bench.period({100});
  for (int n = 0; n < 10; ++n) bench.period({100}, 0);
  EXPECT_EQ(bench.status().position[0], 100);
  EXPECT_EQ(bench.status().state, std::uint32_t{TRAMMEL_IDLE});
  // A new stream starts at this position.
  for (int n = 0; n < 10; ++n) bench.period({100});
  for (int n = 1; n <= 50; ++n) bench.period({100.0 - n});
  for (int n = 0; n < 10; ++n) bench.period({50});
  EXPECT_EQ(bench.status().position[0], 50);
  EXPECT_FALSE(is_stopped(bench));
}

TEST(Bridge, DisabledInMotionItRampsDownAlongItsLine) {
  ServoBench bench;
  bench.enable();
  for (int n = 1; n <= 200; ++n) bench.period({n * 5.0, n * -2.0});
  bench.period({}, 0);
  come_to_rest(bench);
  const std::int64_t x = bench.status().position[0];
  EXPECT_GT(x, 1000);
  EXPECT_LT(x, 1800);
  EXPECT_NEAR(static_cast<double>(bench.status().position[1]), -0.4 * static_cast<double>(x), 1);
  EXPECT_FALSE(is_stopped(bench));
  EXPECT_EQ(bench.status().state, std::uint32_t{TRAMMEL_IDLE});
}

// The card begins when the lead is queued. A machine that is off again before that has not moved, and nothing is wrong.
TEST(Bridge, DisabledBeforeTheLeadIsQueuedItDoesNotMove) {
  ServoBench bench;
  trammel_settings settings{};
  settings.lead_periods = 30;
  bench.give(settings);
  for (int n = 0; n < 3; ++n) bench.period({}, 0);
  for (int n = 1; n <= 10; ++n) bench.period({n * 5.0});
  EXPECT_EQ(bench.status().state, std::uint32_t{TRAMMEL_STREAMING});
  for (int n = 0; n < 10; ++n) bench.period({}, 0);
  EXPECT_FALSE(is_stopped(bench)) << bench.status().text;
  EXPECT_EQ(bench.status().state, std::uint32_t{TRAMMEL_IDLE});
  EXPECT_FALSE(bench.card->busy());
  EXPECT_EQ(bench.status().position[0], 0);
  EXPECT_TRUE(bench.steps.empty());
  bench.enable();
  for (int n = 1; n <= 100; ++n) bench.period({n * 1.0});
  for (int n = 0; n < 100; ++n) bench.period({100});
  EXPECT_EQ(bench.status().position[0], 100);
}

// At rest, a missing period has no effect. In motion it is a stop.
TEST(Bridge, AMissingPeriodAtRestIsCountedAndForgotten) {
  ServoBench bench;
  bench.enable();
  bench.pass(100 * kServoClocks);
  for (int n = 0; n < 500; ++n) bench.period({});
  EXPECT_EQ(bench.status().missing, 1U);
  EXPECT_FALSE(is_stopped(bench));
  for (int n = 1; n <= 100; ++n) bench.period({n * 1.0});
  for (int n = 0; n < 10; ++n) bench.period({100});
  EXPECT_EQ(bench.status().position[0], 100);
}

// The card is ready again before LinuxCNC has moved too far for one line.
TEST(Bridge, AMotionRightBehindAMissingPeriodAtRestIsFollowed) {
  ServoBench bench;
  bench.enable();
  const std::uint32_t slew = bench.card->parts().registers.read(card_map::reg::kSlew);
  bench.pass(100 * kServoClocks);
  for (int n = 1; n <= 900; ++n) bench.period({n * 1.6});
  for (int n = 0; n < 10; ++n) bench.period({1440});
  EXPECT_EQ(bench.status().missing, 1U);
  EXPECT_FALSE(is_stopped(bench)) << bench.status().text;
  EXPECT_EQ(bench.status().position[0], 1440);
  EXPECT_EQ(bench.card->parts().registers.read(card_map::reg::kSlew), slew) << "what moves is held on its ramp";
}

TEST(Bridge, AMissingPeriodInMotionStopsUntilItIsCleared) {
  ServoBench bench;
  bench.enable();
  for (int n = 1; n <= 200; ++n) bench.period({n * 5.0});
  bench.pass(200 * kServoClocks);  // the owner sleeps, so the card ramps down by itself
  for (int n = 0; n < 10; ++n) bench.period({1000 + n * 5.0});
  ASSERT_TRUE(is_stopped(bench));
  EXPECT_EQ(bench.status().cause, 11U);  // MISSING_PERIOD is bit 10
  EXPECT_EQ(bench.status().missing, 1U);
  const std::int64_t stands = bench.status().position[0];
  EXPECT_GT(stands, bench.status().stop_position[0]);
  // It moves neither by the targets nor by the clear, nor by both.
  for (int n = 0; n < 50; ++n) bench.period({2000 + n * 5.0});
  for (int n = 0; n < 50; ++n) bench.period({2000}, TRAMMEL_PERIOD_ENABLE | TRAMMEL_PERIOD_CLEAR);
  EXPECT_FALSE(is_stopped(bench));
  // This is longer than the time base needs to return.
  for (int n = 0; n < 600; ++n) bench.period({2000 + n * 5.0});
  EXPECT_FALSE(is_stopped(bench)) << bench.status().text;
  EXPECT_EQ(bench.status().position[0], stands);
  // It moves after the machine was disabled, and enabled at this position.
  const double at = static_cast<double>(stands);
  bench.enable({at});
  for (int n = 1; n <= 100; ++n) bench.period({at + n});
  for (int n = 0; n < 10; ++n) bench.period({at + 100});
  EXPECT_EQ(bench.status().position[0], stands + 100);
}

TEST(Bridge, ATargetThatIsTooFarStopsOnARampAndIsNamed) {
  ServoBench bench;
  bench.enable();
  for (int n = 1; n <= 200; ++n) bench.period({n * 5.0});
  bench.period({5000});
  come_to_rest(bench, TRAMMEL_PERIOD_ENABLE);
  ASSERT_TRUE(is_stopped(bench));
  EXPECT_EQ(bench.status().cause, std::uint32_t{TRAMMEL_CAUSE_TARGET});
  EXPECT_EQ(bench.status().refused, 1U);
  EXPECT_THAT(std::string(bench.status().text), ::testing::HasSubstr("too fast"));
  EXPECT_LT(bench.status().position[0], 1800);
}

// 1 % of the periods never arrive. The next line is longer by such a period, and each target that arrived is met.
TEST(Bridge, DroppedPeriodsAreMadeUp) {
  ServoBench bench;
  bench.enable();
  constexpr int kPeriods = 5'000;
  int dropped = 0;
  for (int n = 0; n < kPeriods; ++n) {
    if (n % 100 == 50) {
      ++bench.number;
      ++dropped;
      bench.bridge->turn(std::chrono::nanoseconds(0));
      bench.pass();
    } else {
      bench.period(servo_sines(n, kPeriods));
    }
  }
  for (int n = 0; n < 20; ++n) bench.period(servo_sines(1, 1));
  EXPECT_FALSE(is_stopped(bench)) << bench.status().text;
  EXPECT_EQ(bench.status().dropped, static_cast<std::uint32_t>(dropped));
  EXPECT_LE(bench.farthest(), bench.status().late == 0 ? 0.5 : 3);
  EXPECT_EQ(bench.status().missing, 0U);
}

// A period arrives later than the lead: the card continues along its line, and then returns to the targets.
TEST(Bridge, ALatePeriodIsCaughtUp) {
  ServoBench bench;
  bench.enable();
  for (int n = 1; n <= 200; ++n) bench.period({n * 2.0});
  bench.pass(2600);
  for (int n = 201; n <= 203; ++n) bench.post({n * 2.0});
  for (int n = 204; n <= 400; ++n) bench.period({n * 2.0});
  for (int n = 0; n < 20; ++n) bench.period({800});
  EXPECT_FALSE(is_stopped(bench)) << bench.status().text;
  EXPECT_GE(bench.status().late, 1U);
  EXPECT_EQ(bench.status().position[0], 800);
}

// The component finds the ring full and drops periods. The card has stopped long before.
TEST(Bridge, AFullRingStopsTheMachine) {
  ServoBench bench;
  bench.enable();
  for (int n = 1; n <= 200; ++n) bench.period({n * 2.0});
  int full = 0;
  for (int n = 201; n <= 600; ++n) {
    full += bench.post({n * 2.0}) ? 0 : 1;
    bench.pass();
  }
  EXPECT_EQ(full, 400 - TRAMMEL_PERIODS);
  for (int n = 601; n <= 620; ++n) bench.period({n * 2.0});
  EXPECT_TRUE(is_stopped(bench));
  EXPECT_EQ(bench.status().missing, 1U);
  EXPECT_LT(bench.status().position[0], 800);
}

TEST(Bridge, CapturesTheProbesEdge) {
  ServoBench bench;
  bench.edges = {{9, 0, 137}};
  bench.enable();
  for (int n = 1; n <= 100; ++n) bench.period({n * 6.0});
  EXPECT_EQ(bench.status().captures, 1U);
  EXPECT_EQ(bench.status().capture_position[0], bench.met);
  EXPECT_NEAR(static_cast<double>(*bench.met), 137, 5);
  EXPECT_NE(bench.status().flags & TRAMMEL_STATUS_PROBE, 0U);
}

TEST(Bridge, LatchesTheIndexOfTheJointThatWaits) {
  ServoBench bench;
  bench.edges = {{3, 0, 250, false}};  // a switch to ground
  bench.enable();
  const std::uint32_t waits = TRAMMEL_PERIOD_ENABLE | 1U << TRAMMEL_PERIOD_INDEX_SHIFT;
  for (int n = 1; n <= 200; ++n) bench.period({n * 1.0});
  for (int n = 201; n <= 240; ++n) bench.period({n * 1.0}, waits);
  EXPECT_EQ(bench.status().index_latched, 0U);
  for (int n = 241; n <= 300; ++n) bench.period({n * 1.0}, waits);
  EXPECT_EQ(bench.status().index_latched, 1U);
  EXPECT_EQ(bench.status().index_position[0], 250);
  for (int n = 0; n < 5; ++n) bench.period({300});
  EXPECT_EQ(bench.status().index_latched, 0U);
  // Joint 1 has no index input.
  bench.period({300}, TRAMMEL_PERIOD_ENABLE | 2U << TRAMMEL_PERIOD_INDEX_SHIFT);
  EXPECT_THAT(std::string(bench.status().text), ::testing::HasSubstr("no index input"));
}

TEST(Bridge, AnEmergencyStopStaysUntilItIsCleared) {
  ServoBench bench;
  bench.enable();
  for (int n = 1; n <= 200; ++n) bench.period({n * 2.0});
  bench.engine->set_emergency_stop(true);
  for (int n = 201; n <= 260; ++n) bench.period({n * 2.0});
  ASSERT_TRUE(is_stopped(bench));
  EXPECT_EQ(bench.status().cause, 13U);  // EMERGENCY_STOP is bit 12
  bench.period({}, 0);
  bench.period({}, TRAMMEL_PERIOD_CLEAR);
  EXPECT_TRUE(is_stopped(bench)) << "the button is pressed";
  bench.engine->set_emergency_stop(false);
  bench.period({}, 0);
  bench.period({}, TRAMMEL_PERIOD_CLEAR);
  EXPECT_FALSE(is_stopped(bench));
  const std::int64_t stands = bench.status().position[0];
  bench.enable({static_cast<double>(stands)});
  EXPECT_EQ(bench.status().position[0], stands);
  EXPECT_FALSE(is_stopped(bench));
}

// LinuxCNC stays enabled, but the card of the new owner stays at rest.
TEST(Bridge, ANewOwnerMovesNothingBeforeTheMachineWasDisabled) {
  ServoBench bench;
  for (int n = 1; n <= 200; ++n) bench.period({n * 2.0});
  EXPECT_EQ(bench.status().position[0], 0);
  EXPECT_EQ(bench.status().state, std::uint32_t{TRAMMEL_IDLE});
  bench.enable({});
  bench.period({1});
  EXPECT_EQ(bench.status().state, std::uint32_t{TRAMMEL_STREAMING});
}

// Targets that come during a hold are followed after it. Eight seconds at rest do not fill a queue.
// A machine that is on and not followed is told about once, after a quarter of a second.
TEST(Bridge, TellsWhyItDoesNotFollow) {
  ServoBench bench;
  const auto tells = ::testing::Contains(::testing::HasSubstr("not followed: it was not seen off"));
  for (int n = 0; n < 249; ++n) bench.period({});
  EXPECT_THAT(bench.notes, ::testing::Not(tells));
  for (int n = 0; n < 300; ++n) bench.period({});
  EXPECT_THAT(bench.notes, tells.Times(1));
  bench.notes.clear();
  bench.enable();
  for (int n = 0; n < 300; ++n) bench.period({});
  EXPECT_EQ(bench.status().state, std::uint32_t{TRAMMEL_STREAMING});
  EXPECT_THAT(bench.notes, ::testing::Not(tells));
}

TEST(Bridge, AHoldLosesNothing) {
  ServoBench bench;
  bench.enable();
  const std::uint32_t held = TRAMMEL_PERIOD_ENABLE | TRAMMEL_PERIOD_HOLD;
  for (int n = 1; n <= 200; ++n) bench.period({n * 2.0});
  for (int n = 201; n <= 500; ++n) bench.period({n * 2.0}, held);
  for (int n = 0; n < 8'000; ++n) bench.period({1000}, held);
  EXPECT_NE(bench.status().flags & TRAMMEL_STATUS_HELD, 0U);
  EXPECT_LT(bench.status().position[0], 1000);
  for (int n = 0; n < 1500; ++n) bench.period({1000});
  EXPECT_FALSE(is_stopped(bench)) << bench.status().text;
  EXPECT_EQ(bench.status().position[0], 1000);
}

TEST(Bridge, RefusesPathsByNameWithoutAPlanner) {
  ServoBench bench;
  bench.enable();
  trammel_region& memory = bench.region.memory();
  memory.operations[0].kind = TRAMMEL_LINE;
  memory.operations[0].id = 7;
  memory.operation_head = 1;
  bench.post({}, TRAMMEL_PERIOD_ENABLE | TRAMMEL_PERIOD_PATH);
  int turns = 0;
  bench.bridge->run([&] { return ++turns > 5; });
  EXPECT_EQ(bench.status().refusals, 1U);
  EXPECT_EQ(bench.status().refusal, 7);
  EXPECT_THAT(std::string(bench.status().text), ::testing::HasSubstr("a line was refused"));
}

}  // namespace
}  // namespace trammel::linuxcnc
