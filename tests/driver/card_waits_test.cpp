// Calls of the card that wait: time-outs, interrupts, requests from other threads, and cards with older maps.
#include <gmock/gmock.h>

#include <chrono>
#include <deque>
#include <optional>
#include <string>
#include <thread>

#include "error_message.hpp"
#include "register_stub.hpp"
#include "stream_commands.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/interrupt.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/driver/watchdog_scope.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using test::RegisterStub;
using test::wrote;
using ::testing::HasSubstr;
namespace reg = card_map::reg;
namespace field = card_map::field;

class CardWaits : public ::testing::Test {
 protected:
  Card open(std::uint32_t map_minor = card_map::kMapVersionValue & 0xFFFF) {
    bus_.values[reg::kMapVersion] = 0x30000 | map_minor;
    Card card = Card::open(bus_);
    bus_.forget();
    return card;
  }
  // Each access takes at least kInterruptSlice, the time between two calls of an InterruptScope's check.
  void be_slow() {
    bus_.on_access = [](const Access&) {
      std::this_thread::sleep_for(kInterruptSlice);
      return true;
    };
  }

  RegisterStub bus_;
};

TEST_F(CardWaits, TheRestIsReadWhereThereIsOne) {
  Card older = open(3);
  EXPECT_EQ(argument_error([&] { older.read_rest(); }), "rest: the card's map 3.3 has no area REST; it came with 3.4");
  EXPECT_TRUE(bus_.log.empty());
  Card card = open(4);
  bus_.values[reg::kStatus] = field::kStatusStopping;
  EXPECT_EQ(message_of<StateError>([&] { card.read_rest(); }),
            "rest: the card is on its way to a stop: wait_until_stopped() first");
  bus_.values[reg::kStatus] = 0;
  bus_.values[reg::kRestTicksLeftLo] = 5;
  bus_.values[reg::kRestTicksLeftHi] = 2;
  EXPECT_EQ(card.read_rest().ticks_left, (std::uint64_t{2} << 32) + 5);
}

TEST_F(CardWaits, SafeOutputsAtTheCauseNeedTheirMap) {
  bus_.add_engines(card_map::engines::kPathCommands);
  Card older = open(4);
  EXPECT_EQ(argument_error([&] { older.set_output_safe_cause(1, 1); }),
            "safe outputs at the cause: the card's map is 3.4; they came with 3.5");
  EXPECT_TRUE(bus_.log.empty());
  open(5).set_output_safe_cause(1, 3);
  EXPECT_EQ(bus_.log.back(), wrote(reg::kOutputSafeCause, 0x30001));
}

TEST_F(CardWaits, AStopThatNeverComesToRestTimesOut) {
  Card card = open();
  bus_.values[reg::kSlew] = 1U << 20;  // a slew of 1,024 clocks
  bus_.values[reg::kStatus] = field::kStatusBusy;
  EXPECT_THAT(message_of<TimeoutError>([&] { card.stop(2ms); }), HasSubstr("stop on the path: not within"));
  EXPECT_GE(bus_.slept, 3ms);
  EXPECT_LE(bus_.slept, 4ms);
  EXPECT_EQ(bus_.values[reg::kHold], 1U) << "it goes on to rest, and holds";
}

TEST_F(CardWaits, AStopIsInterruptedWhereItHolds) {
  Card card = open();
  bus_.values[reg::kStatus] = field::kStatusBusy;
  be_slow();
  const InterruptScope interrupt([] { return true; });
  EXPECT_EQ(message_of<InterruptedError>([&] { card.stop(1s); }),
            "stop on the path: interrupted; the card goes on to rest, and holds");
  EXPECT_EQ(bus_.values[reg::kHold], 1U);
}

// The position at rest is exact once `settled` is set. A card without this bit counts as at rest once it is held.
TEST_F(CardWaits, AStopWaitsUntilTheCardIsSettled) {
  constexpr std::uint32_t kHeld = field::kStatusBusy | field::kStatusHeld;
  const auto pauses_of = [this](std::uint32_t map_minor) {
    Card card = open(map_minor);
    bus_.next[reg::kStatus] = {kHeld, kHeld, kHeld | field::kStatusSettled};
    card.stop();
    bus_.next.clear();
    return bus_.sleeps.size();
  };
  EXPECT_EQ(pauses_of(4), 2U);
  // The wait after the abort reads the second status.
  EXPECT_EQ(pauses_of(3), 1U);
}

TEST_F(CardWaits, WaitsForACaptureEndByAnInterrupt) {
  bus_.add_engines(card_map::engines::kPathCommands | card_map::engines::kMachineInputs | card_map::engines::kCaptures);
  Card card = open();
  be_slow();
  const InterruptScope interrupt([] { return true; });
  EXPECT_EQ(message_of<InterruptedError>([&] { card.wait_for_capture(0, 1h); }),
            "waiting for a capture: interrupted; the unit goes on watching");
}

TEST_F(CardWaits, ACardWithoutCapturesSaysSo) {
  Card card = open();
  EXPECT_EQ(card.captures_present(), 0U);
  EXPECT_EQ(argument_error([&] { card.read_captures(); }), "capture unit 0: the card has 0");
  EXPECT_TRUE(bus_.log.empty());
}

// The wait checks the identification when the card is idle.
TEST_F(CardWaits, ACardThatRefusesItsMagicIsGone) {
  Card card = open();
  bus_.on_access = [](const Access& access) { return access.address != reg::kMagic; };
  EXPECT_THAT(message_of<LinkError>([&] { card.wait_until_idle(1s); }), HasSubstr("it does not answer any more"));
}

// A class with a ratio of 0 is held and does not count. The slowest of the other classes stretches the time.
TEST_F(CardWaits, AClassThatStandsDoesNotCountForTheTime) {
  bus_.add_engines(card_map::engines::kClasses);
  bus_.values[reg::kRatioRapid] = bus_.values[reg::kRatioFixed] = Card::kFullRatio;
  Card card = open();
  card.set_ratio(PieceClass::kFeed, 0);
  card.set_ratio(PieceClass::kRapid, Card::kFullRatio / 4);
  card.set_ratio(PieceClass::kFixed, Card::kFullRatio / 2);
  bus_.values[reg::kStatus] = field::kStatusBusy;
  bus_.forget();
  EXPECT_THROW(card.wait_until_idle(10ms), TimeoutError);
  EXPECT_GE(bus_.slept, 40ms);
  EXPECT_LE(bus_.slept, 41ms);
}

TEST_F(CardWaits, AHoldOfThisProgramIsWaitedOut) {
  Card card = open();
  card.set_hold(true);
  bus_.next[reg::kStatus] = std::deque<std::uint32_t>(20, field::kStatusBusy | field::kStatusHeld);
  card.wait_until_idle(1ms);
  EXPECT_EQ(bus_.sleeps.size(), 20U) << "longer than the time that was allowed";
}

// Another program has set the hold after this program ended its own.
TEST_F(CardWaits, AHoldIsNotThisProgramsThatHasEndedItsOwn) {
  Card card = open();
  card.set_hold(true);
  EXPECT_EQ(message_of<HeldError>([&] { card.parts().time_base.throw_if_held("test"); }),
            "test: the card holds: set by this program: take it over, or end the hold");
  card.set_hold(false);
  bus_.values[reg::kHold] = 1;
  EXPECT_EQ(message_of<HeldError>([&] { card.parts().time_base.throw_if_held("test"); }),
            "test: the card holds: take it over, or end the hold");
}

TEST_F(CardWaits, AFourthClassHasNoRatio) {
  bus_.add_engines(card_map::engines::kClasses);
  Card card = open();
  EXPECT_EQ(argument_error([&] { card.set_ratio(static_cast<PieceClass>(3), 0); }), "time base: class 3");
  EXPECT_TRUE(bus_.log.empty());
}

// HOLD is set, but the time base is still slewing to 0.
TEST(CardTakeOver, OfACardThatIsComingToRest) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  card.set_slew_time(100ms);
  start_line(card, {1000}, 1s);
  engine->wait(300'000);
  engine->write(reg::kHold, 1);
  ASSERT_FALSE(card.read_status().held);
  const std::optional<Snapshot> rest = card.take_over();
  ASSERT_TRUE(rest);
  EXPECT_GT(rest->position[0], 330) << "50 ms of the ramp count";
  EXPECT_LT(rest->position[0], 370);
  EXPECT_EQ(engine->read(reg::kHold), 0U);
  engine->wait(1'000'000);
  EXPECT_EQ(engine->positions()[0], rest->position[0]);
}

TEST(CardRequests, AStopFromElsewhereEndsTheWait) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  card.set_slew_time(1ms);
  Stream stream(card, {});
  stream.send({feed_of(62'500), line_of(62'500, 1000), EndCommand{}});
  engine->wait(100'000);
  std::thread([&card] { card.request_stop(); }).join();
  try {
    stream.finish();
    FAIL() << "it has gone on";
  } catch (const StoppedError& error) {
    EXPECT_STREQ(error.what(), "card: stopped on the path, as another thread has asked for");
    EXPECT_EQ(error.geometry_begun(), 1U);
  }
  EXPECT_FALSE(card.busy());
  EXPECT_GT(engine->positions()[0], 90);
  EXPECT_LT(engine->positions()[0], 200);
  EXPECT_EQ(engine->read(reg::kHold), 0U);
}

TEST_F(CardWaits, ARatioThatTheCardCannotHaveIsLeftOut) {
  Card card = open();
  card.request_ratio(PieceClass::kRapid, 0x4000);  // this card has no classes
  card.request_ratio(PieceClass::kFeed, Card::kFullRatio + 1);
  serve_requests(card);
  EXPECT_TRUE(bus_.log.empty());
  card.request_ratio(PieceClass::kFeed, 0x4000);
  serve_requests(card);
  EXPECT_THAT(bus_.log, ::testing::ElementsAre(wrote(reg::kRatioFeed, 0x4000)));
}

// If the link fails, the watchdog of the card stays on. The destructor of the scope does not throw.
TEST_F(CardWaits, AWatchdogScopeEndsWithoutTheLinkToo) {
  Card card = open();
  {
    const WatchdogScope scope(card, 1s);
    bus_.on_access = [](const Access&) -> bool { throw LinkError("gone"); };
  }
  bus_.on_access = nullptr;
  EXPECT_NE(bus_.values[reg::kWatchdog], 0U);
}

TEST(InterruptScopes, OneWithinAnotherEndsAWaitAlone) {
  const InterruptScope outer([] { return false; });
  {
    const InterruptScope inner([] { return true; });
    std::this_thread::sleep_for(kInterruptSlice);
    EXPECT_TRUE(interrupted());
    EXPECT_TRUE(interrupted()) << "it stays so without another look";
  }
  EXPECT_FALSE(interrupted()) << "and ends with its scope";
}

}  // namespace
}  // namespace trammel::driver
