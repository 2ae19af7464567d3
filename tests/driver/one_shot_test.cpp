#include "trammel/driver/one_shot.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <thread>

#include "error_message.hpp"
#include "posted_bus.hpp"
#include "register_stub.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/increment.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/driver/wide.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using test::PostedBus;
using test::RegisterStub;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
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
  return ((Uint128::product(part.length, part.frequency[axis]) + Uint128(kOne / 2)) >> 40).low();
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
  // The first word is FREQUENCY_LO[7] at 0x300, so axis n begins at word 4 (7 - n).
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
  // 5000 pulses of path at 1000 pulses/s are 5 s. At slightly higher speeds the clocks are rounded up.
  const auto card = timing(1'000'000);
  EXPECT_EQ(plan_line(card, {3000, 4000}, PathSpeed{1000, 1}).clocks(), 5'000'000U);
  EXPECT_EQ(plan_line(card, {3000, 4000}, PathSpeed{1'000'001, 1000}).clocks(), 4'999'996U);
  EXPECT_EQ(plan_line(card, {3000, 4000}, PathSpeed{1'000'000'001, 1'000'000}).clocks(), 5'000'000U);
  // sqrt(2) * 10^6 clocks, rounded up.
  EXPECT_EQ(plan_line(card, {1, 1}, PathSpeed{1}).clocks(), 1'414'214U);
}

TEST(OneShot, APathSpeedBeyond64BitsIsExact) {
  const CardTiming card = timing(4'000'000'000U, 1);
  EXPECT_THAT(argument_error([&] {
                plan_line(card, {std::int64_t{1} << 62}, PathSpeed{(1ULL << 62) - 1, 1000});
              }),
              HasSubstr("too fast"));
  // 2^40 pulses at 2^40 - 1 pulses in 1000 s take 4 * 10^12 + 3.6 clocks. 2^40 pulses need 257 parts, and the clocks of
  // each part are rounded up.
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

TEST(OneShot, StartIsOneTransferOfWritesAndNothingElse) {
  for (unsigned axes = 1; axes <= 8; ++axes) {
    RegisterStub bus(axes);
    Card card = Card::open(bus);
    Displacement line{5};
    line[axes - 1] = -2;
    const auto words = plan_line(card.timing(), line, 1ms).part(0).words();
    const std::size_t used = 4 * std::size_t{axes} + 3;
    bus.forget();
    start_line(card, line, 1ms);
    EXPECT_THAT(bus.transfers, ElementsAre(used));
    ASSERT_EQ(bus.log.size(), used);
    for (std::size_t i = 0; i < used; ++i) {
      const auto address = static_cast<std::uint32_t>(0xD00 - 0x10 * axes + 4 * i);
      EXPECT_EQ(bus.log[i], test::wrote(address, words[words.size() - used + i]));
    }
  }
}

TEST(OneShot, ALineTooFastOrTooLongTouchesNothing) {
  RegisterStub bus;
  Card card = Card::open(bus);
  bus.forget();
  EXPECT_THROW(start_line(card, {1'000'000}, 1ms), ArgumentError);
  EXPECT_THAT(argument_error([&] { start_line(card, {1}, std::chrono::hours(2000)); }), HasSubstr("run_line"));
  EXPECT_TRUE(bus.log.empty());
}

std::uint8_t reason_of_start(Card& card, const Displacement& line) {
  try {
    start_line(card, line, 1ms);
  } catch (const RefusedError& error) {
    EXPECT_EQ(error.address(), reg::kStart);
    return error.reason();
  }
  return 0;
}

TEST(OneShot, ABusyCardRefusesTheStartAndSaysWhy) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  start_line(card, {40, -100}, 1ms);
  EXPECT_TRUE(card.busy());
  EXPECT_EQ(reason_of_start(card, {1}), static_cast<std::uint8_t>(card_map::Reason::Busy));
  EXPECT_FALSE(card.refusal().has_value()) << "what was thrown is reported";
  card.wait_until_idle(10ms);
  EXPECT_THAT(engine->positions(), ElementsAre(40, -100, 0, 0));
}

// The bridge acknowledges the writes; the card refuses the second START.
TEST(OneShot, ASecondLineOnAPostedBusIsRefusedNotLost) {
  const auto engine = sim::make_model_engine({});
  PostedBus bus(*engine);
  Card card = Card::open(bus);
  start_line(card, {100}, 1ms);
  EXPECT_EQ(reason_of_start(card, {100}), static_cast<std::uint8_t>(card_map::Reason::Busy));
  card.wait_until_idle(10ms);
  EXPECT_EQ(engine->positions()[0], 100);
  EXPECT_EQ(reason_of_start(card, {100}), 0) << "the refusal of before does not count again";
  card.wait_until_idle(10ms);
  EXPECT_EQ(engine->positions()[0], 200);
}

// An earlier refusal, also of another program's access, is not lost and not taken for a refusal of this line.
TEST(OneShot, AnEarlierRefusalIsNotTakenForThisOne) {
  for (const bool posted : {false, true}) {
    const auto engine = sim::make_model_engine({});
    PostedBus bridge(*engine);
    Card card = Card::open(posted ? static_cast<Bus&>(bridge) : *engine);
    EXPECT_THROW(engine->write(reg::kMagic, 1), RefusedError);
    start_line(card, {5}, 1ms);
    EXPECT_EQ(reason_of_start(card, {5}), posted ? static_cast<std::uint8_t>(card_map::Reason::Busy) : 0);
    ASSERT_TRUE(card.refusal().has_value());
    EXPECT_EQ(card.refusal()->address, reg::kMagic);
    EXPECT_EQ(reason_of_start(card, {5}), static_cast<std::uint8_t>(card_map::Reason::Busy));
    card.clear_refusal();
    EXPECT_FALSE(card.refusal().has_value());
  }
}

// Different ticks of line and feed are the quickest way to a fault.
void raise_fault(Card& card) {
  Stream stream(card);
  LineCommand line;
  line.ticks = 10;
  line.mask = 1;
  FeedCommand feed;
  feed.ticks = 11;
  feed.rate = std::uint64_t{1} << 63;
  stream.send({feed, line, EndCommand{}});
  EXPECT_THROW(stream.finish(), FaultError);
}

TEST(OneShot, AFaultedCardNamesTheFault) {
  for (const bool posted : {false, true}) {
    const auto engine = sim::make_model_engine({});
    PostedBus bridge(*engine);
    Card card = Card::open(posted ? static_cast<Bus&>(bridge) : *engine);
    raise_fault(card);
    try {
      start_line(card, {5}, 1ms);
      FAIL();
    } catch (const FaultError& error) {
      EXPECT_EQ(error.faults(), card_map::field::kFaultTickMismatch);
      EXPECT_THAT(error.what(), HasSubstr("line: the card has stopped with a fault: TICK_MISMATCH"));
    }
    card.clear_faults();
    start_line(card, {5}, 1ms);
    card.wait_until_idle(10ms);
    EXPECT_EQ(engine->positions()[0], 5);
  }
}

TEST(OneShot, ACardWithoutDirectModeGetsTheLineThroughItsStream) {
  sim::ModelOptions options;
  options.engines = card_map::engines::kLines | card_map::engines::kJerk;
  const auto engine = sim::make_model_engine(options);
  Card card = Card::open(*engine);
  const OneShotPlan plan = plan_line(card.timing(), {40, -100, 0, 7}, 10ms);
  const std::uint64_t begun = engine->cycles();
  run_line(card, plan);
  EXPECT_THAT(engine->positions(), ElementsAre(40, -100, 0, 7));
  EXPECT_GE(engine->cycles() - begun, plan.clocks());
  start_line(card, {1}, 1ms);
  EXPECT_THROW(start_line(card, {1}, 1ms), StateError) << "busy";
  card.wait_until_idle(10ms);
  EXPECT_EQ(engine->positions()[0], 41);
}

TEST(OneShot, RunsAllPartsOfALongLine) {
  RegisterStub bus(4, 1'000'000'000);
  Card card = Card::open(bus);
  const OneShotPlan plan = plan_line(card.timing(), {1'000'003, -7}, std::chrono::hours(1));
  ASSERT_EQ(plan.size(), 4U);
  // The card is busy for 15 minutes after each START.
  std::vector<std::uint32_t> counts;
  std::chrono::nanoseconds until{0};
  bus.on_access = [&](const Access& access) {
    if (access.write && access.address == reg::count(0)) counts.push_back(access.data);
    if (access.write && access.address == reg::kStart) until = bus.slept + std::chrono::minutes(15);
    bus.values[reg::kStatus] = bus.slept < until ? card_map::field::kStatusBusy : 0;
    return true;
  };
  run_line(card, plan);
  EXPECT_THAT(counts, ElementsAre(250'001U, 250'001U, 250'000U, 250'001U));
  EXPECT_GE(bus.slept, std::chrono::hours(1));
  EXPECT_LE(bus.slept, std::chrono::hours(1) + 1s);
}

TEST(OneShot, ASpeedStartsALineOfItsTime) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  const OneShotPlan plan = start_line(card, {300, 400}, PathSpeed{1000, 1});
  EXPECT_EQ(plan.clocks(), 500'000U) << "500 pulses of path";
  const std::uint64_t begun = engine->cycles();
  card.wait_until_idle(1s);
  EXPECT_THAT(engine->positions(), ElementsAre(300, 400, 0, 0));
  EXPECT_GE(engine->cycles() - begun, 499'000U);
  EXPECT_THROW(start_line(card, {1}, PathSpeed{1, 10'000'000}), ArgumentError) << "longer than one start may be";
}

// At 1/16 of the ratio a line takes 16 times as long as planned, far beyond the margin.
TEST(OneShot, ALowRatioAndAHoldAreNoTimeOuts) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  card.set_ratio(Card::kFullRatio / 16);
  run_line(card, plan_line(card.timing(), {100}, 20ms), 2ms);
  EXPECT_EQ(engine->positions()[0], 100);
  card.set_ratio(Card::kFullRatio);
  card.request_hold(true);
  std::thread other([&card] {
    std::this_thread::sleep_for(50ms);
    card.request_hold(false);
  });
  run_line(card, plan_line(card.timing(), {10}, 100ms), 100ms);
  other.join();
  EXPECT_EQ(engine->positions()[0], 110);
}

TEST(OneShot, AnotherThreadAborts) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  std::thread other([&card] {
    std::this_thread::sleep_for(20ms);
    card.request_abort();
  });
  EXPECT_THROW(run_line(card, plan_line(card.timing(), {1000}, std::chrono::hours(200))), StateError);
  other.join();
  engine->wait(100);
  EXPECT_FALSE(card.busy());
  EXPECT_LT(engine->positions()[0], 1000);
  start_line(card, {5}, 1ms);
  card.wait_until_idle(1ms);
}

// A card that hangs: it stays busy and is not held.
TEST(OneShot, ALineThatNeverEndsTimesOut) {
  RegisterStub bus;
  Card card = Card::open(bus);
  bus.values[reg::kStatus] = card_map::field::kStatusBusy;
  bus.forget();
  EXPECT_THROW(run_line(card, plan_line(card.timing(), {10}, 1s), 100ms), TimeoutError);
  EXPECT_GE(bus.slept, 1100ms);
  EXPECT_LE(bus.slept, 1200ms);
}

// Resets the card at the fifth sleep.
class ResettingBus final : public Bus {
 public:
  explicit ResettingBus(sim::Engine& engine) : engine_(engine) {}
  std::size_t transfer(Access* accesses, std::size_t count) override { return engine_.transfer(accesses, count); }
  void sleep(std::chrono::nanoseconds time) override {
    engine_.sleep(time);
    if (++sleeps_ == 5) engine_.reset();
  }
  bool reports_refusals() const override { return true; }

 private:
  sim::Engine& engine_;
  int sleeps_ = 0;
};

// After the reset the card is idle, but it has not made its line.
TEST(OneShot, ACardThatWasResetIsFound) {
  const auto engine = sim::make_model_engine({});
  ResettingBus bus(*engine);
  Card card = Card::open(bus);
  const OneShotPlan plan = plan_line(card.timing(), {1000}, 100ms);
  EXPECT_THROW(run_line(card, plan), StateError);
  Card again = Card::open(bus);
  run_line(again, plan);
  EXPECT_EQ(engine->positions()[0], 1000);
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

RC_GTEST_PROP(OneShotProperty, TheFrequencyLandsExactly, ()) {
  const auto clocks = *rc::gen::inRange<std::uint64_t>(1, kOne);
  const auto pulses = *rc::gen::inRange<std::uint64_t>(0, std::min<std::uint64_t>(clocks, 0xFFFFFFFF) + 1);
  OneShotPart part;
  part.length = clocks;
  part.frequency[0] = rounded_share(pulses, clocks);
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
