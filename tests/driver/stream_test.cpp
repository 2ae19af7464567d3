#include "trammel/driver/stream.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posted_bus.hpp"
#include "register_stub.hpp"
#include "stream_commands.hpp"
#include "trammel/card_map.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using test::Made;
using test::PostedBus;
using test::RegisterStub;
using test::was_read;
using test::wrote;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace reg = card_map::reg;
namespace field = card_map::field;

// The words of the commands as writes to STREAM.
std::vector<Made> writes_of(const std::vector<Command>& commands, std::uint8_t number) {
  std::vector<Made> writes;
  for (const std::uint32_t word : words_of(commands, number)) writes.push_back(wrote(reg::kStream, word));
  return writes;
}

// The accesses on the bus, with a stub whose registers the test sets.
class StreamOrder : public ::testing::Test {
 protected:
  StreamOrder() : card_(Card::open(bus_)) {
    options_.poll_clocks = 100;
    bus_.values[reg::kGeometryRoom] = 4096;
    bus_.values[reg::kFeedRoom] = 2560;
  }

  Stream open_stream() {
    bus_.forget();
    Stream stream(card_, options_);
    EXPECT_THAT(bus_.log, ElementsAre(was_read(reg::kStatus), was_read(reg::kHold),
                                      wrote(reg::kControl, field::kControlAbort), wrote(reg::kRefusal, 0x0FFFFFFF)));
    bus_.forget();
    return stream;
  }
  void expect_log(const std::vector<std::vector<Made>>& parts) {
    std::vector<Made> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    EXPECT_EQ(bus_.log, all);
    bus_.forget();
  }

  RegisterStub bus_;
  Card card_;
  StreamOptions options_;
};

TEST_F(StreamOrder, OpensAnIdleCardOnly) {
  open_stream();
  bus_.values[reg::kStatus] = field::kStatusBusy;
  EXPECT_THROW(Stream{card_}, StateError);
  bus_.values[reg::kStatus] = field::kStatusFaulted;
  bus_.values[reg::kFault] = 1;
  EXPECT_THROW(Stream{card_}, FaultError);
  options_.margin = 0ns;
  EXPECT_THROW(Stream(card_, options_), ArgumentError);
}

TEST_F(StreamOrder, RoomIsReadOnceAndThenCounted) {
  Stream stream = open_stream();
  // A line of one axis takes 7 halfwords, a feed piece 20.
  bus_.next[reg::kGeometryRoom] = {14, 4};
  bus_.next[reg::kFeedRoom] = {20, 4};
  stream.send(line_of(5));
  expect_log({{was_read(reg::kGeometryRoom)}, writes_of({line_of(5)}, 0)});
  stream.send(feed_of(5));
  expect_log({{was_read(reg::kFeedRoom)}, writes_of({feed_of(5)}, 1)});
  stream.send(line_of(6));
  expect_log({writes_of({line_of(6)}, 2)});
  stream.send(DwellCommand{9});
  EXPECT_THAT(bus_.transfers, ElementsAre(2U, 3U)) << "both rooms at once";
  expect_log({{was_read(reg::kGeometryRoom), was_read(reg::kFeedRoom)}, writes_of({DwellCommand{9}}, 3)});
  EXPECT_EQ(stream.sent(), 4U);
}

TEST_F(StreamOrder, SeveralCommandsAreOneTransferAsFarAsThereIsRoom) {
  Stream stream = open_stream();
  bus_.next[reg::kGeometryRoom] = {20, 6, 7};  // room for two lines of 7 halfwords
  bus_.values[reg::kStatus] = field::kStatusBusy;
  stream.send({line_of(1), line_of(2), line_of(3)});
  EXPECT_THAT(bus_.transfers, ElementsAre(1U, 8U, 1U, 3U, 1U, 4U));
  EXPECT_THAT(bus_.sleeps, ElementsAre(100us));
  expect_log({{was_read(reg::kGeometryRoom)},
              writes_of({line_of(1), line_of(2)}, 0),
              {was_read(reg::kGeometryRoom), was_read(reg::kStatus), was_read(reg::kGeometryBegun),
               was_read(reg::kFeedBegun), was_read(reg::kGeometryRoom)},
              writes_of({line_of(3)}, 2)});
}

TEST_F(StreamOrder, PutKeepsBackUntilFlushOrAFullTransfer) {
  Stream stream = open_stream();
  stream.send(DwellCommand{});  // the stream then knows both rooms
  bus_.forget();
  stream.put(line_of(1));
  stream.put(feed_of(1));
  EXPECT_EQ(stream.sent(), 1U);
  EXPECT_EQ(stream.next_number(), 3);
  expect_log({});
  stream.flush();
  expect_log({writes_of({line_of(1), feed_of(1)}, 1)});
  EXPECT_EQ(stream.sent(), 3U);
  stream.flush();
  expect_log({});
  for (int i = 0; i < 200; ++i) stream.put(line_of(1));
  EXPECT_GT(stream.sent(), 100U);
  EXPECT_LT(stream.sent(), 203U);
  for (const std::size_t accesses : bus_.transfers) EXPECT_LE(accesses, 512U);
}

TEST_F(StreamOrder, OnAPostedBusEveryTransferOfWordsIsConfirmed) {
  bus_.posted = true;
  Stream stream(card_, options_);
  stream.send(DwellCommand{});
  bus_.forget();
  stream.send({line_of(1), feed_of(1)});
  expect_log({writes_of({line_of(1), feed_of(1)}, 1), {was_read(reg::kRefusal)}});
  bus_.values[reg::kRefusal] = reg::kStream << 16 | 0x0006U;
  try {
    stream.send(line_of(1));
    FAIL();
  } catch (const RefusedError& error) {
    EXPECT_EQ(error.reason(), static_cast<std::uint8_t>(card_map::Reason::BadField));
  }
  EXPECT_THROW(stream.flush(), StateError);
}

TEST_F(StreamOrder, FinishWaitsUntilAllHasBegunAndEnded) {
  Stream stream = open_stream();
  stream.send(EndCommand{});
  bus_.forget();
  bus_.next[reg::kStatus] = {field::kStatusBusy, field::kStatusBusy, field::kStatusEnded, field::kStatusEnded};
  bus_.next[reg::kGeometryBegun] = {0, 1};
  bus_.next[reg::kFeedBegun] = {0, 0, 0};
  bus_.values[reg::kGeometryBegun] = 1;
  bus_.values[reg::kFeedBegun] = 1;
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_THAT(bus_.sleeps, ElementsAre(100us, 100us, 100us, 100us));
}

TEST_F(StreamOrder, BadCommandsNeverReachTheBus) {
  Stream stream = open_stream();
  EXPECT_THROW(stream.send({line_of(1), LineCommand{}}), ArgumentError);
  LineCommand fifth = line_of(1);
  fifth.mask = 0x10;
  fifth.increment = {};
  EXPECT_THROW(stream.send(fifth), ArgumentError);
  EXPECT_THROW(stream.put(fifth), ArgumentError);
  EXPECT_EQ(stream.next_number(), 0);
  expect_log({});
}

TEST_F(StreamOrder, ARefusedWordIsExplainedAndClosesTheStream) {
  Stream stream = open_stream();
  bus_.on_access = [](const Access& access) { return !(access.write && access.address == reg::kStream); };
  bus_.values[reg::kRefusal] = reg::kStream << 16 | 0x0004U;
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

// A card that begins no further command and is not held is reported after the planned time and the margin.
TEST_F(StreamOrder, AHangTimesOutInTheTimePlannedAndAHoldDoesNot) {
  options_.margin = 10ms;
  Stream stream = open_stream();
  stream.send({feed_of(1'000'000), line_of(1'000'000), EndCommand{}});  // 16 s
  bus_.forget();
  bus_.values[reg::kGeometryBegun] = 1;
  bus_.values[reg::kFeedBegun] = 1;
  bus_.next[reg::kStatus] = std::deque<std::uint32_t>(100, field::kStatusBusy | field::kStatusHeld);
  bus_.values[reg::kStatus] = field::kStatusBusy;
  EXPECT_THROW(stream.finish(), TimeoutError);
  EXPECT_GE(bus_.slept, 16s + 10ms + 99 * 100us);
  EXPECT_LE(bus_.slept, 16s + 10ms + 102 * 100us);
}

// The allowed time of each piece depends on the ratio of its own class.
TEST_F(StreamOrder, AHangTimesOutByTheRatiosOfTheClasses) {
  options_.margin = 10ms;
  bus_.add_engines(card_map::engines::kClasses);
  card_ = Card::open(bus_);
  card_.set_ratio(PieceClass::kFeed, 0x10);
  card_.set_ratio(PieceClass::kRapid, 0x4000);
  card_.set_ratio(PieceClass::kFixed, 0x8000);
  Stream stream = open_stream();
  FeedCommand rapid = feed_of(100'000);  // 1.6 s at the full ratio
  rapid.piece_class = PieceClass::kRapid;
  FeedCommand fixed = feed_of(100'000);
  fixed.piece_class = PieceClass::kFixed;
  stream.send({rapid, fixed, line_of(200'000), EndCommand{}});
  bus_.forget();
  bus_.values[reg::kGeometryBegun] = 1;
  bus_.values[reg::kFeedBegun] = 1;
  bus_.values[reg::kStatus] = field::kStatusBusy;
  EXPECT_THROW(stream.finish(), TimeoutError);
  EXPECT_GE(bus_.slept, 4 * 1600ms + 2 * 1600ms + 10ms);
  EXPECT_LE(bus_.slept, 4 * 1600ms + 2 * 1600ms + 10ms + 1ms);
}

TEST_F(StreamOrder, ALinkThatDiesInMidBatchClosesTheStream) {
  Stream stream = open_stream();
  int words = 0;
  bus_.on_access = [&words](const Access& access) -> bool {
    if (access.write && access.address == reg::kStream && ++words == 5) throw LinkError("tcp: connection reset");
    return true;
  };
  try {
    stream.send({line_of(1), line_of(2), line_of(3)});
    FAIL();
  } catch (const LinkError& error) {
    EXPECT_STREQ(error.what(), "tcp: connection reset");
  }
  EXPECT_EQ(stream.sent(), 0U) << "not known to be";
  EXPECT_THROW(stream.finish(), StateError);
  stream.restart();
  EXPECT_EQ(stream.next_number(), 0);
  stream.send(line_of(1));
}

TEST_F(StreamOrder, NonsenseIsALinkErrorAtOnce) {
  for (const std::uint32_t address : {reg::kGeometryRoom, reg::kStatus}) {
    Stream stream = open_stream();
    bus_.values[reg::kGeometryRoom] = 0;
    bus_.values[address] = 0xFFFFFFFF;
    EXPECT_THROW(stream.send(line_of(1)), LinkError);
    bus_.values[reg::kStatus] = 0;
    bus_.values[reg::kGeometryRoom] = 4096;
    EXPECT_THROW(stream.send(line_of(1)), StateError);
    EXPECT_LE(bus_.slept, 100us);
  }
}

// A dead bus that reads as zeros looks like an idle card that has not begun a command.
TEST_F(StreamOrder, ZerosAreALinkErrorWithinTwoLooks) {
  Stream stream = open_stream();
  stream.send({feed_of(10), line_of(10)});
  bus_.forget();
  bus_.values.clear();
  EXPECT_THROW(stream.finish(), LinkError);
  EXPECT_LE(bus_.slept, 200us);
}

TEST_F(StreamOrder, MoreBegunThanSentIsAStateError) {
  Stream stream = open_stream();
  stream.send({feed_of(10), line_of(10)});
  bus_.values[reg::kStatus] = field::kStatusBusy;
  bus_.values[reg::kGeometryBegun] = 2;
  bus_.forget();
  EXPECT_THROW(stream.finish(), StateError);
  EXPECT_LE(bus_.slept, 100us);
}

// A fault resets the counters of the card to 0.
TEST_F(StreamOrder, AFaultBetweenTheReadsOfALookIsAFault) {
  Stream stream = open_stream();
  stream.send({feed_of(100), line_of(100, 10), line_of(100, 10)});
  bus_.values[reg::kStatus] = field::kStatusBusy;
  unsigned looks = 0;
  bus_.on_access = [&](const Access& access) {
    if (access.address != reg::kGeometryBegun) return true;
    bus_.values[reg::kGeometryBegun] = ++looks == 1 ? 1 : 0;
    if (looks == 2) {
      bus_.values[reg::kStatus] = field::kStatusFaulted;
      bus_.values[reg::kFault] = field::kFaultWatchdog;
    }
    return true;
  };
  EXPECT_THROW(stream.finish(), FaultError);
}

TEST_F(StreamOrder, HonoursTheCardsEngines) {
  bus_.set_engines(card_map::engines::kLines);
  Card card = Card::open(bus_);
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
  EXPECT_THAT(message(arc), HasSubstr("ARC needs accumulator"));
  FeedCommand feed = feed_of(4);
  EXPECT_EQ(message(feed), "");
  feed.jerk = 1;
  EXPECT_THAT(message(feed), HasSubstr("FEED needs jerk"));
  feed.jerk = 0;
  feed.piece_class = PieceClass::kRapid;
  EXPECT_THAT(message(feed), HasSubstr("FEED needs classes"));
  // The step rule may be a reason, too. The whole command is refused before any of its words is written.
  bus_.add_engines(card_map::engines::kAccumulator);
  Card in_four = Card::open(bus_);
  Stream four(in_four);
  arc.eight_directions = true;
  bus_.forget();
  try {
    four.send(arc);
    FAIL() << "accepted";
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("ARC needs accumulator_8"));
  }
  EXPECT_TRUE(bus_.log.empty());
  bus_.add_engines(card_map::engines::kAccumulator8);
  Card in_eight = Card::open(bus_);
  Stream eight(in_eight);
  EXPECT_NO_THROW(eight.send(arc));
  // The number of axes does not limit the class.
  bus_.values[reg::kAxes] = 1;
  bus_.add_engines(card_map::engines::kClasses);
  Card with_classes = Card::open(bus_);
  Stream again(with_classes);
  feed.piece_class = PieceClass::kFixed;
  again.send(feed);
}

}  // namespace
}  // namespace trammel::driver
