#include "trammel/driver/feed_time.hpp"

#include <gtest/gtest.h>

#include "stream_commands.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {
namespace {

// The driver's clocks of a piece equal those that the model takes.
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
        piece(5000, 0.05, -1.41e-5, 2e-9, 1e-3)}) {
    const auto engine = sim::make_model_engine({});
    Card card = Card::open(*engine);
    Stream stream(card);
    stream.send({feed, line_of(5000, 1), EndCommand{}});
    const std::uint64_t begun = engine->cycles();
    const double forecast = feed_clocks(feed);
    engine->wait(static_cast<std::uint64_t>(forecast * 0.995) - 200);
    EXPECT_FALSE(card.read_status().ended) << forecast;
    engine->wait(static_cast<std::uint64_t>(forecast * 0.01) + 600);
    EXPECT_TRUE(card.read_status().ended) << forecast << " and not after " << engine->cycles() - begun;
  }
}

// Computed by hand: at constant jerk, rate r falls to 0 after k updates, with k (k - 1) = 2 r / jerk. The feed has then
// made 2/3 of the ticks that k updates at rate r would make.
TEST(FeedTime, KnowsWhereAPieceWouldReverse) {
  const auto unit = [](double rate) { return static_cast<std::int64_t>(rate * 18446744073709551616.0); };
  FeedCommand feed;
  feed.rate = static_cast<std::uint64_t>(unit(0.1));
  feed.jerk = unit(-2e-7);  // 0 after 1000.5 updates, with 32 * 1000 * 0.1 * 2 / 3 ticks
  feed.ticks = 2130;
  EXPECT_FALSE(ticks_to_reversal(feed));
  feed.ticks = 2160;
  ASSERT_TRUE(ticks_to_reversal(feed));
  EXPECT_NEAR(*ticks_to_reversal(feed), 2134, 4);
  // The acceleration delays the reversal beyond the end.
  feed.acceleration = unit(1e-4);
  EXPECT_FALSE(ticks_to_reversal(feed));
  // The rate falls below 0 before the jerk raises it again.
  feed.acceleration = unit(-4e-4);
  feed.jerk = unit(7e-7);
  feed.ticks = 700;
  EXPECT_TRUE(ticks_to_reversal(feed));
  feed.jerk = unit(9e-7);  // lowest rate: 0.1 - 4e-4^2 / (2 * 9e-7) > 0
  EXPECT_FALSE(ticks_to_reversal(feed));
  // Without jerk: a falling rate, a rising rate, a constant rate.
  feed = FeedCommand{10'000, static_cast<std::uint64_t>(unit(0.1)), unit(-1e-4), 0};
  EXPECT_NEAR(ticks_to_reversal(feed).value_or(0), 1602, 2);
  feed.acceleration = unit(1e-4);
  EXPECT_FALSE(ticks_to_reversal(feed));
  feed.acceleration = 0;
  EXPECT_FALSE(ticks_to_reversal(feed));
}

TEST(FeedTime, TheStreamRefusesAJerkThatWouldReverseTheFeed) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  Stream stream(card);
  FeedCommand feed = feed_of(20'000);
  feed.jerk = -(std::int64_t{1} << 40);
  feed.floor = 1U << 28;
  const std::vector<Command> program{feed_of(100), line_of(100, 10), feed, line_of(20'000, 10)};
  try {
    stream.send(program);
    ADD_FAILURE() << "it would stand after some hundred updates";
  } catch (const ArgumentError& error) {
    EXPECT_NE(std::string(error.what()).find("FEED: acceleration and jerk would reverse the feed after "),
              std::string::npos)
        << error.what();
  }
  EXPECT_EQ(stream.sent(), 0U) << "all are checked before the first is written";
  stream.send({feed_of(100), line_of(100, 10), EndCommand{}});
  EXPECT_TRUE(stream.finish().ended);
}

}  // namespace
}  // namespace trammel::driver
