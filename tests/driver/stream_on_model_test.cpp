// The stream on the golden model: whole programs, holds, faults, other threads.
#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <thread>

#include "posted_bus.hpp"
#include "stream_commands.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using test::PostedBus;
namespace reg = card_map::reg;
namespace field = card_map::field;

// A bus that records the words of the stream on their way to the model.
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

TEST(StreamOnModel, OutputsAndMarksAtTheirPlaceOnThePath) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  card.set_output_safe(0b0010, 0b0010);
  card.set_input_polarity(0b0001);
  engine->set_inputs(0b1001);
  engine->wait(10);
  EXPECT_EQ(card.read_inputs(), 0b1000);
  Stream stream(card);  // opening it aborts, which sets the outputs to their safe levels
  EXPECT_EQ(card.read_outputs(), 0b0010);
  LineCommand line;
  line.ticks = 100;
  line.mask = 1;
  line.increment[0] = std::int64_t{1} << 38;
  FeedCommand feed;
  feed.ticks = 200;
  feed.rate = std::uint64_t{1} << 62;
  feed.floor = 1;
  stream.send({line, OutputCommand{0b0101, 0b0010}, MarkCommand{}, line, feed, MarkCommand{}});
  stream.finish();
  EXPECT_EQ(card.read_outputs(), 0b0101);
  EXPECT_EQ(card.read_marks(), 2U);
  EXPECT_EQ(card.read_mark_snapshot().geometry_begun, 2U);
  sim::ModelOptions without;
  without.engines = 0x33;
  const auto other = sim::make_model_engine(without);
  Card plain = Card::open(*other);
  EXPECT_THROW(plain.read_outputs(), ArgumentError);
  EXPECT_THROW(plain.set_output_safe(0, 0), ArgumentError);
  Stream closed(plain);
  EXPECT_THROW(closed.send(MarkCommand{}), ArgumentError);
  EXPECT_THROW(closed.send(WaitInputCommand{}), ArgumentError);
  EXPECT_THROW(closed.send(ProbeCommand{}), ArgumentError);
  EXPECT_THROW(closed.send(ProbeEndCommand{}), ArgumentError);
}

TEST(StreamOnModel, AFaultWhileWaitingEndsTheWait) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  Stream stream(card);
  stream.send({feed_of(100), line_of(99, 1), EndCommand{}});
  EXPECT_THROW(stream.finish(), FaultError);
  EXPECT_EQ(card.read_faults(), field::kFaultTickMismatch);
  EXPECT_THROW(stream.send(line_of(1)), FaultError) << "named, not only refused";
  EXPECT_THROW(stream.restart(), FaultError);
  EXPECT_EQ(card.read_stop_snapshot().geometry_begun, 1U);
  card.clear_faults();
  stream.restart();
  stream.send({feed_of(10), line_of(10, 1), EndCommand{}});
  stream.finish();
  EXPECT_EQ(engine->positions()[0], 2);
}

// Recovery in any order, with an abort or without: no command from before the fault moves the card.
TEST(StreamOnModel, RecoversInWhicheverOrder) {
  for (int order = 0; order < 3; ++order) {
    const auto engine = sim::make_model_engine({});
    Card card = Card::open(*engine);
    Stream stream(card);
    stream.send({feed_of(200), line_of(199), EndCommand{}, feed_of(1024), line_of(1024, 100), EndCommand{}});
    engine->wait(5000);
    ASSERT_NE(card.read_faults(), 0U);
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

// Changes one word of the stream in transit, as a bad cable would.
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
    // Sets a bit above the 42 bits of the second line's increment.
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
  small.geometry_depth = *rc::gen::inRange<std::uint32_t>(38, 200);
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

}  // namespace
}  // namespace trammel::driver
