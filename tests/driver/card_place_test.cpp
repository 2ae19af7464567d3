// The machine's place: reads and writes of the driver, and its refusals before any write. On the model: events that the
// place survives, and events that lose it.
#include "trammel/driver/card_place.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <string>

#include "error_message.hpp"
#include "register_stub.hpp"
#include "stream_commands.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/stream.hpp"
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

TEST(CardPlace, EachIsOneAccess) {
  RegisterStub bus;
  bus.values[reg::kPlace] = 0x0102;
  bus.values[reg::kScales] = 0xC0FFEE01;
  bus.values[reg::machine_zero(1)] = 0xFFFFFFFF;
  bus.values[reg::kKeepsPlace] = 2;
  Card card = Card::open(bus);
  bus.forget();
  EXPECT_EQ(card.read_place().valid, 2);
  EXPECT_EQ(card.read_place().homed, 1);
  EXPECT_EQ(card.read_scales(), 0xC0FFEE01U);
  EXPECT_EQ(card.read_machine_zero(1), -1);
  EXPECT_EQ(card.read_keeps_place(), 2);
  EXPECT_THAT(bus.log, ElementsAre(was_read(reg::kPlace), was_read(reg::kPlace), was_read(reg::kScales),
                                   was_read(reg::machine_zero(1)), was_read(reg::kKeepsPlace)));
  bus.forget();
  card.set_place(3, true, false);
  card.set_place(2, true, true);
  card.set_place(1, false, false);
  card.set_machine_zero(0, -5);
  card.set_scales(7);
  card.set_keeps_place(1);
  EXPECT_THAT(bus.log, ElementsAre(wrote(reg::kSetPlace, 0x030001), wrote(reg::kSetPlace, 0x020003),
                                   wrote(reg::kSetPlace, 0x010000), wrote(reg::machine_zero(0), 0xFFFFFFFB),
                                   wrote(reg::kScales, 7), wrote(reg::kKeepsPlace, 1)));
}

TEST(CardPlace, BadArgumentsWriteNothing) {
  RegisterStub bus(2);
  Card card = Card::open(bus);
  bus.forget();
  EXPECT_THAT(argument_error([&] { card.set_place(4, true, false); }), HasSubstr("the card has 2 axes"));
  EXPECT_THAT(argument_error([&] { card.set_place(1, false, true); }), HasSubstr("has a valid place"));
  EXPECT_THAT(argument_error([&] { card.set_keeps_place(0x80); }), HasSubstr("the card has 2 axes"));
  EXPECT_THAT(argument_error([&] { card.read_machine_zero(2); }), HasSubstr("the card has 2 axes"));
  EXPECT_THAT(argument_error([&] { card.set_machine_zero(2, 0); }), HasSubstr("the card has 2 axes"));
  EXPECT_TRUE(bus.log.empty());
}

TEST(CardPlace, AnOlderMapHasNone) {
  RegisterStub bus(2);
  bus.values[reg::kMapVersion] = 0x30002;
  Card card = Card::open(bus);
  bus.forget();
  const std::function<void()> calls[] = {[&] { card.read_place(); },         [&] { card.set_place(1, true, false); },
                                         [&] { card.read_machine_zero(0); }, [&] { card.set_machine_zero(0, 1); },
                                         [&] { card.read_keeps_place(); },   [&] { card.set_keeps_place(1); },
                                         [&] { card.read_scales(); },        [&] { card.set_scales(1); }};
  for (const auto& call : calls) {
    EXPECT_THAT(argument_error(call), HasSubstr("map 3.2 keeps no place of the machine, which came with 3.3"));
  }
  EXPECT_TRUE(bus.log.empty());
}

// The message of a StateError of `call`.
std::string state_error(const std::function<void()>& call) {
  try {
    call();
  } catch (const StateError& error) {
    return error.what();
  }
  return "no error";
}

// A card of two axes. begin_line() moves axis 0 for a second; axis 1 is at rest.
class PlaceOnModel : public ::testing::Test {
 protected:
  PlaceOnModel() : card_(Card::open(*engine_)) {
    card_.set_place(3, true, true);
    card_.set_machine_zero(0, -100);
    card_.set_scales(9);
    card_.set_slew_time(1ms);
  }
  void begin_line() {
    Stream stream(card_, {});
    stream.send({feed_of(62'500), line_of(62'500, 1000), EndCommand{}});
    stream.flush();
    engine_->sleep(100ms);
    ASSERT_GT(engine_->positions()[0], 10);
  }
  static sim::ModelOptions two_axes() {
    sim::ModelOptions options;
    options.axes = 2;
    return options;
  }
  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine(two_axes());
  Card card_;
};

TEST_F(PlaceOnModel, OutlivesAStopOnThePathAndTheProgram) {
  begin_line();
  const Snapshot end = card_.stop();
  EXPECT_GT(end.position[0], 0);
  Card next = Card::open(*engine_);
  EXPECT_EQ(next.read_place().valid, 3);
  EXPECT_EQ(next.read_place().homed, 3);
  EXPECT_EQ(next.read_machine_zero(0), -100);
  EXPECT_EQ(next.read_scales(), 9U);
}

TEST_F(PlaceOnModel, OutlivesAStopByTheWatchdog) {
  card_.set_watchdog(65ms);
  begin_line();
  engine_->sleep(200ms);
  ASSERT_TRUE(card_.read_status().faulted);
  EXPECT_EQ(card_.read_place().valid, 3) << "on a ramp";
  card_.clear_faults();
  EXPECT_EQ(card_.read_place().valid, 3);
}

TEST_F(PlaceOnModel, IsLostByAnAbortOfTheAxisThatMoves) {
  begin_line();
  card_.abort();
  EXPECT_EQ(card_.read_place().valid, 2);
  EXPECT_EQ(card_.read_place().homed, 2);
  EXPECT_EQ(card_.read_scales(), 9U) << "so that the next program knows that there was a place";
  card_.abort();
  EXPECT_EQ(card_.read_place().valid, 2) << "an abort at rest takes nothing";
}

TEST_F(PlaceOnModel, IsKeptByAxesThatCannotLoseSteps) {
  card_.set_keeps_place(1);
  begin_line();
  card_.abort();
  EXPECT_EQ(card_.read_place().valid, 3);
}

TEST_F(PlaceOnModel, AProgramBeginsWhereTheOneBeforeHasEnded) {
  begin_line();
  EXPECT_THAT(state_error([&] { begin_at_place(card_, 1); }), HasSubstr("the card moves"));
  const std::int32_t at = card_.stop().position[0];
  const PlaceBegin begin = begin_at_place(card_, 3);
  EXPECT_FALSE(begin.first);
  EXPECT_EQ(begin.place.pulses()[0], at + 100);
  EXPECT_EQ(begin.place.bits.homed, 3) << "and leaves all as it is";
  EXPECT_EQ(begin.place.scales, 9U);
}

TEST_F(PlaceOnModel, TheFirstProgramSetsMachineZeroWhereTheCardStands) {
  begin_line();
  const std::int32_t at = card_.stop().position[0];
  card_.set_scales(kNoScales);  // as after a reset, except for the position
  card_.set_place(3, false, false);
  EXPECT_EQ(read_card_place(card_).pulses()[0], 0);
  const PlaceBegin begin = begin_at_place(card_, 1);
  EXPECT_TRUE(begin.first);
  EXPECT_EQ(begin.place.zero[0], at);
  EXPECT_EQ(begin.place.pulses()[0], 0);
  EXPECT_EQ(begin.place.bits.valid, 3);
  EXPECT_EQ(begin.place.bits.homed, 0);
  EXPECT_EQ(begin.place.scales, kScalesInPulses);
}

TEST_F(PlaceOnModel, ALostPlaceIsRefusedUnlessItIsTrusted) {
  begin_line();
  card_.abort();
  engine_->sleep(1ms);  // until the last pulse has ended
  EXPECT_THAT(state_error([&] { begin_at_place(card_, 3); }), HasSubstr("that of axis 0 was lost"));
  EXPECT_EQ(card_.read_place().valid, 2) << "nothing was written";
  EXPECT_EQ(begin_at_place(card_, 2).place.bits.valid, 2) << "of the other axis";
  EXPECT_EQ(begin_at_place(card_, 1, true).place.bits.valid, 3);
  EXPECT_THAT(argument_error([&] { begin_at_place(card_, 4); }), HasSubstr("the card has 2 axes"));
  card_.set_place(3, false, false);
  EXPECT_THAT(state_error([&] { begin_at_place(card_, 3); }), HasSubstr("that of axis 0, 1 was lost"));
}

// Scales that are already in pulses are not written again.
TEST(CardPlace, ScalesThatStandStay) {
  RegisterStub bus(2);
  bus.values[reg::kPlace] = 3;
  bus.values[reg::kScales] = kScalesInPulses;
  Card card = Card::open(bus);
  bus.forget();
  EXPECT_FALSE(begin_at_place(card, 3).first);
  for (const test::Made& made : bus.log)
    EXPECT_NE(std::get<1>(made), reg::kScales + (std::get<0>(made) ? 0U : 0x1000U));
}

}  // namespace
}  // namespace trammel::driver
