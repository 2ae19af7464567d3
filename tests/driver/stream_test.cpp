#include "trammel/driver/stream.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <thread>

#include "posted_bus.hpp"
#include "register_stub.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/feed_time.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/sim/engine.hpp"

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

LineCommand line_of(std::uint64_t ticks, std::int64_t pulses = 0) {
  LineCommand line;
  line.ticks = ticks;
  line.mask = 1;
  line.increment[0] = pulses * (std::int64_t{1} << 40) / static_cast<std::int64_t>(ticks);
  return line;
}

// A tick every 16 clocks unless another rate is given.
FeedCommand feed_of(std::uint64_t ticks, std::uint64_t rate = std::uint64_t{1} << 60) {
  FeedCommand feed;
  feed.ticks = ticks;
  feed.rate = rate;
  return feed;
}

std::vector<std::uint32_t> words_of(const std::vector<Command>& commands, std::uint8_t number) {
  std::vector<std::uint32_t> words;
  for (const Command& command : commands) {
    encode(command, number++, words);
  }
  return words;
}

// The same as writes to the stream.
std::vector<Made> writes_of(const std::vector<Command>& commands, std::uint8_t number) {
  std::vector<Made> writes;
  for (const std::uint32_t word : words_of(commands, number)) writes.push_back(wrote(reg::kStream, word));
  return writes;
}

// What the bus sees, on a stub that says what the test wants.
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
    EXPECT_THAT(bus_.log, ElementsAre(was_read(reg::kStatus), wrote(reg::kControl, field::kControlAbort),
                                      wrote(reg::kRefusal, 0x0FFFFFFF)));
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
  options_.patience = 0ns;
  EXPECT_THROW(Stream(card_, options_), ArgumentError);
}

TEST_F(StreamOrder, RoomIsReadOnceAndThenCounted) {
  Stream stream = open_stream();
  // A line of one axis takes 7 halfwords, a piece 20.
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
  bus_.next[reg::kGeometryRoom] = {20, 6, 7};  // two lines of 7
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
  stream.send(DwellCommand{});  // the rooms are known from here on
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

// A card that begins nothing more, and is not held: reported after what was planned and the patience.
TEST_F(StreamOrder, AHangTimesOutInTheTimePlannedAndAHoldDoesNot) {
  options_.patience = 10ms;
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

// A dead bus that reads zeros looks like an idle card that has begun nothing.
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

// A bus that notes the words of the stream on their way to the model.
class Noting final : public Bus {
 public:
  explicit Noting(Bus& bus) : bus_(bus) {}
  std::size_t transfer(Access* accesses, std::size_t count) override {
    const std::size_t made = bus_.transfer(accesses, count);
    for (std::size_t i = 0; i < made; ++i) {
      if (accesses[i].write && accesses[i].address == reg::kStream) words.push_back(accesses[i].data);
    }
    return made;
  }
  void sleep(std::chrono::nanoseconds time) override { bus_.sleep(time); }
  bool reports_refusals() const override { return bus_.reports_refusals(); }

  std::vector<std::uint32_t> words;

 private:
  Bus& bus_;
};

TEST(StreamOnModel, RunsAProgramThroughSmallQueues) {
  sim::ModelOptions small;
  small.geometry_depth = 64;
  small.feed_depth = 64;
  const auto engine = sim::make_model_engine(small);
  Noting bus(*engine);
  Card card = Card::open(bus);
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
    program.emplace_back(feed_of(512));
    program.emplace_back(line_of(512, i % 2 == 0 ? 7 : -3));
  }
  program.emplace_back(DwellCommand{1000});
  program.emplace_back(EndCommand{});
  stream.send(program);
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_EQ(engine->positions()[0], 150 * 7 - 150 * 3);
  EXPECT_EQ(stream.sent(), 602U);
  EXPECT_EQ(bus.words, words_of(program, 0));
  EXPECT_GT(looks, 0U);
  EXPECT_GE(begun, 298U) << "pieces and barriers, beyond 8 bits";
  EXPECT_GE(engine->cycles(), 300U * 512U * 16U + 1000U);
}

TEST(StreamOnModel, AStreamThatStarvesTheCardTimesOut) {
  sim::ModelOptions small;
  small.geometry_depth = 64;
  const auto engine = sim::make_model_engine(small);
  Card card = Card::open(*engine);
  StreamOptions options;
  options.patience = 10ms;
  Stream stream(card, options);
  EXPECT_THROW(stream.send(std::vector<Command>(100, line_of(10))), TimeoutError);
  EXPECT_LT(engine->cycles(), 20'000U);
}

// Each piece has its own time.
TEST(StreamOnModel, ManyPiecesAreNoTimeOut) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  StreamOptions options;
  options.patience = 1ms;
  Stream stream(card, options);
  for (int i = 0; i < 50; ++i) {
    stream.put(feed_of(1000));
    stream.put(line_of(1000, 1));
  }
  stream.put(EndCommand{});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_EQ(engine->positions()[0], 50);
  EXPECT_GE(engine->cycles(), 800'000U);
}

// 700 s each, beyond every constant: a dwell, a slow piece, and one at a sixteenth of the ratio.
TEST(StreamOnModel, LongCommandsAreNoTimeOuts) {
  sim::EngineOptions slow;
  slow.clock_hz = 10'000;
  const auto engine = sim::make_model_engine(slow);
  Card card = Card::open(*engine);
  StreamOptions options;
  options.patience = 10ms;
  options.poll_clocks = 5000;
  Stream stream(card, options);
  stream.send({DwellCommand{7'000'000}, EndCommand{}});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_GE(engine->cycles(), 7'000'000U);
  // 128 ticks at 2^46 / 2^64 a clock: 33.5 million clocks.
  stream.send({feed_of(128, std::uint64_t{1} << 46), line_of(128, 1), EndCommand{}});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_GE(engine->cycles(), 40'000'000U);
  card.set_ratio(Card::kFullRatio / 16);
  stream.send({feed_of(4, std::uint64_t{1} << 46), line_of(4, 1), EndCommand{}});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_GE(engine->cycles(), 56'000'000U);
  EXPECT_EQ(engine->positions()[0], 2);
}

// Slow for long, then fast: what was slow before counts as slow.
TEST(StreamOnModel, ARatioChangedInAPieceIsNoTimeOut) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  StreamOptions options;
  options.patience = 1ms;
  std::uint64_t looks = 0;
  options.progress = [&](const StreamProgress&) {
    if (++looks == 20'000) card.set_ratio(Card::kFullRatio);
  };
  card.set_ratio(Card::kFullRatio / 16);
  Stream stream(card, options);
  stream.send({feed_of(10'000), line_of(10'000, 10), EndCommand{}});  // 160,000 clocks at full ratio
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_GT(looks, 20'000U);
  EXPECT_GE(engine->cycles(), 20'000U * 64U);
  // Set by somebody else, and never told to this driver.
  engine->write(reg::kRatioFeed, Card::kFullRatio / 16);
  stream.send({feed_of(10'000), line_of(10'000, 10), EndCommand{}});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_EQ(card.ratio(), Card::kFullRatio / 16);
  EXPECT_EQ(engine->positions()[0], 20);
}

TEST(StreamOnModel, AFaultWhileWaitingEndsTheWait) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  Stream stream(card);
  stream.send({feed_of(100), line_of(99, 1), EndCommand{}});
  EXPECT_THROW(stream.finish(), FaultError);
  EXPECT_EQ(card.faults(), field::kFaultTickMismatch);
  EXPECT_THROW(stream.send(line_of(1)), FaultError) << "named, not only refused";
  EXPECT_THROW(stream.restart(), FaultError);
  EXPECT_EQ(card.stop_snapshot().geometry_begun, 1U);
  card.clear_faults();
  stream.restart();
  stream.send({feed_of(10), line_of(10, 1), EndCommand{}});
  stream.finish();
  EXPECT_EQ(engine->positions()[0], 2);
}

// Recovery in whichever order, with an abort or without: nothing of before the fault moves.
TEST(StreamOnModel, RecoversInWhicheverOrder) {
  for (int order = 0; order < 3; ++order) {
    const auto engine = sim::make_model_engine({});
    Card card = Card::open(*engine);
    Stream stream(card);
    stream.send({feed_of(200), line_of(199), EndCommand{}, feed_of(1024), line_of(1024, 100), EndCommand{}});
    engine->wait(5000);
    ASSERT_NE(card.faults(), 0U);
    if (order == 0) {
      card.abort();
    }
    card.clear_faults();
    if (order == 1) {
      card.abort();
    }
    engine->wait(10'000);
    EXPECT_EQ(engine->positions()[0], 0) << order;
    EXPECT_FALSE(card.busy());
    stream.restart();
    stream.send({feed_of(10), line_of(10, 1), EndCommand{}});
    EXPECT_TRUE(stream.finish().ended);
    EXPECT_EQ(engine->positions()[0], 1) << order;
  }
}

TEST_F(StreamOrder, HonoursTheCardsEngines) {
  bus_.values[reg::kEngines] = field::kEnginesLines;
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
}

// Changes one word of the stream on its way, as a bad cable would.
class Corrupting final : public Bus {
 public:
  Corrupting(Bus& bus, int word, std::uint32_t flip) : bus_(bus), left_(word), flip_(flip) {}
  std::size_t transfer(Access* accesses, std::size_t count) override {
    for (std::size_t i = 0; i < count; ++i) {
      if (accesses[i].write && accesses[i].address == reg::kStream && left_-- == 0) accesses[i].data ^= flip_;
    }
    return bus_.transfer(accesses, count);
  }
  void sleep(std::chrono::nanoseconds time) override { bus_.sleep(time); }
  bool reports_refusals() const override { return bus_.reports_refusals(); }

 private:
  Bus& bus_;
  int left_;
  std::uint32_t flip_;
};

TEST(StreamOnModel, ARefusedCommandIsDroppedWholeAndTheStreamRestarts) {
  for (const bool posted : {false, true}) {
    const auto engine = sim::make_model_engine({});
    PostedBus bridge(*engine);
    // The second line's increment gets a bit that is none of its 42.
    Corrupting bus(posted ? static_cast<Bus&>(bridge) : *engine, 4 + 3, 0x40000000);
    Card card = Card::open(bus);
    Stream stream(card);
    try {
      stream.send({line_of(10, 1), line_of(20, 2), line_of(30, 3)});
      FAIL();
    } catch (const RefusedError& error) {
      EXPECT_EQ(error.command_number(), 1);
      EXPECT_EQ(error.reason(), static_cast<std::uint8_t>(card_map::Reason::BadField));
    }
    EXPECT_THROW(stream.send(line_of(1)), StateError);
    stream.restart();
    EXPECT_EQ(stream.next_number(), 0);
    stream.send({feed_of(10), line_of(10, 1), EndCommand{}});
    EXPECT_TRUE(stream.finish().ended);
    EXPECT_EQ(engine->positions()[0], 1);
  }
}

TEST(StreamOnModel, ACardThatWasResetIsFoundWhileItIsFedAndAtTheEnd) {
  const std::vector<Command> program{feed_of(10'000), line_of(10'000, 10), feed_of(100), line_of(100, 1), EndCommand{}};
  for (const std::uint64_t clocks : {std::uint64_t{0}, std::uint64_t{1000}, std::uint64_t{165'000}}) {
    const auto engine = sim::make_model_engine({});
    Card card = Card::open(*engine);
    Stream stream(card);
    stream.send(program);
    engine->wait(clocks);
    engine->reset();
    EXPECT_THROW(stream.finish(), StateError) << clocks;
    EXPECT_THROW(stream.flush(), StateError);
    stream.restart();
    stream.send(program);
    EXPECT_TRUE(stream.finish().ended);
    EXPECT_EQ(engine->positions()[0], 11);
  }
  sim::ModelOptions small;
  small.geometry_depth = 64;
  const auto engine = sim::make_model_engine(small);
  Card card = Card::open(*engine);
  StreamOptions options;
  int looks = 0;
  options.progress = [&](const StreamProgress&) {
    if (++looks == 20) engine->reset();
  };
  Stream stream(card, options);
  std::vector<Command> many;
  for (int i = 0; i < 100; ++i) {
    many.emplace_back(feed_of(256));
    many.emplace_back(line_of(256, 1));
  }
  EXPECT_THROW(
      {
        stream.send(many);
        stream.finish();
      },
      Error);
  EXPECT_THROW(stream.flush(), StateError) << "closed";
}

TEST(StreamOnModel, AnAbortBySomebodyElseIsNoSuccess) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  Stream stream(card);
  stream.send({feed_of(10'000), line_of(10'000, 10), EndCommand{}});
  engine->wait(1000);
  engine->write(reg::kControl, field::kControlAbort);
  EXPECT_THROW(stream.finish(), StateError);
}

TEST(StreamOnModel, AnotherThreadHoldsGoesOnAndAborts) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  StreamOptions options;
  int held = 0;
  options.progress = [&](const StreamProgress& progress) {
    held += progress.status.held ? 1 : 0;
    if (held == 100) card.request_hold(false);
  };
  Stream stream(card, options);
  stream.send({feed_of(10'000), line_of(10'000, 10), EndCommand{}});
  std::thread([&card] { card.request_hold(true); }).join();
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_GE(held, 100);
  EXPECT_EQ(engine->positions()[0], 10);
  stream.send({feed_of(1'000'000'000), line_of(1'000'000'000, 10), EndCommand{}});
  std::thread other([&card] {
    std::this_thread::sleep_for(20ms);
    card.request_abort();
  });
  EXPECT_THROW(stream.finish(), StateError);
  other.join();
  engine->wait(100);
  EXPECT_FALSE(card.busy());
}

RC_GTEST_PROP(StreamProperty, AnyMatchedProgramArrivesInOrderAndWhole, ()) {
  sim::ModelOptions small;
  small.geometry_depth = *rc::gen::inRange<std::uint32_t>(37, 200);
  small.feed_depth = *rc::gen::inRange<std::uint32_t>(20, 200);
  const auto engine = sim::make_model_engine(small);
  Noting bus(*engine);
  Card card = Card::open(bus);
  Stream stream(card);
  std::vector<Command> program;
  std::int64_t position = 0;
  const auto lines = *rc::gen::container<std::vector<int>>(rc::gen::inRange(-50, 50));
  for (const int pulses : lines) {
    program.emplace_back(feed_of(64));
    program.emplace_back(line_of(64, pulses));
    position += pulses;
  }
  program.emplace_back(EndCommand{});
  const bool one_by_one = *rc::gen::arbitrary<bool>();
  for (const Command& command : program) {
    stream.put(command);
    if (one_by_one) stream.flush();
  }
  stream.finish();
  RC_ASSERT(engine->positions()[0] == position);
  RC_ASSERT(bus.words == words_of(program, 0));
}

// The clocks of a piece, as the model's card takes them.
TEST(FeedTime, IsWhatTheCardTakes) {
  const auto unit = [](double rate) { return static_cast<std::int64_t>(rate * 18446744073709551616.0); };
  const auto piece = [&](std::uint64_t ticks, double rate, double acceleration, double jerk, double floor) {
    FeedCommand feed;
    feed.ticks = ticks;
    feed.rate = static_cast<std::uint64_t>(unit(rate));
    feed.acceleration = unit(acceleration);
    feed.jerk = unit(jerk);
    feed.floor = static_cast<std::uint32_t>(floor * 4294967296.0);
    return feed;
  };
  for (const FeedCommand& feed :
       {piece(5000, 0.05, 0, 0, 1e-6), piece(5000, 0.001, 1e-5, 0, 1e-6), piece(5000, 0.05, -7e-6, 0, 1e-3),
        piece(5000, 0.05, -1.2e-5, 0, 1e-2), piece(5000, 0.001, 1e-6, 1e-9, 1e-6), piece(5000, 0.05, 0, -2e-9, 2e-3),
        piece(5000, 0.05, -1.5e-5, 2e-9, 1e-3)}) {
    const auto engine = sim::make_model_engine({});
    Card card = Card::open(*engine);
    Stream stream(card);
    stream.send({feed, line_of(5000, 1), EndCommand{}});
    const std::uint64_t begun = engine->cycles();
    const double forecast = feed_clocks(feed);
    engine->wait(static_cast<std::uint64_t>(forecast * 0.995) - 200);
    EXPECT_FALSE(card.status().ended) << forecast;
    engine->wait(static_cast<std::uint64_t>(forecast * 0.01) + 600);
    EXPECT_TRUE(card.status().ended) << forecast << " and not after " << engine->cycles() - begun;
  }
}

}  // namespace
}  // namespace trammel::driver
