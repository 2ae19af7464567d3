#include "trammel/driver/stream.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "trammel/card_map.hpp"
#include "trammel/driver/fake_card.hpp"
#include "trammel/driver/mock_bus.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using ::testing::_;
using ::testing::InSequence;
using ::testing::Return;
using ::testing::StrictMock;
namespace reg = card_map::reg;
namespace field = card_map::field;

LineCommand line_of(std::uint64_t ticks, std::int64_t pulses = 0) {
  LineCommand line;
  line.ticks = ticks;
  line.mask = 1;
  line.increment[0] = pulses * (std::int64_t{1} << 40) / static_cast<std::int64_t>(ticks);
  return line;
}

FeedCommand feed_of(std::uint64_t ticks) {
  FeedCommand feed;
  feed.ticks = ticks;
  feed.rate = 1;
  return feed;
}

std::vector<std::uint32_t> words_of(const std::vector<Command>& commands, std::uint8_t number) {
  std::vector<std::uint32_t> words;
  for (const Command& command : commands) {
    encode(command, number++, words);
  }
  return words;
}

class StreamOrder : public ::testing::Test {
 protected:
  StreamOrder() : card_(open()) { options_.poll_clocks = 100; }

  Card open() {
    EXPECT_CALL(bus_, read(_)).WillRepeatedly([this](std::uint32_t address) { return fake_.read(address); });
    const Card card = Card::open(bus_);
    ::testing::Mock::VerifyAndClearExpectations(&bus_);
    return card;
  }

  Stream open_stream() {
    InSequence in_order;
    EXPECT_CALL(bus_, read(reg::kStatus)).WillOnce(Return(0U));
    EXPECT_CALL(bus_, write(reg::kControl, field::kControlAbort));
    EXPECT_CALL(bus_, write(reg::kRefusal, 0x0FFFFFFF));
    return Stream(card_, options_);
  }

  FakeCard fake_;  // only for the identification
  StrictMock<MockBus> bus_;
  Card card_;
  StreamOptions options_;
};

TEST_F(StreamOrder, OpensAnIdleCardOnly) {
  open_stream();
  EXPECT_CALL(bus_, read(reg::kStatus)).WillOnce(Return(field::kStatusBusy));
  EXPECT_THROW(Stream{card_}, StateError);
  EXPECT_CALL(bus_, read(reg::kStatus)).WillOnce(Return(field::kStatusFaulted));
  EXPECT_CALL(bus_, read(reg::kFault)).WillOnce(Return(1U));
  EXPECT_THROW(Stream{card_}, FaultError);
  options_.stall_timeout = 0ns;
  EXPECT_THROW(Stream(card_, options_), ArgumentError);
}

TEST_F(StreamOrder, RoomIsReadOnceAndThenCounted) {
  Stream stream = open_stream();
  InSequence in_order;
  // A line of one axis takes 7 halfwords, a piece 20.
  EXPECT_CALL(bus_, read(reg::kGeometryRoom)).WillOnce(Return(14U));
  EXPECT_CALL(bus_, block(reg::kStream, words_of({line_of(5)}, 0), Addressing::kFixed));
  stream.send(line_of(5));
  EXPECT_CALL(bus_, read(reg::kFeedRoom)).WillOnce(Return(20U));
  EXPECT_CALL(bus_, block(reg::kStream, words_of({feed_of(5)}, 1), Addressing::kFixed));
  stream.send(feed_of(5));
  EXPECT_CALL(bus_, block(reg::kStream, words_of({line_of(6)}, 2), Addressing::kFixed));
  stream.send(line_of(6));
  EXPECT_CALL(bus_, read(reg::kGeometryRoom)).WillOnce(Return(4U));
  EXPECT_CALL(bus_, read(reg::kFeedRoom)).WillOnce(Return(4U));
  EXPECT_CALL(bus_, block(reg::kStream, words_of({DwellCommand{9}}, 3), Addressing::kFixed));
  stream.send(DwellCommand{9});
  EXPECT_EQ(stream.sent(), 4U);
}

TEST_F(StreamOrder, SeveralCommandsAreOneBlockAsFarAsThereIsRoom) {
  Stream stream = open_stream();
  const std::vector<Command> commands{line_of(1), line_of(2), line_of(3)};
  InSequence in_order;
  EXPECT_CALL(bus_, read(reg::kGeometryRoom)).WillOnce(Return(20U));  // two lines of 7
  EXPECT_CALL(bus_, block(reg::kStream, words_of({line_of(1), line_of(2)}, 0), Addressing::kFixed));
  EXPECT_CALL(bus_, read(reg::kGeometryRoom)).WillOnce(Return(6U));
  EXPECT_CALL(bus_, read(reg::kStatus)).WillOnce(Return(field::kStatusBusy));
  EXPECT_CALL(bus_, read(reg::kGeometryBegun)).WillOnce(Return(0U));
  EXPECT_CALL(bus_, read(reg::kFeedBegun)).WillOnce(Return(0U));
  EXPECT_CALL(bus_, wait(100));
  EXPECT_CALL(bus_, read(reg::kGeometryRoom)).WillOnce(Return(7U));
  EXPECT_CALL(bus_, block(reg::kStream, words_of({line_of(3)}, 2), Addressing::kFixed));
  stream.send(commands);
}

TEST_F(StreamOrder, FinishWaitsForTheEnd) {
  Stream stream = open_stream();
  InSequence in_order;
  EXPECT_CALL(bus_, read(reg::kGeometryRoom)).WillOnce(Return(4096U));
  EXPECT_CALL(bus_, read(reg::kFeedRoom)).WillOnce(Return(2560U));
  EXPECT_CALL(bus_, block(reg::kStream, _, Addressing::kFixed));
  stream.send(EndCommand{});
  for (const std::uint32_t status : {0U, field::kStatusBusy, field::kStatusEnded}) {
    EXPECT_CALL(bus_, wait(100));
    EXPECT_CALL(bus_, read(reg::kStatus)).WillOnce(Return(status));
    EXPECT_CALL(bus_, read(reg::kGeometryBegun)).WillOnce(Return(0U));
    EXPECT_CALL(bus_, read(reg::kFeedBegun)).WillOnce(Return(0U));
  }
  EXPECT_TRUE(stream.finish().ended);
}

TEST_F(StreamOrder, BadCommandsNeverReachTheBus) {
  Stream stream = open_stream();
  EXPECT_THROW(stream.send({line_of(1), LineCommand{}}), ArgumentError);
  LineCommand fifth = line_of(1);
  fifth.mask = 0x10;
  fifth.increment = {};
  EXPECT_THROW(stream.send(fifth), ArgumentError);
  EXPECT_EQ(stream.next_number(), 0);
}

TEST_F(StreamOrder, ARefusedWordIsExplainedAndClosesTheStream) {
  Stream stream = open_stream();
  InSequence in_order;
  EXPECT_CALL(bus_, read(reg::kGeometryRoom)).WillOnce(Return(4096U));
  EXPECT_CALL(bus_, block(_, _, _)).WillOnce([](auto, auto, auto) { throw BusError(reg::kStream, Direction::kWrite); });
  EXPECT_CALL(bus_, read(reg::kRefusal)).WillOnce(Return(reg::kStream << 16 | 0x0004U));
  try {
    stream.send(line_of(1));
    FAIL();
  } catch (const RefusedError& error) {
    EXPECT_EQ(error.reason(), static_cast<std::uint8_t>(card_map::Reason::BadNumber));
    EXPECT_EQ(error.command_number(), 0);
  }
  EXPECT_THROW(stream.send(line_of(1)), StateError);
  EXPECT_THROW(stream.finish(), StateError);
}

TEST_F(StreamOrder, AStallTimesOutAndAHoldDoesNot) {
  options_.stall_timeout = 250us;  // at 1 MHz: three pauses of 100 clocks
  Stream stream = open_stream();
  EXPECT_CALL(bus_, read(reg::kGeometryRoom)).WillRepeatedly(Return(0U));
  EXPECT_CALL(bus_, read(reg::kGeometryBegun)).WillRepeatedly(Return(3U));
  EXPECT_CALL(bus_, read(reg::kFeedBegun)).WillRepeatedly(Return(2U));
  EXPECT_CALL(bus_, wait(100)).Times(12);
  EXPECT_CALL(bus_, read(reg::kStatus))
      .Times(13)
      .WillOnce(Return(field::kStatusBusy | field::kStatusHeld))
      .WillOnce(Return(field::kStatusBusy | field::kStatusHeld))
      .WillOnce(Return(field::kStatusBusy | field::kStatusHeld))
      .WillOnce(Return(field::kStatusBusy | field::kStatusHeld))
      .WillOnce(Return(field::kStatusBusy | field::kStatusHeld))
      .WillOnce(Return(field::kStatusBusy | field::kStatusHeld))
      .WillOnce(Return(field::kStatusBusy | field::kStatusHeld))
      .WillOnce(Return(field::kStatusBusy | field::kStatusHeld))
      .WillOnce(Return(field::kStatusBusy | field::kStatusHeld))
      .WillOnce(Return(field::kStatusBusy | field::kStatusHeld))
      .WillRepeatedly(Return(field::kStatusBusy));
  EXPECT_THROW(stream.send(line_of(1)), TimeoutError);
}

TEST(StreamOnFake, RunsAProgramThroughSmallQueues) {
  FakeCardOptions fake_options;
  fake_options.geometry_depth = 64;
  fake_options.feed_depth = 64;
  FakeCard fake(fake_options);
  Card card = Card::open(fake);
  StreamOptions options;
  std::uint64_t looks = 0;
  std::uint32_t begun = 0;
  options.progress = [&looks, &begun](const StreamProgress& progress) {
    ++looks;
    EXPECT_LE(progress.commands_sent, 602U);
    EXPECT_LE(progress.geometry_begun, 302U);
    begun = std::max(begun, progress.feed_begun);
  };
  Stream stream(card, options);
  std::vector<Command> program;
  for (int i = 0; i < 300; ++i) {
    program.emplace_back(line_of(500, i % 2 == 0 ? 7 : -3));
    program.emplace_back(feed_of(500));
  }
  program.emplace_back(DwellCommand{1000});
  program.emplace_back(EndCommand{});
  stream.send(program);
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_EQ(fake.position(0), 150 * 7 - 150 * 3);
  EXPECT_EQ(stream.sent(), 602U);
  EXPECT_EQ(fake.accepted().size(), 602U);
  EXPECT_EQ(fake.accepted().back().number, 601 % 256);
  EXPECT_GT(looks, 0U);
  EXPECT_GE(begun, 298U) << "pieces and barriers, beyond 8 bits";
  EXPECT_GE(fake.time(), 300U * 500U + 1000U);
}

TEST(StreamOnFake, AStreamThatStarvesTheCardTimesOut) {
  FakeCardOptions fake_options;
  fake_options.geometry_depth = 64;
  FakeCard fake(fake_options);
  Card card = Card::open(fake);
  StreamOptions options;
  options.stall_timeout = 10ms;
  Stream stream(card, options);
  EXPECT_THROW(stream.send(std::vector<Command>(100, line_of(10))), TimeoutError);
}

TEST(StreamOnFake, AFaultWhileWaitingEndsTheWait) {
  FakeCard fake;
  Card card = Card::open(fake);
  StreamOptions options;
  options.progress = [&fake](const StreamProgress&) { fake.raise_fault(card_map::field::kFaultPathIncomplete); };
  Stream stream(card, options);
  stream.send({line_of(100'000), feed_of(100'000), EndCommand{}});
  EXPECT_THROW(stream.finish(), FaultError);
  EXPECT_THROW(stream.restart(), FaultError);
  EXPECT_EQ(card.stop_snapshot().geometry_begun, 1U);
  card.clear_faults();
  stream.restart();
  stream.send({line_of(10, 1), feed_of(10), EndCommand{}});
  stream.finish();
  EXPECT_EQ(fake.position(0), 1);
}

// Recovery in whichever order, with an abort or without: nothing of before the fault moves.
TEST(StreamOnFake, RecoversInWhicheverOrder) {
  for (int order = 0; order < 3; ++order) {
    FakeCard fake;
    Card card = Card::open(fake);
    Stream stream(card);
    stream.send({line_of(1000, 100), feed_of(1000), EndCommand{}});
    fake.wait(100);
    fake.raise_fault(field::kFaultStep & 1U);
    if (order == 0) {
      card.abort();
    }
    card.clear_faults();
    if (order == 1) {
      card.abort();
    }
    fake.wait(10'000);
    EXPECT_EQ(fake.position(0), 0) << order;
    EXPECT_FALSE(card.busy());
    stream.restart();
    stream.send({line_of(10, 1), feed_of(10), EndCommand{}});
    EXPECT_TRUE(stream.finish().ended);
    EXPECT_EQ(fake.position(0), 1) << order;
  }
}

TEST(StreamOnFake, HonoursTheCardsEngines) {
  FakeCardOptions fake_options;
  fake_options.engines = 0x01;
  FakeCard fake(fake_options);
  Card card = Card::open(fake);
  Stream stream(card);
  ArcCommand arc;
  arc.ticks = arc.path_ticks = 4;
  const auto message = [&stream](const Command& command) -> std::string {
    try {
      stream.send(command);
    } catch (const ArgumentError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message(arc), ::testing::HasSubstr("ARC needs accumulator"));
  FeedCommand feed = feed_of(4);
  EXPECT_EQ(message(feed), "");
  feed.jerk = 1;
  EXPECT_THAT(message(feed), ::testing::HasSubstr("FEED needs jerk"));
}

TEST(StreamOnFake, TicksThatDoNotMatchAreAFault) {
  FakeCard fake;
  Card card = Card::open(fake);
  Stream stream(card);
  stream.send({line_of(10), feed_of(11), EndCommand{}});
  EXPECT_THROW(stream.finish(), FaultError);
  EXPECT_EQ(card.faults(), card_map::field::kFaultTickMismatch);
}

TEST(StreamOnFake, ARefusedCommandIsDroppedWholeAndTheStreamRestarts) {
  FakeCard fake;
  Card card = Card::open(fake);
  Stream stream(card);
  fake.refuse_command(1, card_map::Reason::BadField);
  try {
    stream.send({line_of(10, 1), line_of(20, 2), line_of(30, 3)});
    FAIL();
  } catch (const RefusedError& error) {
    EXPECT_EQ(error.command_number(), 1);
    EXPECT_EQ(error.reason(), static_cast<std::uint8_t>(card_map::Reason::BadField));
  }
  EXPECT_EQ(fake.accepted().size(), 1U);
  stream.restart();
  EXPECT_EQ(stream.next_number(), 0);
  stream.send(line_of(10, 1));
  EXPECT_EQ(fake.accepted().size(), 2U);
}

RC_GTEST_PROP(StreamProperty, AnyMatchedProgramArrivesInOrderAndWhole, ()) {
  FakeCardOptions fake_options;
  fake_options.geometry_depth = *rc::gen::inRange<std::uint32_t>(37, 200);
  fake_options.feed_depth = *rc::gen::inRange<std::uint32_t>(20, 200);
  FakeCard fake(fake_options);
  Card card = Card::open(fake);
  Stream stream(card);
  std::vector<Command> program;
  std::int64_t position = 0;
  const auto lines = *rc::gen::container<std::vector<int>>(rc::gen::inRange(-50, 50));
  for (const int pulses : lines) {
    program.emplace_back(line_of(64, pulses));
    program.emplace_back(feed_of(64));
    position += pulses;
  }
  program.emplace_back(EndCommand{});
  stream.send(program);
  stream.finish();
  RC_ASSERT(fake.position(0) == position);
  RC_ASSERT(fake.accepted().size() == program.size());
  for (std::size_t i = 0; i < program.size(); ++i) {
    RC_ASSERT(fake.accepted()[i].number == static_cast<std::uint8_t>(i));
    RC_ASSERT(words_of({fake.accepted()[i].command}, 0) == words_of({program[i]}, 0));
  }
}

}  // namespace
}  // namespace trammel::driver
