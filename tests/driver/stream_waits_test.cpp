// Waits of the stream on the golden model: their durations and the events that end them.
#include <gtest/gtest.h>

#include "stream_commands.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
namespace reg = card_map::reg;
namespace field = card_map::field;

TEST(StreamWaits, AStreamThatStarvesTheCardTimesOut) {
  sim::ModelOptions small;
  small.geometry_depth = 64;
  const auto engine = sim::make_model_engine(small);
  Card card = Card::open(*engine);
  StreamOptions options;
  options.margin = 10ms;
  Stream stream(card, options);
  EXPECT_THROW(stream.send(std::vector<Command>(100, line_of(10))), TimeoutError);
  EXPECT_LT(engine->cycles(), 20'000U);
}

// The time-out covers each piece by itself.
TEST(StreamWaits, ManyPiecesAreNoTimeOut) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  StreamOptions options;
  options.margin = 1ms;
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

// Commands of 700 s or more, beyond every constant: a dwell, a slow piece, and a piece at 1/16 of the ratio.
TEST(StreamWaits, LongCommandsAreNoTimeOuts) {
  sim::EngineOptions slow;
  slow.clock_hz = 10'000;
  const auto engine = sim::make_model_engine(slow);
  Card card = Card::open(*engine);
  StreamOptions options;
  options.margin = 10ms;
  options.poll_clocks = 5000;
  Stream stream(card, options);
  stream.send({DwellCommand{7'000'000}, EndCommand{}});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_GE(engine->cycles(), 7'000'000U);
  // 128 ticks at 2^46 / 2^64 ticks per clock take 33.5 million clocks.
  stream.send({feed_of(128, std::uint64_t{1} << 46), line_of(128, 1), EndCommand{}});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_GE(engine->cycles(), 40'000'000U);
  card.set_ratio(Card::kFullRatio / 16);
  stream.send({feed_of(4, std::uint64_t{1} << 46), line_of(4, 1), EndCommand{}});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_GE(engine->cycles(), 56'000'000U);
  EXPECT_EQ(engine->positions()[0], 2);
}

// A rapid piece at 1/16 of its ratio, among feed pieces at the full ratio.
TEST(StreamWaits, ASlowClassIsNoTimeOut) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  StreamOptions options;
  options.margin = 1ms;
  card.set_ratio(PieceClass::kRapid, Card::kFullRatio / 16);
  Stream stream(card, options);
  FeedCommand rapid = feed_of(1000);
  rapid.piece_class = PieceClass::kRapid;
  stream.send({rapid, line_of(1000, 10), feed_of(1000), line_of(1000, 10), EndCommand{}});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_GE(engine->cycles(), 17U * 16'000U);
  EXPECT_LE(engine->cycles(), 17U * 16'000U + 2000U);
  EXPECT_EQ(engine->positions()[0], 20);
}

// wait_until_idle() does not know which piece runs. Therefore the ratio of the slowest class counts, except a ratio of
// 0, which is a hold.
TEST(StreamWaits, AWaitForTheEndIsStretchedByTheSlowestClass) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  card.set_ratio(PieceClass::kRapid, Card::kFullRatio / 16);
  card.set_ratio(PieceClass::kFixed, 0);
  Stream stream(card);
  FeedCommand rapid = feed_of(1000);
  rapid.piece_class = PieceClass::kRapid;
  stream.send({rapid, line_of(1000, 10)});
  card.wait_until_idle(20ms);  // 16 ms at the full ratio
  EXPECT_GE(engine->cycles(), 16U * 16'000U);
  stream.send({rapid, line_of(1000, 10)});
  EXPECT_THROW(card.wait_until_idle(5ms), TimeoutError);
}

// A bus that counts the driver's transfers and the ways in which its pauses end.
class Counting final : public Bus {
 public:
  explicit Counting(Bus& bus) : bus_(bus) {}
  std::size_t transfer(Access* accesses, std::size_t count) override {
    ++transfers;
    return bus_.transfer(accesses, count);
  }
  void sleep(std::chrono::nanoseconds time) override {
    ++sleeps;
    bus_.sleep(time);
  }
  bool reports_refusals() const override { return bus_.reports_refusals(); }
  bool has_interrupt() const override { return bus_.has_interrupt(); }
  bool wait_for_interrupt(std::chrono::nanoseconds longest) override {
    const bool raised = bus_.wait_for_interrupt(longest);
    ++(raised ? interrupts : late);
    return raised;
  }

  std::uint64_t transfers = 0;
  std::uint64_t sleeps = 0;
  std::uint64_t interrupts = 0;
  std::uint64_t late = 0;

 private:
  Bus& bus_;
};

// Only a few of these long commands fit into the queues. The watermarks' interrupt ends every wait for room, before its
// time has passed.
TEST(StreamWaits, AWatermarkEndsAWaitForRoom) {
  for (const bool watermarks : {true, false}) {
    sim::ModelOptions small;
    small.interrupt = true;
    small.geometry_depth = 64;
    small.feed_depth = 64;
    if (!watermarks) small.engines = card_map::engines::kLines | card_map::engines::kJerk;
    const auto engine = sim::make_model_engine(small);
    Counting bus(*engine);
    Card card = Card::open(bus);
    Stream stream(card);
    for (int i = 0; i < 40; ++i) {
      stream.put(feed_of(500));
      stream.put(line_of(500, 5));
    }
    EXPECT_EQ(bus.late == 0, watermarks);
    if (watermarks) {
      EXPECT_GE(bus.interrupts, 15U);
      EXPECT_EQ(bus.sleeps, 0U);
    }
    stream.put(EndCommand{});
    EXPECT_TRUE(stream.finish().ended);
    EXPECT_EQ(engine->positions()[0], 200);
    // 40 pieces of 8,000 clocks, without further waits.
    EXPECT_GE(engine->cycles(), 320'000U);
    EXPECT_LE(engine->cycles(), 323'000U);
  }
}

// A request for the ratio of a class, which may come from another thread, takes effect at the stream's next look.
TEST(StreamWaits, ARatioIsAskedForFromElsewhere) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  StreamOptions options;
  options.progress = [&card](const StreamProgress&) { card.request_ratio(PieceClass::kRapid, Card::kFullRatio / 8); };
  Stream stream(card, options);
  FeedCommand rapid = feed_of(1000);
  rapid.piece_class = PieceClass::kRapid;
  stream.send({rapid, line_of(1000, 10), EndCommand{}});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_EQ(card.ratio(PieceClass::kRapid), Card::kFullRatio / 8);
  EXPECT_EQ(card.ratio(), Card::kFullRatio);
  EXPECT_GE(engine->cycles(), 100'000U);
}

// A piece is slow for a long time, then fast. The slow time counts as slow.
TEST(StreamWaits, ARatioChangedInAPieceIsNoTimeOut) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  StreamOptions options;
  options.margin = 1ms;
  std::uint64_t looks = 0;
  options.progress = [&](const StreamProgress&) {
    if (++looks == 8'000) card.set_ratio(Card::kFullRatio);
  };
  card.set_ratio(Card::kFullRatio / 16);
  Stream stream(card, options);
  stream.send({feed_of(10'000), line_of(10'000, 10), EndCommand{}});  // 160,000 clocks at full ratio
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_GT(looks, 8'000U);
  EXPECT_GE(engine->cycles(), 8'000U * 64U);  // 512,000: more than the clocks of the line and the margin together
  // Another program sets the ratio, without the knowledge of this driver.
  engine->write(reg::kRatioFeed, Card::kFullRatio / 16);
  stream.send({feed_of(10'000), line_of(10'000, 10), EndCommand{}});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_EQ(card.ratio(), Card::kFullRatio / 16);
  EXPECT_EQ(engine->positions()[0], 20);
}

// Another program changes the ratio between two reads of the driver.
TEST(StreamWaits, ARatioThatWasLowerForAWhileIsNoTimeOut) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  StreamOptions options;
  options.margin = 1ms;
  bool lower = false;
  options.progress = [&](const StreamProgress&) {
    if (lower == (engine->cycles() < 200'000)) return;
    lower = !lower;
    engine->write(reg::kRatioFeed, Card::kFullRatio / (lower ? 16 : 1));
  };
  Stream stream(card, options);
  stream.send({feed_of(10'000), line_of(10'000, 10), EndCommand{}});  // 160,000 clocks at full ratio, here 347,500
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_GT(engine->cycles(), 300'000U);
  EXPECT_EQ(engine->positions()[0], 10);
}

}  // namespace
}  // namespace trammel::driver
