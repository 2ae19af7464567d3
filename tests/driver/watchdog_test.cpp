// The card's watchdog: writes of the driver; on the model, that waiting programs restart it in time and silent programs
// do not.
#include <gmock/gmock.h>

#include <algorithm>
#include <thread>

#include "error_message.hpp"
#include "register_stub.hpp"
#include "stream_commands.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/interrupt.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/driver/position_stream.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/driver/watchdog_scope.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using test::RegisterStub;
using test::was_read;
using test::wrote;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
namespace reg = card_map::reg;
namespace field = card_map::field;

// Faults after a program was silent for too long.
constexpr std::uint32_t kSilence = field::kFaultWatchdog | field::kFaultLinkLoss;

// Each time is written to WATCHDOG and to LINK_TIMEOUT.
std::vector<test::Made> both(const std::vector<std::uint32_t>& units) {
  std::vector<test::Made> made;
  for (const std::uint32_t time : units) {
    made.push_back(wrote(reg::kWatchdog, time));
    made.push_back(wrote(reg::kLinkTimeout, time));
  }
  return made;
}

// A card with a map before 3.5 has no LINK_TIMEOUT.
TEST(Watchdog, AnOlderCardHasItAlone) {
  RegisterStub bus;
  bus.values[reg::kMapVersion] = (card_map::kMapVersionValue & ~0xFFFFU) | 4U;
  Card card = Card::open(bus);
  bus.forget();
  card.set_watchdog(1s);
  EXPECT_THAT(bus.log, ElementsAre(wrote(reg::kWatchdog, 16)));
  bus.forget();
  card.clear_faults();
  EXPECT_THAT(bus.log, ElementsAre(was_read(reg::kStatus), wrote(reg::kWatchdog, 16), wrote(reg::kFault, 0x7FFFF)));
}

TEST(Watchdog, TimesAreRoundedUpToItsUnit) {
  RegisterStub bus;  // 1 MHz: a unit is 65,536 us
  Card card = Card::open(bus);
  bus.forget();
  card.set_watchdog(1ns);
  card.set_watchdog(65'536us);
  card.set_watchdog(65'537us);
  card.set_watchdog(65'535 * 65'536us);
  card.set_watchdog(0ns);
  EXPECT_THAT(bus.log, ElementsAreArray(both({1, 1, 2, 65'535, 0})));
  bus.forget();
  EXPECT_THAT(argument_error([&] { card.set_watchdog(65'535 * 65'536us + 1ns); }), HasSubstr("up to 4294901 ms"));
  EXPECT_THAT(argument_error([&] { card.set_watchdog(-1s); }), HasSubstr("negative"));
  EXPECT_TRUE(bus.log.empty());
}

TEST(Watchdog, LooksStartItAnewWhereItIsSet) {
  RegisterStub bus;
  Card card = Card::open(bus);
  bus.forget();
  for (int i = 0; i < 100; ++i) serve_requests(card);
  EXPECT_TRUE(bus.log.empty());
  card.set_watchdog(1s);
  bus.forget();
  for (int i = 0; i < 64; ++i) serve_requests(card);
  EXPECT_THAT(bus.log, ElementsAreArray(both({16, 16})));
}

// On a slow link looks are rare.
TEST(Watchdog, ALookAfterAQuarterOfItsTimeStartsItAnew) {
  RegisterStub bus;
  Card card = Card::open(bus);
  card.set_watchdog(40ms);
  bus.forget();
  std::this_thread::sleep_for(11ms);
  serve_requests(card);
  EXPECT_THAT(bus.log, ElementsAreArray(both({1})));
}

TEST(Watchdog, AScopeEndsWithItOff) {
  RegisterStub bus;
  Card card = Card::open(bus);
  bus.forget();
  { const WatchdogScope scope(card, 1s); }
  std::vector<test::Made> made = both({16, 0});
  made.insert(made.begin() + 2, was_read(reg::kStatus));
  EXPECT_THAT(bus.log, ElementsAreArray(made));
}

// 2 s of motion with a watchdog of 10 ms.
class WatchdogOnModel : public ::testing::Test {
 protected:
  WatchdogOnModel() : card_(Card::open(*engine_)) { card_.set_watchdog(10ms); }

  void begin_line() {
    Stream stream(card_, {});
    stream.send({feed_of(kTicks), line_of(kTicks, 100'000), EndCommand{}});
    stream.flush();
  }

  static constexpr std::uint64_t kTicks = 12'500'000;  // 16 clocks each
  static sim::ModelOptions at_100_mhz() {
    sim::ModelOptions options;
    options.clock_hz = 100'000'000;
    return options;
  }
  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine(at_100_mhz());
  Card card_;
};

TEST_F(WatchdogOnModel, AWaitingProgramKeepsIt) {
  begin_line();
  card_.wait_until_idle(10s);
  EXPECT_EQ(engine_->positions()[0], 100'000);
  EXPECT_EQ(card_.read_faults(), 0U);
}

TEST_F(WatchdogOnModel, ASilentProgramLosesTheCard) {
  card_.set_slew_time(1ms);
  begin_line();
  engine_->sleep(500us);
  engine_->sleep(50ms);
  const Snapshot stop = card_.read_stop_snapshot();
  EXPECT_GT(stop.position[0], 400);
  const auto rest = engine_->positions()[0];
  EXPECT_GT(rest, stop.position[0]) << "on a ramp";
  try {
    card_.wait_until_idle(10s);
    FAIL() << "the fault is not seen";
  } catch (const FaultError& error) {
    EXPECT_THAT(error.what(), HasSubstr("WATCHDOG"));
  }
  card_.wait_until_stopped();
  const Rest where = card_.read_rest();
  EXPECT_TRUE(where.exact());
  EXPECT_EQ(where.position[0], rest);
  EXPECT_GT(where.time, stop.time);
  EXPECT_EQ(where.geometry_begun, 1U);
  EXPECT_GT(where.ticks_left, 0U);
  EXPECT_EQ(card_.read_faults(), kSilence);
  engine_->sleep(1s);
  EXPECT_EQ(engine_->positions()[0], rest) << "nothing moves by itself";
  card_.clear_faults();
  EXPECT_EQ(card_.read_faults(), 0U);
  engine_->sleep(5ms);
  EXPECT_EQ(engine_->positions()[0], rest);
  EXPECT_EQ(card_.read_faults(), 0U) << "its time began anew";
  begin_line();
  card_.wait_until_idle(10s);
  EXPECT_EQ(engine_->positions()[0], rest + 100'000);
}

// The card accepts commands of a program that clears the fault and continues at once.
TEST_F(WatchdogOnModel, ClearingOnTheRampWaitsForItsEnd) {
  card_.set_slew_time(10ms);
  begin_line();
  engine_->sleep(13ms);
  ASSERT_TRUE(card_.read_status().stopping);
  card_.clear_faults();
  EXPECT_EQ(card_.read_faults(), 0U);
  const Status now = card_.read_status();
  EXPECT_FALSE(now.stopping || now.busy);
  const std::int64_t rest = engine_->positions()[0];
  EXPECT_GT(rest, 700) << "the ramp went on for 7 ms";
  begin_line();
  card_.wait_until_idle(10s);
  EXPECT_EQ(engine_->positions()[0], rest + 100'000);
}

TEST(ClearFaults, OnARampThatDoesNotEndLeavesThem) {
  RegisterStub bus;
  Card card = Card::open(bus);
  bus.values[reg::kStatus] = field::kStatusStopping | field::kStatusFaulted;
  bus.values[reg::kSlew] = 1U << 20;  // a slew of 1024 clocks
  bus.forget();
  EXPECT_THROW(card.clear_faults(2ms), TimeoutError);
  EXPECT_GE(bus.slept, 3ms);
  EXPECT_LE(bus.slept, 4ms);
  {
    bus.on_access = [](const Access&) {
      std::this_thread::sleep_for(10ms);
      return true;
    };
    const InterruptScope interrupt([] { return true; });
    EXPECT_THROW(card.clear_faults(), InterruptedError);
  }
  const auto writes = [](const test::Made& access) { return std::get<0>(access); };
  EXPECT_EQ(std::count_if(bus.log.begin(), bus.log.end(), writes), 0);
}

TEST_F(WatchdogOnModel, AScopeLeavesACardThatMovesToIt) {
  {
    const WatchdogScope scope(card_, 10ms);
    begin_line();
  }
  EXPECT_NE(card_.parts().registers.read(reg::kWatchdog), 0U);
  engine_->sleep(1s);
  EXPECT_EQ(card_.read_faults(), kSilence);
}

// Periods and commands that are sent in time keep the watchdog alive, without a waiting call of the driver.
TEST_F(WatchdogOnModel, SendersOfPositionsKeepIt) {
  PositionStream stream(card_, {});
  constexpr std::uint64_t kPeriod = 20'000;  // clocks
  const std::uint64_t begun = engine_->cycles();
  for (unsigned i = 1; i <= 500; ++i) {
    stream.send({i * PositionStream::kPulse / 10}, kPeriod);
    engine_->wait(begun + i * kPeriod - engine_->cycles());
  }
  EXPECT_EQ(card_.read_faults(), 0U);
}

TEST_F(WatchdogOnModel, SendersOfCommandsKeepIt) {
  Stream stream(card_, {});
  for (int i = 0; i < 500; ++i) {
    stream.send({feed_of(1250), line_of(1250, 10)});
    engine_->sleep(200us);
  }
  EXPECT_EQ(card_.read_faults(), 0U);
}

// Another program can clear the faults that this one has left.
TEST_F(WatchdogOnModel, ClearedByAProgramThatSetsNone) {
  engine_->sleep(50ms);
  Card other = Card::open(*engine_);
  EXPECT_EQ(other.read_faults(), kSilence);
  other.clear_faults();
  engine_->sleep(1s);
  EXPECT_EQ(other.read_faults(), 0U);
}

}  // namespace
}  // namespace trammel::driver
