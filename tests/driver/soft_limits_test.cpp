// Soft limits of the card: writes of the driver; on the model, that an axis stops at its limit.
#include <gmock/gmock.h>

#include "error_message.hpp"
#include "register_stub.hpp"
#include "stream_commands.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using test::RegisterStub;
using test::wrote;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace reg = card_map::reg;
namespace field = card_map::field;

TEST(SoftLimits, NoneHoldWhileTheEndsChange) {
  RegisterStub bus;
  bus.add_engines(card_map::engines::kPathCommands | card_map::engines::kMachineInputs |
                  card_map::engines::kSoftLimits);
  Card card = Card::open(bus);
  bus.forget();
  card.set_soft_limits({SoftRange{-5, 7}, std::nullopt, SoftRange{2'147'483'647, -2'147'483'648}});
  EXPECT_THAT(bus.log, ElementsAre(wrote(reg::kSoftLimits, 0), wrote(reg::soft_minus(0), 0xFFFFFFFB),
                                   wrote(reg::soft_plus(0), 7), wrote(reg::soft_minus(2), 0x7FFFFFFF),
                                   wrote(reg::soft_plus(2), 0x80000000), wrote(reg::kSoftLimits, 5)));
  bus.forget();
  card.set_soft_limits({});
  EXPECT_THAT(bus.log, ElementsAre(wrote(reg::kSoftLimits, 0)));
  bus.forget();
  EXPECT_THAT(argument_error([&] { card.set_soft_limits({SoftRange{3, 2}}); }), HasSubstr("axis 0: 3 to 2"));
  EXPECT_THAT(argument_error([&] { card.set_soft_limits(std::vector<std::optional<SoftRange>>(5)); }),
              HasSubstr("the card has 4"));
  EXPECT_TRUE(bus.log.empty());
}

TEST(SoftLimits, ACardWithoutThemSaysSo) {
  RegisterStub bus;
  Card card = Card::open(bus);
  EXPECT_FALSE(card.has_soft_limits());
  EXPECT_THAT(argument_error([&] { card.set_soft_limits({}); }), HasSubstr("soft limits: the card has none"));
  EXPECT_THAT(argument_error([&] { card.read_soft_limits(); }), HasSubstr("soft limits: the card has none"));
  EXPECT_THAT(argument_error([&] { card.set_soft_limit_ramps(true); }), HasSubstr("soft limits: the card has none"));
}

TEST(SoftLimits, AreReadAsTheyStandInTheCard) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  card.set_soft_limits({SoftRange{-5, 7}, std::nullopt, SoftRange{2'147'483'647, -2'147'483'648}});
  const std::vector<std::optional<SoftRange>> ranges = card.read_soft_limits();
  ASSERT_EQ(ranges.size(), 4U);
  ASSERT_TRUE(ranges[0] && ranges[2]);
  EXPECT_EQ(ranges[0]->minus, -5);
  EXPECT_EQ(ranges[0]->plus, 7);
  EXPECT_EQ(ranges[2]->minus, 2'147'483'647);
  EXPECT_EQ(ranges[2]->length(), 1);
  EXPECT_FALSE(ranges[1] || ranges[3]);
}

TEST(SoftLimits, StopAtOnceWhereTheyAreToldTo) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  const std::uint32_t before = engine->read(reg::kStopReaction);
  EXPECT_NE(before & field::kStopReactionSoftLimit, 0U);
  card.set_soft_limit_ramps(false);
  EXPECT_EQ(engine->read(reg::kStopReaction), before & ~field::kStopReactionSoftLimit);
  card.set_soft_limit_ramps(true);
  EXPECT_EQ(engine->read(reg::kStopReaction), before);
}

TEST(SoftLimits, AnAxisStopsBehindItsEnd) {
  sim::ModelOptions options;
  const auto engine = sim::make_model_engine(options);
  Card card = Card::open(*engine);
  ASSERT_TRUE(card.has_soft_limits());
  card.set_slew_time(1ms);
  card.set_soft_limits({SoftRange{-50, 500}});
  try {
    start_line(card, {2000}, 100ms);
    card.wait_until_idle(1s);
    FAIL() << "it has gone through";
  } catch (const FaultError& error) {
    EXPECT_THAT(error.what(), HasSubstr("SOFT_LIMIT (axis 0 plus)"));
  }
  card.wait_until_stopped();
  const std::int64_t at = engine->positions()[0];
  EXPECT_GT(at, 500);
  EXPECT_LT(at, 600) << "the way of the ramp";
  const LimitState state = card.read_limit_state();
  EXPECT_EQ(state.soft_axis, 0);
  EXPECT_TRUE(state.soft_plus);
  card.clear_faults();
  start_line(card, {-at}, 100ms);
  card.wait_until_idle(1s);
  EXPECT_EQ(engine->positions()[0], 0) << "back is free, from beyond the end too";
  EXPECT_EQ(card.read_faults(), 0U);
}

}  // namespace
}  // namespace trammel::driver
