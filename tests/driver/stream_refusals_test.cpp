// Commands that the stream refuses because of the card. Answers that no working card gives: impossible rooms, queues
// that never empty, refusals of accesses that the stream did not make.
#include <gmock/gmock.h>

#include <algorithm>
#include <optional>
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
using ::testing::HasSubstr;
namespace reg = card_map::reg;
namespace field = card_map::field;

class StreamRefusals : public ::testing::Test {
 protected:
  StreamRefusals() {
    bus_.values[reg::kPorts] = 0x04'06'01;  // 6 inputs
    bus_.values[reg::kGeometryRoom] = 4096;
    bus_.values[reg::kFeedRoom] = 2560;
  }
  void open() {
    card_.emplace(Card::open(bus_));
    stream_.emplace(*card_, StreamOptions{100, 10ms, nullptr, false});
    bus_.forget();
  }

  RegisterStub bus_;
  std::optional<Card> card_;
  std::optional<Stream> stream_;
};

TEST_F(StreamRefusals, SilentPiecesNeedTheirMap) {
  FeedCommand silent = feed_of(4);
  silent.silent = true;
  bus_.values[reg::kMapVersion] = 0x30001;
  open();
  EXPECT_EQ(argument_error([&] { stream_->send(silent); }),
            "stream: FEED: the card's map 3.1 has no silent pieces; they came with 3.2");
  EXPECT_NO_THROW(stream_->send(feed_of(4)));
  bus_.values[reg::kMapVersion] = 0x30002;
  open();
  EXPECT_NO_THROW(stream_->send(silent));
  EXPECT_EQ(stream_->sent(), 1U);
}

TEST_F(StreamRefusals, AnArcInFourDirectionsNeedsTheAccumulatorAlone) {
  open();
  ArcCommand arc;
  arc.ticks = arc.path_ticks = 4;
  EXPECT_NO_THROW(stream_->send(arc));
  arc.eight_directions = true;
  EXPECT_THAT(argument_error([&] { stream_->send(arc); }), HasSubstr("ARC needs accumulator_8"));
  EXPECT_EQ(stream_->sent(), 1U);
}

// The stream reads PORTS once.
TEST_F(StreamRefusals, InputsThatTheCardLacks) {
  bus_.add_engines(card_map::engines::kPathCommands);
  open();
  stream_->send({WaitInputCommand{5, true, 0}, ProbeCommand{0, true}});
  EXPECT_EQ(argument_error([&] {
              stream_->send(WaitInputCommand{6, true, 0});
            }),
            "stream: WAIT_INPUT: input 6, but the card has 6 inputs");
  EXPECT_EQ(argument_error([&] {
              stream_->send(ProbeCommand{31, false});
            }),
            "stream: PROBE: input 31, but the card has 6 inputs");
  EXPECT_EQ(std::count(bus_.log.begin(), bus_.log.end(), test::was_read(reg::kPorts)), 1);
  EXPECT_EQ(stream_->sent(), 2U);
}

TEST_F(StreamRefusals, ARoomBeyondItsQueueIsNoCard) {
  open();
  bus_.values[reg::kFeedRoom] = 2561;
  EXPECT_EQ(message_of<LinkError>([&] { stream_->send(feed_of(1)); }),
            "stream: a feed queue with room for 2561 halfwords: what answers is no card");
  open();
  bus_.values[reg::kGeometryRoom] = 4097;
  EXPECT_EQ(message_of<LinkError>([&] { stream_->send(line_of(1)); }),
            "stream: a geometry queue with room for 4097 halfwords: what answers is no card");
}

// The card has begun all commands and is idle, but still has no room. Only the time-out ends the wait.
TEST_F(StreamRefusals, AnIdleCardWithoutRoomTimesOut) {
  open();
  bus_.values[reg::kGeometryRoom] = 6;
  EXPECT_THAT(message_of<TimeoutError>([&] { stream_->send(line_of(1)); }),
              HasSubstr("stream: waiting for room in the card's queues: not within"));
  EXPECT_GE(bus_.slept, 10ms);
  EXPECT_LE(bus_.slept, 11ms);
}

TEST_F(StreamRefusals, AnIdleCardThatKeepsWhatItWasSentWasReset) {
  open();
  bus_.next[reg::kGeometryRoom] = {7};
  bus_.values[reg::kGeometryRoom] = 6;
  stream_->send(line_of(1));
  EXPECT_THAT(message_of<StateError>([&] { stream_->send(line_of(1)); }),
              HasSubstr("the card is idle, but of 1 geometry and 0 feed commands it has begun 0 and 0"));
  EXPECT_EQ(bus_.slept, 100us) << "found at the second look";
  EXPECT_EQ(message_of<StateError>([&] { stream_->flush(); }), "stream: closed by an error; restart it");
}

// An access other than a word of the stream was refused, on a bus that does not report it.
TEST_F(StreamRefusals, ARefusalThatALookFindsClosesTheStream) {
  open();
  stream_->send(line_of(1));
  bus_.values[reg::kStatus] = field::kStatusBusy | field::kStatusRefused;
  bus_.values[reg::kRefusal] = reg::kSlew << 16 | static_cast<unsigned>(card_map::Reason::BadValue);
  EXPECT_THAT(message_of<RefusedError>([&] { stream_->finish(); }), HasSubstr("Access to SLEW"));
  EXPECT_EQ(bus_.values[reg::kRefusal], 0U);
  EXPECT_THROW(stream_->flush(), StateError);
}

TEST_F(StreamRefusals, ARefusalThatIsGoneAgainIsNone) {
  open();
  stream_->send(line_of(1));
  bus_.next[reg::kStatus] = {field::kStatusBusy | field::kStatusRefused, field::kStatusBusy};
  bus_.values[reg::kGeometryBegun] = 1;
  EXPECT_FALSE(stream_->finish().busy);
}

TEST_F(StreamRefusals, AnEndThatIsBegunButNotReachedIsWaitedFor) {
  open();
  stream_->send(EndCommand{});
  bus_.values[reg::kGeometryBegun] = bus_.values[reg::kFeedBegun] = 1;
  EXPECT_THROW(stream_->finish(), TimeoutError) << "STATUS.ended never comes";
  bus_.next[reg::kStatus] = {0, 0, field::kStatusEnded};
  bus_.forget();
  EXPECT_TRUE(stream_->finish().ended);
  EXPECT_EQ(bus_.sleeps.size(), 3U);
}

// A hold of another program, which ends while the stream waits.
TEST(StreamHolds, AStreamMayOpenInAHold) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  engine->write(reg::kHold, 1);
  engine->wait(100);
  EXPECT_THROW(Stream{card}, HeldError);
  StreamOptions options;
  options.opens_in_hold = true;
  int held = 0;
  options.progress = [&](const StreamProgress& progress) {
    if (progress.status.held && ++held == 100) engine->write(reg::kHold, 0);
  };
  Stream stream(card, options);
  stream.send({feed_of(1000), line_of(1000, 10), EndCommand{}});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_GE(held, 100);
  EXPECT_EQ(engine->positions()[0], 10);
}

// Many lines for one piece fill the geometry queue; its watermark ends the wait.
TEST(StreamWatermarks, OfTheGeometryQueue) {
  sim::ModelOptions small;
  small.interrupt = true;
  small.geometry_depth = 64;
  const auto engine = sim::make_model_engine(small);
  Card card = Card::open(*engine);
  Stream stream(card);
  stream.put(feed_of(40 * 500));
  for (int i = 0; i < 40; ++i) stream.put(line_of(500, 5));
  stream.flush();
  EXPECT_EQ(engine->read(reg::kGeometryWatermark), 64U - 7U + 1U) << "room for a line of one axis";
  EXPECT_EQ(engine->read(reg::kIrqEnable), field::kStatusGeometryLow | field::kStatusFaulted | field::kStatusRefused);
  stream.put(EndCommand{});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_EQ(engine->positions()[0], 200);
  EXPECT_LE(engine->cycles(), 323'000U) << "no wait beyond the 40 lines of 8,000 clocks";
}

}  // namespace
}  // namespace trammel::driver
