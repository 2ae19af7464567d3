#include "trammel/driver/card.hpp"

#include <gmock/gmock.h>

#include "trammel/card_map.hpp"
#include "trammel/driver/fake_card.hpp"
#include "trammel/driver/mock_bus.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using ::testing::_;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::InSequence;
using ::testing::Return;
using ::testing::StrictMock;
namespace reg = card_map::reg;
namespace field = card_map::field;

TEST(CardOpen, ReadsWhoTheCardIsInThisOrderAndWritesNothing) {
  StrictMock<MockBus> bus;
  InSequence in_order;
  EXPECT_CALL(bus, read(reg::kMagic)).WillOnce(Return(card_map::kMagicValue));
  EXPECT_CALL(bus, read(reg::kMapVersion)).WillOnce(Return(card_map::kMapVersionValue | 5U));
  EXPECT_CALL(bus, read(reg::kCommandsVersion)).WillOnce(Return(card_map::kCommandsVersionValue));
  EXPECT_CALL(bus, read(reg::kAxes)).WillOnce(Return(2U));
  EXPECT_CALL(bus, read(reg::kClockHz)).WillOnce(Return(100'000'000U));
  EXPECT_CALL(bus, read(reg::kEngines)).WillOnce(Return(0x33U));
  EXPECT_CALL(bus, read(reg::kGeometryDepth)).WillOnce(Return(4096U));
  EXPECT_CALL(bus, read(reg::kFeedDepth)).WillOnce(Return(2560U));
  EXPECT_CALL(bus, read(reg::step_length(0))).WillOnce(Return(0U));
  EXPECT_CALL(bus, read(reg::step_space(0))).WillOnce(Return(0U));
  EXPECT_CALL(bus, read(reg::step_length(1))).WillOnce(Return(200U));
  EXPECT_CALL(bus, read(reg::step_space(1))).WillOnce(Return(300U));
  const Card card = Card::open(bus);
  EXPECT_EQ(card.identification().map_major, card_map::kMapVersionValue >> 16);
  EXPECT_EQ(card.identification().map_minor, 5);
  EXPECT_EQ(card.identification().axes, 2U);
  EXPECT_EQ(card.identification().clock_hz, 100'000'000U);
  EXPECT_EQ(card.identification().engines, 0x33U);
  EXPECT_EQ(card.identification().geometry_depth, 4096U);
  EXPECT_EQ(card.identification().feed_depth, 2560U);
  EXPECT_EQ(card.timing().pulse_period[0], 7U);
  EXPECT_EQ(card.timing().pulse_period[1], 506U);
}

TEST(CardOpen, AsksNothingMoreOfWhatIsNotACard) {
  StrictMock<MockBus> bus;
  EXPECT_CALL(bus, read(reg::kMagic)).WillOnce(Return(0xFFFFFFFFU));
  EXPECT_THROW(Card::open(bus), IdentificationError);
}

struct Malformed {
  const char* name;
  std::uint32_t address;
  std::uint32_t value;
  const char* message;
};

class MalformedCard : public ::testing::TestWithParam<Malformed> {};

TEST_P(MalformedCard, IsRefusedWithTheReason) {
  FakeCardOptions options;
  options.constants[GetParam().address] = GetParam().value;
  FakeCard fake(options);
  try {
    Card::open(fake);
    FAIL() << "opened";
  } catch (const IdentificationError& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().message));
  }
}

INSTANTIATE_TEST_SUITE_P(
    CardOpen, MalformedCard,
    ::testing::Values(Malformed{"Magic", reg::kMagic, 0x4D4C5254, "0x4D4C5254"},
                      Malformed{"OlderMap", reg::kMapVersion, 0x00010000, "map version 1.0"},
                      Malformed{"NewerMap", reg::kMapVersion, 0x00030003, "map version 3.3"},
                      Malformed{"Commands", reg::kCommandsVersion, 1, "layouts of version 1"},
                      Malformed{"NoAxes", reg::kAxes, 0, "0 axes"}, Malformed{"NineAxes", reg::kAxes, 9, "9 axes"},
                      Malformed{"NoClock", reg::kClockHz, 0, "0 Hz"},
                      Malformed{"UnknownEngine", reg::kEngines, 0x801, "does not know 0x800"},
                      Malformed{"NoLines", reg::kEngines, 0x12, "without lines"},
                      Malformed{"ShortGeometry", reg::kGeometryDepth, 36, "geometry queue holds 36"},
                      Malformed{"ShortFeed", reg::kFeedDepth, 19, "feed queue holds 19"}),
    [](const auto& test) { return test.param.name; });

// A card whose bus from then on expects every access.
class CardTest : public ::testing::Test {
 protected:
  CardTest() : card_(open()) {}

  Card open() {
    EXPECT_CALL(bus_, read(_)).WillRepeatedly([this](std::uint32_t address) { return fake_.read(address); });
    const Card card = Card::open(bus_);
    ::testing::Mock::VerifyAndClearExpectations(&bus_);
    return card;
  }

  template <typename Call>
  std::string argument_error(Call call) {
    try {
      call();
    } catch (const ArgumentError& error) {
      return error.what();
    }
    return "";
  }

  FakeCard fake_;  // 1 MHz, 4 axes
  StrictMock<MockBus> bus_;
  Card card_;
};

TEST_F(CardTest, SettingsOfAnAxisAreOneBlockWithTimesRoundedUp) {
  AxisSettings settings;
  settings.step_length = 2500ns;
  settings.step_space = 3us;
  settings.direction_setup = 1ns;
  settings.direction_hold = 65535us;
  settings.mode = StepMode::kQuadrature;
  settings.invert_second = true;
  EXPECT_CALL(bus_, block(reg::step_length(2), ElementsAre(3U, 3U, 1U, 65535U, 2U | field::kModeInvertSecond),
                          Addressing::kIncrementing));
  card_.configure_axis(2, settings);
  EXPECT_EQ(card_.timing().pulse_period[2], 12U);
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
  EXPECT_THAT(argument_error([&] { card_.set_hold_limit(0ns); }), HasSubstr("hold limit"));
  EXPECT_THAT(argument_error([&] { card_.set_hold_limit(1s); }), HasSubstr("1000000 clocks"));
  EXPECT_THAT(argument_error([&] { card_.wait_until_idle(-1ns); }), HasSubstr("timeout"));
}

TEST_F(CardTest, TimeBase) {
  InSequence in_order;
  EXPECT_CALL(bus_, write(reg::kRatioFeed, 0x8000));
  card_.set_ratio(0x8000);
  EXPECT_CALL(bus_, write(reg::kSlew, (1U << 30) / 500'000));
  card_.set_slew_time(500ms);
  EXPECT_CALL(bus_, write(reg::kSlew, 0xFFFFFFF));
  card_.set_slew_time(0ns);
  EXPECT_CALL(bus_, write(reg::kHold, 1));
  card_.set_hold(true);
  EXPECT_CALL(bus_, write(reg::kHold, 0));
  card_.set_hold(false);
  EXPECT_CALL(bus_, write(reg::kHoldLimit, 2));
  card_.set_hold_limit(1001ns);
}

TEST_F(CardTest, ASnapshotIsStrobedAwaitedAndReadOnce) {
  InSequence in_order;
  EXPECT_CALL(bus_, write(reg::kControl, field::kControlSnapshot));
  EXPECT_CALL(bus_, read(reg::kStatus)).WillOnce(Return(field::kStatusSnapshot));
  EXPECT_CALL(bus_, wait(_));
  EXPECT_CALL(bus_, read(reg::kStatus)).WillOnce(Return(0));
  EXPECT_CALL(bus_, read(reg::kSnapTimeLo)).WillOnce(Return(0x89ABCDEFU));
  EXPECT_CALL(bus_, read(reg::kSnapTimeHi)).WillOnce(Return(0x01234567U));
  EXPECT_CALL(bus_, read(reg::kSnapStatus)).WillOnce(Return(field::kStatusBusy | field::kStatusHeld));
  EXPECT_CALL(bus_, read(reg::kSnapFault)).WillOnce(Return(0x400U));
  EXPECT_CALL(bus_, read(reg::kSnapRate)).WillOnce(Return(7U));
  EXPECT_CALL(bus_, read(reg::kSnapRatio)).WillOnce(Return(0x10000U));
  EXPECT_CALL(bus_, read(reg::kSnapGeometryBegun)).WillOnce(Return(0x80000001U));
  EXPECT_CALL(bus_, read(reg::kSnapFeedBegun)).WillOnce(Return(2U));
  EXPECT_CALL(bus_, read(reg::snap_position(0))).WillOnce(Return(0xFFFFFFFFU));
  EXPECT_CALL(bus_, read(reg::snap_position(1))).WillOnce(Return(0x7FFFFFFFU));
  EXPECT_CALL(bus_, read(reg::snap_position(2))).WillOnce(Return(0x80000000U));
  EXPECT_CALL(bus_, read(reg::snap_position(3))).WillOnce(Return(1U));
  const Snapshot snapshot = card_.snapshot();
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

TEST(CardOnFake, AFaultLatchesWhereTheCardStood) {
  FakeCard fake;
  Card card = Card::open(fake);
  fake.wait(1000);
  fake.raise_fault(0x2000);
  fake.wait(1000);
  fake.raise_fault(0x1000);
  const Snapshot stopped = card.stop_snapshot();
  EXPECT_EQ(stopped.faults, 0x2000U) << "the first cause";
  EXPECT_TRUE(stopped.status.faulted);
  EXPECT_GE(stopped.time, 1000U);
  EXPECT_LT(stopped.time, 2000U);
  EXPECT_EQ(card.faults(), 0x3000U);
}

TEST_F(CardTest, ASnapshotThatNeverComesTimesOut) {
  EXPECT_CALL(bus_, write(reg::kControl, field::kControlSnapshot));
  EXPECT_CALL(bus_, read(reg::kStatus)).WillRepeatedly(Return(field::kStatusSnapshot));
  EXPECT_CALL(bus_, wait(_)).Times(::testing::AtLeast(1));
  EXPECT_THROW(card_.snapshot(), TimeoutError);
}

TEST_F(CardTest, WaitingEndsWithTheMotionTheFaultOrTheTimeout) {
  InSequence in_order;
  EXPECT_CALL(bus_, read(reg::kStatus)).WillOnce(Return(field::kStatusBusy));
  EXPECT_CALL(bus_, wait(64));
  EXPECT_CALL(bus_, read(reg::kStatus)).WillOnce(Return(field::kStatusBusy));
  EXPECT_CALL(bus_, wait(36));
  EXPECT_CALL(bus_, read(reg::kStatus)).WillOnce(Return(field::kStatusBusy));
  EXPECT_THROW(card_.wait_until_idle(100us), TimeoutError);
  EXPECT_CALL(bus_, read(reg::kStatus)).WillOnce(Return(field::kStatusBusy | field::kStatusFaulted));
  EXPECT_CALL(bus_, read(reg::kFault)).WillOnce(Return(0x102U));
  try {
    card_.wait_until_idle(100us);
    FAIL();
  } catch (const FaultError& error) {
    EXPECT_EQ(error.faults(), 0x102U);
    EXPECT_THAT(error.what(), HasSubstr("step fault of axis 1, TICK_MISMATCH"));
  }
  EXPECT_CALL(bus_, read(reg::kStatus)).WillOnce(Return(0U));
  card_.wait_until_idle(100us);
}

TEST_F(CardTest, FaultsAndRefusalsAreReadAndClearedByTheirMasks) {
  InSequence in_order;
  EXPECT_CALL(bus_, read(reg::kRefusal)).WillOnce(Return(0U));
  EXPECT_FALSE(card_.refusal().has_value());
  EXPECT_CALL(bus_, read(reg::kRefusal)).WillOnce(Return(reg::kStream << 16 | 0x1706U));
  const auto refusal = card_.refusal();
  ASSERT_TRUE(refusal.has_value());
  EXPECT_EQ(refusal->reason, 6);
  EXPECT_EQ(refusal->command_number, 0x17);
  EXPECT_EQ(refusal->address, reg::kStream);
  EXPECT_CALL(bus_, write(reg::kRefusal, 0x0FFFFFFF));
  card_.clear_refusal();
  EXPECT_CALL(bus_, write(reg::kFault, 0xFFFF));
  card_.clear_faults();
  EXPECT_CALL(bus_, write(reg::kControl, field::kControlAbort));
  card_.abort();
}

TEST_F(CardTest, ALinkThatIsGoneKeepsTheFirstError) {
  EXPECT_CALL(bus_, write(reg::kHold, 1)).WillOnce([](auto address, auto) {
    throw BusError(address, Direction::kWrite, "no answer");
  });
  EXPECT_CALL(bus_, read(reg::kRefusal)).WillOnce([](auto address) -> std::uint32_t {
    throw BusError(address, Direction::kRead);
  });
  try {
    card_.set_hold(true);
    FAIL();
  } catch (const BusError& error) {
    EXPECT_EQ(error.address(), reg::kHold);
    EXPECT_THAT(error.what(), HasSubstr("HOLD (0x184) failed: no answer"));
  }
}

TEST(Errors, TextsNameWhatTheyAreOf) {
  EXPECT_EQ(describe_faults(0), "none");
  EXPECT_EQ(describe_faults(0x80000200), "PATH_INCOMPLETE, unknown bits 0x80000000");
  EXPECT_EQ(describe_faults(0xFC00), "MISSING_PERIOD, LIMIT, EMERGENCY_STOP, DRIVE_FAULT, WATCHDOG, LINK_LOSS");
  EXPECT_THAT(describe_reason(15), HasSubstr("FAULTED (15): "));
  EXPECT_THAT(describe_reason(5), HasSubstr("NO_ROOM (5): "));
  EXPECT_THAT(RefusedError(6, 17, reg::kStream, "stream").what(), HasSubstr("BAD_FIELD"));
  EXPECT_THAT(BusError(reg::step_space(3), Direction::kRead).what(), HasSubstr("STEP_SPACE[3] (0x264)"));
}

}  // namespace
}  // namespace trammel::driver
