#include "trammel/driver/card.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <thread>

#include "error_message.hpp"
#include "register_stub.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using test::RegisterStub;
using test::was_read;
using test::wrote;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace reg = card_map::reg;
namespace field = card_map::field;

// A card on a stub, whose log does not contain the opening.
class CardTest : public ::testing::Test {
 protected:
  CardTest() : card_(Card::open(bus_)) { bus_.forget(); }

  RegisterStub bus_;  // 1 MHz, 4 axes
  Card card_;
};

TEST_F(CardTest, SettingsOfAnAxisAreOneTransferWithTimesRoundedUp) {
  AxisSettings settings;
  settings.step_length = 2500ns;
  settings.step_space = 3us;
  settings.direction_setup = 1ns;
  settings.direction_hold = 65535us;
  settings.mode = StepMode::kQuadrature;
  settings.invert_second = true;
  card_.configure_axis(2, settings);
  EXPECT_THAT(bus_.log,
              ElementsAre(wrote(reg::step_length(2), 3), wrote(reg::step_space(2), 3), wrote(reg::dir_setup(2), 1),
                          wrote(reg::dir_hold(2), 65535), wrote(reg::mode(2), 2U | field::kModeInvertSecond)));
  EXPECT_THAT(bus_.transfers, ElementsAre(5U));
  EXPECT_EQ(card_.timing().pulse_period[2], 12U);
  settings.invert_first = true;
  settings.invert_second = false;
  card_.configure_axis(2, settings);
  EXPECT_EQ(bus_.log.back(), wrote(reg::mode(2), 2U | field::kModeInvertFirst));
}

TEST_F(CardTest, BadArgumentsNeverReachTheBus) {
  AxisSettings settings;
  EXPECT_THAT(argument_error([&] { card_.configure_axis(4, settings); }), HasSubstr("axis 4"));
  settings.step_length = 65536us;
  EXPECT_THAT(argument_error([&] { card_.configure_axis(0, settings); }), HasSubstr("65536000 ns, 65536 clocks"));
  settings.step_length = -1ns;
  EXPECT_THAT(argument_error([&] { card_.configure_axis(0, settings); }), HasSubstr("-1 ns"));
  settings.step_length = 0ns;
  settings.mode = static_cast<StepMode>(3);
  EXPECT_THAT(argument_error([&] { card_.configure_axis(0, settings); }), HasSubstr("mode 3"));
  EXPECT_THAT(argument_error([&] { card_.set_ratio(Card::kFullRatio + 1); }), HasSubstr("65537"));
  EXPECT_THAT(argument_error([&] { card_.set_slew_time(2000s); }), HasSubstr("slew"));
  EXPECT_THAT(argument_error([&] { card_.set_slew_time(-1s); }), HasSubstr("negative"));
  EXPECT_THAT(argument_error([&] { card_.set_longest_step_wait(0ns); }), HasSubstr("longest step wait"));
  EXPECT_THAT(argument_error([&] { card_.set_longest_step_wait(1s); }), HasSubstr("1000000 clocks"));
  EXPECT_THAT(argument_error([&] { card_.wait_until_idle(-1ns); }), HasSubstr("timeout"));
  EXPECT_TRUE(bus_.log.empty());
}

TEST_F(CardTest, EachClassHasItsRatio) {
  EXPECT_THAT(argument_error([&] { card_.set_ratio(PieceClass::kRapid, 1); }), HasSubstr("needs classes"));
  EXPECT_TRUE(bus_.log.empty());
  bus_.add_engines(card_map::engines::kClasses);
  Card card = Card::open(bus_);
  bus_.forget();
  card.set_ratio(PieceClass::kFixed, 0xF000);
  card.set_override(PieceClass::kFeed, 37);
  card.set_override(PieceClass::kRapid, 50, 200);
  EXPECT_THAT(bus_.log, ElementsAre(wrote(reg::kRatioFixed, 0xF000), wrote(reg::kRatioFeed, 24248),
                                    wrote(reg::kRatioRapid, 0x4000)));
  EXPECT_EQ(card.ratio(), 24248U) << "37 % of 65,536, rounded";
  EXPECT_EQ(card.ratio(PieceClass::kRapid), 0x4000U);
  EXPECT_EQ(card.ratio(PieceClass::kFixed), 0xF000U);
  EXPECT_THAT(argument_error([&] { card.set_ratio(PieceClass::kRapid, 0x10001); }), HasSubstr("65537"));
  for (const double percent : {-0.1, 200.1, std::nan("")})
    EXPECT_THAT(argument_error([&] { card.set_override(PieceClass::kFeed, percent, 200); }), HasSubstr("0 to 200 %"));
  EXPECT_THAT(argument_error([&] { Card::ratio_of(1, 0); }), HasSubstr("override"));
}

// Each step of 0.5 % from 0 to the largest override has a different ratio.
TEST(Override, IsFineEnough) {
  std::uint32_t before = 0;
  for (int half = 1; half <= 400; ++half) {
    const std::uint32_t ratio = Card::ratio_of(half * 0.5, 200);
    EXPECT_NEAR(ratio, half * 65536.0 / 400, 0.5);
    EXPECT_GT(ratio, before);
    before = ratio;
  }
  EXPECT_EQ(before, Card::kFullRatio);
}

TEST_F(CardTest, TimeBase) {
  card_.set_ratio(0x8000);
  card_.set_slew_time(500ms);
  card_.set_slew_time(0ns);
  card_.set_hold(true);
  card_.set_hold(false);
  card_.set_longest_step_wait(1001ns);
  EXPECT_THAT(bus_.log, ElementsAre(wrote(reg::kRatioFeed, 0x8000), wrote(reg::kSlew, (1U << 30) / 500'000),
                                    wrote(reg::kSlew, 0xFFFFFFF), wrote(reg::kHold, 1), wrote(reg::kHold, 0),
                                    wrote(reg::kHoldLimit, 2)));
}

TEST_F(CardTest, ASnapshotIsStrobedAwaitedAndReadInOneTransfer) {
  bus_.next[reg::kStatus] = {field::kStatusSnapshot, 0};
  bus_.values[reg::kSnapTimeLo] = 0x89ABCDEF;
  bus_.values[reg::kSnapTimeHi] = 0x01234567;
  bus_.values[reg::kSnapStatus] = field::kStatusBusy | field::kStatusHeld;
  bus_.values[reg::kSnapFault] = 0x400;
  bus_.values[reg::kSnapRate] = 7;
  bus_.values[reg::kSnapRatio] = 0x10000;
  bus_.values[reg::kSnapGeometryBegun] = 0x80000001;
  bus_.values[reg::kSnapFeedBegun] = 2;
  bus_.values[reg::snap_position(0)] = 0xFFFFFFFF;
  bus_.values[reg::snap_position(1)] = 0x7FFFFFFF;
  bus_.values[reg::snap_position(2)] = 0x80000000;
  bus_.values[reg::snap_position(3)] = 1;
  const Snapshot snapshot = card_.read_snapshot();
  EXPECT_EQ(bus_.log.front(), wrote(reg::kControl, field::kControlSnapshot));
  EXPECT_THAT(bus_.transfers, ElementsAre(1U, 1U, 1U, 12U));
  EXPECT_EQ(bus_.sleeps.size(), 1U);
  EXPECT_EQ(snapshot.time, 0x0123456789ABCDEFU);
  EXPECT_TRUE(snapshot.status.busy);
  EXPECT_TRUE(snapshot.status.held);
  EXPECT_FALSE(snapshot.status.snapshot);
  EXPECT_EQ(snapshot.rate, 7U);
  EXPECT_EQ(snapshot.ratio, 0x10000U);
  EXPECT_EQ(snapshot.faults, 0x400U);
  EXPECT_EQ(snapshot.geometry_begun, 0x80000001U);
  EXPECT_EQ(snapshot.feed_begun, 2U);
  EXPECT_THAT(snapshot.position, ElementsAre(-1, 0x7FFFFFFF, std::numeric_limits<std::int32_t>::min(), 1, 0, 0, 0, 0));
}

TEST_F(CardTest, ASnapshotThatNeverComesTimesOut) {
  bus_.values[reg::kStatus] = field::kStatusSnapshot;
  EXPECT_THROW(card_.read_snapshot(), TimeoutError);
  EXPECT_GT(bus_.slept, 0ns);
}

TEST_F(CardTest, WaitingEndsWithTheMotionTheFaultOrTheTimeout) {
  bus_.values[reg::kSlew] = 0xFFFFFFF;  // a slew of 8 clocks
  bus_.values[reg::kStatus] = field::kStatusBusy;
  EXPECT_THROW(card_.wait_until_idle(100us), TimeoutError);
  EXPECT_THAT(bus_.sleeps, ElementsAre(64us, 36us, 8us)) << "and two slews, down and up";
  bus_.values[reg::kStatus] = field::kStatusBusy | field::kStatusFaulted;
  bus_.values[reg::kFault] = 0x102;
  try {
    card_.wait_until_idle(100us);
    FAIL();
  } catch (const FaultError& error) {
    EXPECT_EQ(error.faults(), 0x102U);
    EXPECT_THAT(error.what(), HasSubstr("step fault of axis 1, TICK_MISMATCH"));
  }
  bus_.values[reg::kFault] = field::kFaultLimit | field::kFaultDriveFault;
  bus_.values[reg::kLimitState] = 0x01'04'00;
  try {
    card_.wait_until_idle(100us);
    FAIL();
  } catch (const FaultError& error) {
    EXPECT_EQ(error.limit_state(), 0x01'04'00U);
    EXPECT_THAT(error.what(), HasSubstr("LIMIT (axis 2 plus), DRIVE_FAULT (axis 0)"));
  }
  bus_.values[reg::kStatus] = 0;
  card_.wait_until_idle(100us);
}

TEST_F(CardTest, AHoldStopsTheTimeOutAndARatioStretchesIt) {
  bus_.next[reg::kStatus] = std::deque<std::uint32_t>(50, field::kStatusBusy | field::kStatusHeld);
  bus_.values[reg::kStatus] = field::kStatusBusy;
  card_.set_ratio(Card::kFullRatio / 4);
  EXPECT_THROW(card_.wait_until_idle(1ms), TimeoutError);
  EXPECT_GE(bus_.slept, 50 * 64us + 4ms);
  EXPECT_LE(bus_.slept, 50 * 64us + 4ms + 100us);
  bus_.forget();
  bus_.values[reg::kRatioFeed] = Card::kFullRatio / 8;  // set by another program: noticed when the time has passed
  EXPECT_THROW(card_.wait_until_idle(1ms), TimeoutError);
  EXPECT_GE(bus_.slept, 8ms);
  EXPECT_LE(bus_.slept, 12ms + 100us);
}

TEST_F(CardTest, FaultsAndRefusalsAreReadAndClearedByTheirMasks) {
  EXPECT_FALSE(card_.refusal().has_value());
  bus_.values[reg::kRefusal] = reg::kStream << 16 | 0x1706U;
  const auto refusal = card_.refusal();
  ASSERT_TRUE(refusal.has_value());
  EXPECT_EQ(refusal->reason, 6);
  EXPECT_EQ(refusal->command_number, 0x17);
  EXPECT_EQ(refusal->address, reg::kStream);
  bus_.forget();
  card_.clear_refusal();
  card_.clear_faults();
  card_.abort();
  EXPECT_THAT(bus_.log, ElementsAre(wrote(reg::kRefusal, 0x0FFFFFFF), was_read(reg::kStatus), wrote(reg::kWatchdog, 0),
                                    wrote(reg::kLinkTimeout, 0), wrote(reg::kFault, 0x7FFFF),
                                    wrote(reg::kControl, field::kControlAbort)));
}

// On a posted bus every write is followed by a read of REFUSAL in the same transfer.
TEST_F(CardTest, PostedWritesAreConfirmed) {
  bus_.posted = true;
  card_.set_ratio(0x8000);
  EXPECT_THAT(bus_.log, ElementsAre(was_read(reg::kRefusal), wrote(reg::kRatioFeed, 0x8000), was_read(reg::kRefusal)));
  EXPECT_THAT(bus_.transfers, ElementsAre(1U, 2U));
}

TEST_F(CardTest, ARefusedSettingIsReportedOnEitherBusAndClearedForTheNext) {
  bus_.on_access = [this](const Access& access) {
    if (!access.write || access.address != reg::step_space(1)) return true;
    bus_.values[reg::kRefusal] = reg::step_space(1) << 16 | static_cast<unsigned>(card_map::Reason::BadValue);
    return false;
  };
  for (const bool posted : {false, true}) {
    bus_.posted = posted;
    try {
      card_.configure_axis(1, {});
      FAIL();
    } catch (const RefusedError& error) {
      EXPECT_EQ(error.reason(), static_cast<std::uint8_t>(card_map::Reason::BadValue));
      EXPECT_EQ(error.address(), reg::step_space(1));
      EXPECT_THAT(error.what(), HasSubstr("axis 1: settings"));
    }
    EXPECT_EQ(bus_.values[reg::kRefusal], 0U);
    card_.configure_axis(2, {});
  }
}

TEST(CardOnModel, AFaultLatchesWhereTheCardStood) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  AxisSettings slow;
  slow.step_length = 50us;
  card.configure_axis(0, slow);
  card.set_longest_step_wait(10us);
  // One step every 10 clocks: the card's limit is known, but this plan ignores it.
  CardTiming deceived = card.timing();
  deceived.pulse_period.fill(1);
  start_line(card, plan_line_clocks(deceived, {100}, 1000).part(0));
  EXPECT_THROW(card.wait_until_idle(10ms), FaultError);
  const Snapshot stopped = card.read_stop_snapshot();
  EXPECT_EQ(stopped.faults, 1U);
  EXPECT_TRUE(stopped.status.faulted);
  EXPECT_GT(stopped.time, 0U);
  EXPECT_LT(stopped.time, engine->cycles());
  EXPECT_EQ(card.read_faults(), 1U);
}

TEST_F(CardTest, ALinkThatIsGoneKeepsTheTransportsMessage) {
  bus_.on_access = [](const Access&) -> bool { throw LinkError("serial: cable unplugged"); };
  try {
    card_.set_hold(true);
    FAIL();
  } catch (const LinkError& error) {
    EXPECT_STREQ(error.what(), "serial: cable unplugged");
  }
  bus_.on_access = nullptr;
  card_.set_hold(true);
}

// A bus without a card reads as all ones. Zeros look like an idle card.
TEST_F(CardTest, NonsenseIsALinkError) {
  bus_.values[reg::kStatus] = 0xFFFFFFFF;
  EXPECT_THROW(card_.read_status(), LinkError);
  EXPECT_THROW(card_.wait_until_idle(1s), LinkError);
  bus_.values.clear();
  EXPECT_THROW(card_.wait_until_idle(1s), LinkError);
  bus_.values[reg::kRefusal] = 0xFFFFFFFF;
  EXPECT_THROW(card_.refusal(), LinkError);
}

TEST_F(CardTest, ATransportThatMiscountsIsALinkError) {
  class Miscounting final : public Bus {
   public:
    explicit Miscounting(Bus& bus) : bus_(bus) {}
    std::size_t transfer(Access* accesses, std::size_t count) override { return bus_.transfer(accesses, count) + more; }
    void sleep(std::chrono::nanoseconds) override {}
    bool reports_refusals() const override { return reports; }
    std::size_t more = 0;
    bool reports = true;

   private:
    Bus& bus_;
  };
  Miscounting bus(bus_);
  Card card = Card::open(bus);
  bus.more = 1;
  EXPECT_THROW(card.read_status(), LinkError);
  bus.more = std::size_t{0} - 1;
  bus.reports = false;
  EXPECT_THROW(card.read_status(), LinkError) << "a posted bus makes all accesses";
}

TEST_F(CardTest, ACardWithOtherStepTimesThanItWasGivenIsFound) {
  AxisSettings settings;
  settings.step_length = 5us;
  card_.configure_axis(1, settings);
  card_.wait_until_idle(1s);
  bus_.values[reg::step_length(1)] = 0;
  EXPECT_THROW(card_.wait_until_idle(1s), StateError);
}

TEST(CardOnModel, AnotherThreadsRequestsAreServedByTheCallThatWaits) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  start_line(card, {1000}, std::chrono::hours(1));
  card.request_hold(true);
  std::thread other([&card] {
    std::this_thread::sleep_for(20ms);
    card.request_abort();
  });
  EXPECT_THROW(card.wait_until_idle(std::chrono::hours(2)), StateError);
  other.join();
  EXPECT_TRUE(card.read_status().held) << "served before the abort";
  engine->wait(100);
  EXPECT_FALSE(card.busy());
  EXPECT_LT(engine->positions()[0], 10);
}

// An interrupt line that stays raised for another reason must not make the wait spin, and must not stop its time-out.
TEST(CardInterrupts, ARaisedLineTakesTurnsWithSleeping) {
  class Raised final : public RegisterStub {
   public:
    bool has_interrupt() const override { return true; }
    bool wait_for_interrupt(std::chrono::nanoseconds) override {
      ++waits;
      return true;
    }
    std::size_t waits = 0;
  };
  Raised bus;
  Card card = Card::open(bus);
  bus.forget();
  bus.next[reg::kStatus] = std::deque<std::uint32_t>(6, field::kStatusBusy);
  card.wait_until_idle(1s);
  EXPECT_EQ(bus.waits, 3U);
  EXPECT_EQ(bus.sleeps.size(), 3U);
  EXPECT_EQ(bus.values[reg::kIrqEnable], field::kStatusBusy | field::kStatusFaulted | field::kStatusRefused);
  bus.values[reg::kStatus] = field::kStatusBusy;
  EXPECT_THROW(card.wait_until_idle(1s), TimeoutError);
}

TEST(CardOnModel, AnInterruptEndsAWait) {
  sim::EngineOptions options;
  options.interrupt = true;
  const auto engine = sim::make_model_engine(options);
  Card card = Card::open(*engine);
  start_line(card, {10}, 7ms);
  const std::uint64_t begun = engine->cycles();
  card.wait_until_idle(1s);
  EXPECT_EQ(engine->positions()[0], 10);
  EXPECT_LT(engine->cycles() - begun, 7000 + 500) << "a look every 10 ms would be later";
}

TEST(Errors, TextsNameWhatTheyAreOf) {
  EXPECT_EQ(describe_faults(0), "none");
  EXPECT_EQ(describe_faults(0x80000200), "PATH_INCOMPLETE, unknown bits 0x80000000");
  EXPECT_EQ(describe_faults(0xFC00),
            "MISSING_PERIOD, LIMIT, EMERGENCY_STOP, DRIVE_FAULT, WATCHDOG (the program that moved the card was silent "
            "for too long), LINK_LOSS (no access of the program that moved the card came in time)");
  EXPECT_EQ(describe_faults(0x70000), "SOFT_LIMIT, PROBE, TOOL_SETTER");
  EXPECT_EQ(describe_faults(0x10000, 0), "SOFT_LIMIT (axis 0 minus)");
  EXPECT_EQ(describe_faults(0x10000, 0xA000000), "SOFT_LIMIT (axis 2 plus)");
  EXPECT_EQ(describe_faults(0x2800, 0x028104), "LIMIT (axis 2 minus, axis 0 plus, axis 7 plus), DRIVE_FAULT (axis 1)");
  EXPECT_EQ(describe_faults(0x2000, 0x04), "DRIVE_FAULT");
  const std::vector<std::string> names{"X", "Y", "Z"};
  EXPECT_EQ(describe_faults(0x2800, 0x028104, names), "LIMIT (Z minus, X plus, axis 7 plus), DRIVE_FAULT (Y)");
  EXPECT_EQ(describe_faults(0x1000A, 0xA000000, names), "step fault of Y, step fault of axis 3, SOFT_LIMIT (Z plus)");
  EXPECT_THAT(FaultError(0x800, "line", 0x100).what(),
              HasSubstr("line: the card has stopped with a fault: LIMIT (axis 0 plus)"));
  EXPECT_THAT(describe_reason(15), HasSubstr("FAULTED (15): "));
  EXPECT_THAT(describe_reason(5), HasSubstr("NO_ROOM (5): "));
  EXPECT_THAT(RefusedError(6, 17, reg::kStream, "stream").what(), HasSubstr("BAD_FIELD"));
  EXPECT_THAT(RefusedError(8, 0, reg::step_space(3), "axis 3").what(), HasSubstr("STEP_SPACE[3] (0x984)"));
  EXPECT_THAT(RefusedError(0, 0, reg::kStart, "line").what(), HasSubstr("it did not say why"));
  EXPECT_THAT(RefusedError(10, 0, 0xFFC, "read").what(), HasSubstr("Access to address 0xFFC"));
}

}  // namespace
}  // namespace trammel::driver
