#include "trammel/driver/one_shot.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/fake_card.hpp"
#include "trammel/driver/mock_bus.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using ::testing::_;
using ::testing::HasSubstr;
using ::testing::InSequence;
using ::testing::Return;
using ::testing::StrictMock;
namespace reg = card_map::reg;

constexpr std::uint64_t kOne = std::uint64_t{1} << 40;

CardTiming timing(std::uint32_t clock_hz, std::uint32_t pulse_period = 2) {
  CardTiming result;
  result.clock_hz = clock_hz;
  result.axes = 4;
  result.pulse_period.fill(pulse_period);
  return result;
}

// x_N = floor(1/2 + N * FREQUENCY / 2^40): the pulses that a generator makes in the part.
std::uint64_t pulses_made(const OneShotPart& part, std::size_t axis) {
  const auto product = static_cast<int128>(part.length) * static_cast<int128>(part.frequency[axis]);
  return static_cast<std::uint64_t>((product + static_cast<int128>(kOne / 2)) / static_cast<int128>(kOne));
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

TEST(OneShot, LineOneOfThePaper) {
  // (0,0)-(20,40) with v = 5000 lines/s: v_x = 100,000 and v_y = 200,000 pulses/s by (5) and (6); p = (20, 40) by (7)
  // and (8). At 10 MHz that is 2000 clocks, and v_x / f = 2^-40 * 10995116277.76.
  const OneShotPlan plan = plan_line(timing(10'000'000), {20, 40}, 200us);
  ASSERT_EQ(plan.size(), 1U);
  const OneShotPart part = plan.part(0);
  EXPECT_EQ(part.length, 2000U);
  EXPECT_EQ(part.frequency[0], 10995116278U);
  EXPECT_EQ(part.frequency[1], 21990232556U);
  EXPECT_EQ(part.count[0], 20U);
  EXPECT_EQ(part.count[1], 40U);
  EXPECT_EQ(part.mask, 3);
  EXPECT_EQ(part.negative, 0);
  EXPECT_FALSE(plan.slowed());
}

TEST(OneShot, WordsAreTheRegistersInOrder) {
  const OneShotPart part = plan_line_clocks(timing(1'000'000), {0, -3, 0, 1}, kOne - 1).part(0);
  const auto words = part.words();
  ASSERT_EQ(words.size(), 35U);
  // From FREQUENCY_LO[7] at 0x300 on, so axis n is at word 4 (7 - n).
  EXPECT_EQ(words[28], 0U);
  EXPECT_EQ(words[24], 3U);  // FREQUENCY_LO[1] = round(3 * 2^40 / (2^40 - 1))
  EXPECT_EQ(words[25], 0U);
  EXPECT_EQ(words[26], 3U);  // COUNT[1]
  EXPECT_EQ(words[27], 1U);  // DIRECTION[1]
  EXPECT_EQ(words[16], 1U);
  EXPECT_EQ(words[18], 1U);
  EXPECT_EQ(words[19], 0U);
  EXPECT_EQ(words[32], 0xFFFFFFFFU);  // LENGTH
  EXPECT_EQ(words[33], 0xFFU);
  EXPECT_EQ(words[34], 0b1010U);  // START
}

TEST(OneShot, OnePulseAClockIsTheHighestFrequency) {
  const OneShotPart part = plan_line_clocks(timing(1'000'000, 1), {1000}, 1000).part(0);
  EXPECT_EQ(part.frequency[0], kOne);
  EXPECT_EQ(part.words()[29], 0x100U);
}

TEST(OneShot, ADurationIsRoundedUpToClocks) {
  EXPECT_EQ(plan_line(timing(3), {1}, 1s).clocks(), 3U);
  EXPECT_EQ(plan_line(timing(3), {1}, 1s + 1ns).clocks(), 4U);
}

TEST(OneShot, ASpeedAlongThePathIsExact) {
  // A 3-4-5 triangle: 5000 pulses of path at 1000 pulses/s are 5 s; a hair more than 1000 is a clock less.
  const auto card = timing(1'000'000);
  EXPECT_EQ(plan_line(card, {3000, 4000}, PathSpeed{1000, 1}).clocks(), 5'000'000U);
  EXPECT_EQ(plan_line(card, {3000, 4000}, PathSpeed{1'000'001, 1000}).clocks(), 4'999'996U);
  EXPECT_EQ(plan_line(card, {3000, 4000}, PathSpeed{1'000'000'001, 1'000'000}).clocks(), 5'000'000U);
  // sqrt(2) * 10^6: not a whole number of clocks, rounded up.
  EXPECT_EQ(plan_line(card, {1, 1}, PathSpeed{1}).clocks(), 1'414'214U);
}

TEST(OneShot, APathSpeedBeyond64BitsIsExact) {
  const CardTiming card = timing(4'000'000'000U, 1);
  EXPECT_THAT(argument_error([&] {
                plan_line(card, {std::int64_t{1} << 62}, PathSpeed{(1ULL << 62) - 1, 1000});
              }),
              HasSubstr("too fast"));
  // 2^40 pulses at 2^40 - 1 pulses in 1000 s: 3.6 clocks over 4 * 10^12, then up to whole clocks in each of the
  // 257 parts that 2^40 pulses need.
  const OneShotPlan plan = plan_line(card, {1LL << 40}, PathSpeed{(1ULL << 40) - 1, 1000});
  EXPECT_EQ(plan.size(), 257U);
  EXPECT_EQ(plan.clocks(), (4'000'000'000'004U + 256) / 257 * 257);
}

TEST(OneShot, AVelocityLimitRefusesOrSlowsByExactlyWhatIsNeeded) {
  const auto card = timing(1'000'000);
  LineLimits limits;
  limits.max_velocity = {0, 999};
  // 1000 pulses at 999 pulses/s and 1 MHz: 1,001,001.001 clocks.
  EXPECT_THAT(argument_error([&] { plan_line_clocks(card, {10, 1000}, 1'001'001, limits); }), HasSubstr("axis 1"));
  EXPECT_EQ(plan_line_clocks(card, {10, 1000}, 1'001'002, limits).clocks(), 1'001'002U);
  limits.policy = LimitPolicy::kSlow;
  const OneShotPlan slow = plan_line_clocks(card, {10, 1000}, 1'000'000, limits);
  EXPECT_EQ(slow.clocks(), 1'001'002U);
  EXPECT_TRUE(slow.slowed());
  EXPECT_FALSE(plan_line_clocks(card, {10, 1000}, 1'001'002, limits).slowed());
}

TEST(OneShot, TheCardsOwnPulsePeriodIsALimit) {
  const auto card = timing(1'000'000, 7);
  EXPECT_THAT(argument_error([&] { plan_line_clocks(card, {0, 0, 100}, 699); }), HasSubstr("7 clocks a pulse"));
  EXPECT_EQ(plan_line_clocks(card, {0, 0, 100}, 700).clocks(), 700U);
  LineLimits limits;
  limits.policy = LimitPolicy::kSlow;
  EXPECT_EQ(plan_line_clocks(card, {0, 0, 100}, 1, limits).clocks(), 700U);
}

TEST(OneShot, ALineTooLongIsSplitIntoEqualParts) {
  const OneShotPlan longer = plan_line_clocks(timing(1'000'000), {3, -1}, kOne);
  ASSERT_EQ(longer.size(), 2U);
  EXPECT_EQ(longer.part(0).length, kOne / 2);
  EXPECT_EQ(longer.part(1).length, kOne / 2);
  EXPECT_EQ(longer.part(0).count[0] + longer.part(1).count[0], 3U);
  EXPECT_EQ(longer.part(0).count[1] + longer.part(1).count[1], 1U);
  EXPECT_EQ(longer.part(0).mask, 3);
  EXPECT_EQ(longer.part(1).mask, 3);
  const OneShotPlan more = plan_line_clocks(timing(1'000'000, 1), {(std::int64_t{1} << 32) * 2 + 1}, 1ULL << 34);
  EXPECT_EQ(more.size(), 3U);
}

TEST(OneShot, EveryArgumentErrorComesBeforeTheBus) {
  const auto card = timing(1'000'000);
  EXPECT_THAT(argument_error([&] { plan_line(card, {}, 1s); }), HasSubstr("no axis moves"));
  EXPECT_THAT(argument_error([&] { plan_line(card, {1}, 0ns); }), HasSubstr("0 ns"));
  EXPECT_THAT(argument_error([&] { plan_line(card, {1}, -1ns); }), HasSubstr("-1 ns"));
  EXPECT_THAT(argument_error([&] { plan_line_clocks(card, {1}, 0); }), HasSubstr("0 clocks"));
  EXPECT_THAT(argument_error([&] { plan_line(card, {0, 0, 0, 0, 1}, 1s); }), HasSubstr("axis 4"));
  EXPECT_THAT(argument_error([&] { plan_line(card, {std::numeric_limits<std::int64_t>::min()}, 1s); }),
              HasSubstr("2^62"));
  EXPECT_THAT(argument_error([&] { plan_line(card, {1}, PathSpeed{0, 1}); }), HasSubstr("speed of 0"));
  EXPECT_THAT(argument_error([&] { plan_line(card, {1}, PathSpeed{1, 0}); }), HasSubstr("in 0 s"));
  EXPECT_THAT(argument_error([&] { plan_line_clocks(card, {1}, 1ULL << 62); }), HasSubstr("2^62 clocks"));
}

// Opens a card on a mock without saying in which order.
Card open_quietly(StrictMock<MockBus>& bus, unsigned axes = 4) {
  FakeCardOptions options;
  options.axes = axes;
  FakeCard fake(options);
  EXPECT_CALL(bus, read(_)).WillRepeatedly([&fake](std::uint32_t address) { return fake.read(address); });
  Card card = Card::open(bus);
  ::testing::Mock::VerifyAndClearExpectations(&bus);
  return card;
}

TEST(OneShot, StartIsOneBlockWriteAndNothingElse) {
  for (unsigned axes = 1; axes <= 8; ++axes) {
    StrictMock<MockBus> bus;
    Card card = open_quietly(bus, axes);
    Displacement line{5};
    line[axes - 1] = -2;
    const auto words = plan_line(card.timing(), line, 1ms).part(0).words();
    const std::ptrdiff_t used = 4 * std::ptrdiff_t{axes} + 3;
    EXPECT_CALL(bus, block(0x380 - 0x10 * axes, std::vector<std::uint32_t>(words.end() - used, words.end()),
                           Addressing::kIncrementing));
    start_line(card, line, 1ms);
  }
}

TEST(OneShot, ACardWithoutDirectModeIsToldSo) {
  FakeCardOptions options;
  options.engines = 0x13;
  FakeCard fake(options);
  Card card = Card::open(fake);
  const std::uint64_t accesses = fake.accesses();
  EXPECT_THAT(argument_error([&] { start_line(card, {5}, 1ms); }), HasSubstr("no direct mode"));
  EXPECT_THAT(argument_error([&] { start_line(card, {5}, PathSpeed{10}); }), HasSubstr("no direct mode"));
  EXPECT_THAT(argument_error([&] { run_line(card, plan_line(card.timing(), {5}, 1ms)); }), HasSubstr("no direct mode"));
  EXPECT_EQ(fake.accesses(), accesses);
}

TEST(OneShot, AFaultedCardRefusesTheStartAndSaysWhy) {
  FakeCard fake;
  Card card = Card::open(fake);
  fake.raise_fault(1);
  try {
    start_line(card, {5}, 1ms);
    FAIL();
  } catch (const RefusedError& error) {
    EXPECT_EQ(error.reason(), static_cast<std::uint8_t>(card_map::Reason::Faulted));
  }
  card.clear_refusal();
  card.clear_faults();
  start_line(card, {5}, 1ms);
  card.wait_until_idle(10ms);
  EXPECT_EQ(fake.position(0), 5);
}

TEST(OneShot, ALineThatIsRefusedOrTooLongTouchesNothing) {
  StrictMock<MockBus> bus;
  Card card = open_quietly(bus);
  EXPECT_THROW(start_line(card, {1'000'000}, 1ms), ArgumentError);
  EXPECT_THAT(argument_error([&] { start_line(card, {1}, std::chrono::hours(2000)); }), HasSubstr("run_line"));
}

TEST(OneShot, ABusyCardRefusesTheStartAndSaysWhy) {
  StrictMock<MockBus> bus;
  Card card = open_quietly(bus);
  InSequence in_order;
  EXPECT_CALL(bus, block(_, _, _)).WillOnce([](auto, auto, auto) { throw BusError(reg::kStart, Direction::kWrite); });
  EXPECT_CALL(bus, read(reg::kRefusal)).WillOnce(Return(reg::kStart << 16 | 8U));
  try {
    start_line(card, {5}, 1ms);
    FAIL();
  } catch (const RefusedError& error) {
    EXPECT_EQ(error.reason(), static_cast<std::uint8_t>(card_map::Reason::Busy));
    EXPECT_EQ(error.address(), reg::kStart);
  }
}

TEST(OneShot, AnEarlierRefusalIsNotTakenForThisOne) {
  StrictMock<MockBus> bus;
  Card card = open_quietly(bus);
  EXPECT_CALL(bus, block(_, _, _)).WillOnce([](auto, auto, auto) { throw BusError(reg::kStart, Direction::kWrite); });
  EXPECT_CALL(bus, read(reg::kRefusal)).WillOnce(Return(reg::kMagic << 16 | 9U));
  EXPECT_THROW(start_line(card, {5}, 1ms), BusError);
}

TEST(OneShot, RunsOnTheFakeAndIsFreeUntilTheEnd) {
  FakeCard fake;
  Card card = Card::open(fake);
  start_line(card, {40, -100}, 1ms);
  EXPECT_TRUE(card.busy());
  EXPECT_THROW(start_line(card, {1}, 1ms), RefusedError);
  card.clear_refusal();
  card.wait_until_idle(10ms);
  const Snapshot snapshot = card.snapshot();
  EXPECT_EQ(snapshot.position[0], 40);
  EXPECT_EQ(snapshot.position[1], -100);
}

TEST(OneShot, RunsAllPartsOfALongLine) {
  FakeCardOptions options;
  options.clock_hz = 100'000'000;
  FakeCard fake(options);
  Card card = Card::open(fake);
  const OneShotPlan plan = plan_line(card.timing(), {1'000'003, -7}, std::chrono::hours(10));
  EXPECT_EQ(plan.size(), 4U);
  run_line(card, plan);
  EXPECT_EQ(fake.position(0), 1'000'003);
  EXPECT_EQ(fake.position(1), -7);
  EXPECT_GE(fake.time(), plan.clocks());
}

TEST(OneShot, AHeldLineTimesOut) {
  FakeCard fake;
  Card card = Card::open(fake);
  card.set_hold(true);
  EXPECT_THROW(run_line(card, plan_line(card.timing(), {10}, 1ms), 5ms), TimeoutError);
  card.set_hold(false);
  card.wait_until_idle(10ms);
  EXPECT_EQ(fake.position(0), 10);
}

RC_GTEST_PROP(OneShotProperty, EveryPartMakesItsPulsesAndTheyAddUp, ()) {
  Displacement displacement{};
  const int bits = *rc::gen::inRange(1, 44);
  for (std::size_t axis = 0; axis < 4; ++axis) {
    const auto limit = std::int64_t{1} << bits;
    displacement[axis] = *rc::gen::inRange<std::int64_t>(-limit, limit + 1);
  }
  RC_PRE(displacement != Displacement{});
  LineLimits limits;
  limits.policy = LimitPolicy::kSlow;
  const auto clocks = *rc::gen::inRange<std::uint64_t>(1, std::uint64_t{1} << *rc::gen::inRange(1, 46));
  const OneShotPlan plan = plan_line_clocks(timing(50'000'000), displacement, clocks, limits);
  RC_ASSERT(plan.clocks() >= clocks);
  Displacement sum{};
  for (std::size_t index = 0; index < plan.size(); ++index) {
    const OneShotPart part = plan.part(index);
    RC_ASSERT(part.length > 0U);
    RC_ASSERT(part.length < kOne);
    RC_ASSERT(part.mask != 0);
    for (std::size_t axis = 0; axis < card_map::kMaxAxes; ++axis) {
      RC_ASSERT(part.frequency[axis] <= kOne);
      RC_ASSERT(pulses_made(part, axis) == part.count[axis]);
      sum[axis] += (part.negative >> axis & 1U) != 0 ? -std::int64_t{part.count[axis]} : part.count[axis];
    }
  }
  RC_ASSERT(sum == displacement);
}

RC_GTEST_PROP(OneShotProperty, TheFrequencyIsTheNearestAndLandsExactly, ()) {
  const auto clocks = *rc::gen::inRange<std::uint64_t>(1, kOne);
  const auto pulses = *rc::gen::inRange<std::uint64_t>(0, std::min<std::uint64_t>(clocks, 0xFFFFFFFF) + 1);
  const std::uint64_t frequency = one_shot_frequency(pulses, clocks);
  const int128 error = static_cast<int128>(frequency) * static_cast<int128>(clocks) -
                       static_cast<int128>(pulses) * static_cast<int128>(kOne);
  RC_ASSERT(2 * error <= static_cast<int128>(clocks));
  RC_ASSERT(-2 * error <= static_cast<int128>(clocks));
  OneShotPart part;
  part.length = clocks;
  part.frequency[0] = frequency;
  RC_ASSERT(pulses_made(part, 0) == pulses);
}

RC_GTEST_PROP(OneShotProperty, ASlowedLineIsTheShortestThatKeepsTheLimits, ()) {
  const auto pulses = *rc::gen::inRange<std::int64_t>(1, 1'000'000);
  const auto velocity = *rc::gen::inRange<std::uint64_t>(1, 1'000'000);
  const auto clock_hz = *rc::gen::inRange<std::uint32_t>(1'000'000, 200'000'000);
  LineLimits limits;
  limits.max_velocity[0] = velocity;
  limits.policy = LimitPolicy::kSlow;
  const std::uint64_t clocks = plan_line_clocks(timing(clock_hz), {pulses}, 1, limits).clocks();
  RC_PRE(clocks < kOne);
  limits.policy = LimitPolicy::kRefuse;
  RC_ASSERT(plan_line_clocks(timing(clock_hz), {pulses}, clocks, limits).clocks() == clocks);
  RC_ASSERT_THROWS_AS(plan_line_clocks(timing(clock_hz), {pulses}, clocks - 1, limits), ArgumentError);
}

}  // namespace
}  // namespace trammel::driver
