#include "trammel/driver/feed_time.hpp"

#include <gtest/gtest.h>

#include "stream_commands.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {
namespace {

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
        piece(5000, 0.05, -1.41e-5, 2e-9, 1e-3)}) {
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
