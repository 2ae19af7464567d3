// Time-outs of the stream, on a stub that never completes its commands: states that suspend or stretch the time.
#include <gtest/gtest.h>

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "register_stub.hpp"
#include "stream_commands.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/stream.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using test::RegisterStub;
namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr auto kPoll = 100us;
constexpr auto kMargin = 10ms;

class StreamBudget : public ::testing::Test {
 protected:
  StreamBudget() {
    bus_.add_engines(card_map::engines::kClasses);
    bus_.values[reg::kRatioRapid] = bus_.values[reg::kRatioFixed] = Card::kFullRatio;
    bus_.values[reg::kGeometryRoom] = 4096;
    bus_.values[reg::kFeedRoom] = 2560;
    card_.emplace(Card::open(bus_));
    stream_.emplace(*card_, StreamOptions{100, kMargin, nullptr, false});
  }
  // Sends the commands; the card is then busy with the first piece.
  void begin(const std::vector<Command>& commands) {
    stream_->send(commands);
    bus_.values[reg::kStatus] = field::kStatusBusy;
    bus_.values[reg::kGeometryBegun] = bus_.values[reg::kFeedBegun] = 1;
    bus_.forget();
  }
  static FeedCommand rapid_of(std::uint64_t ticks) {
    FeedCommand feed = feed_of(ticks);
    feed.piece_class = PieceClass::kRapid;
    return feed;
  }

  RegisterStub bus_;
  std::optional<Card> card_;
  std::optional<Stream> stream_;
};

// Nobody knows when an input will change, so this wait does not count.
TEST_F(StreamBudget, AWaitForAnInputStopsTheTime) {
  begin({feed_of(1000), line_of(1000)});  // 16 ms
  bus_.next[reg::kStatus] = std::deque<std::uint32_t>(500, field::kStatusBusy | field::kStatusWaiting);
  EXPECT_THROW(stream_->finish(), TimeoutError);
  EXPECT_GE(bus_.slept, 500 * kPoll + 16ms + kMargin - kPoll);
  EXPECT_LE(bus_.slept, 500 * kPoll + 16ms + kMargin + 2 * kPoll);
}

// A ratio of 0 holds the pieces of its class. Their time begins when the ratio is above 0.
TEST_F(StreamBudget, AClassThatStandsIsWaitedForUntilItGoes) {
  card_->set_ratio(PieceClass::kRapid, 0);
  begin({feed_of(1000), rapid_of(1000), line_of(2000)});
  bus_.next[reg::kRatioRapid] = std::deque<std::uint32_t>(300, 0);
  bus_.values[reg::kRatioRapid] = Card::kFullRatio / 2;
  EXPECT_THROW(stream_->finish(), TimeoutError);
  EXPECT_EQ(card_->ratio(PieceClass::kRapid), Card::kFullRatio / 2) << "as the card has said";
  // The first piece and 300 looks; then the time of both pieces starts again, with the second piece at half its speed.
  constexpr auto kExpected = 16ms + 300 * kPoll + 16ms + 32ms + kMargin;
  EXPECT_GE(bus_.slept, kExpected - 2 * kPoll);
  EXPECT_LE(bus_.slept, kExpected + 3 * kPoll);
}

// The time is over, but the card reports a running piece: it was slower for a while, so its time starts again.
TEST_F(StreamBudget, APieceThatRunsIsAllowedItsTimeAgain) {
  begin({feed_of(1000), line_of(1000)});
  bus_.next[reg::kSnapRate] = {7, 7};
  bus_.values[reg::kSnapRatio] = Card::kFullRatio;
  EXPECT_THROW(stream_->finish(), TimeoutError);
  EXPECT_GE(bus_.slept, 3 * (16ms + kMargin));
  EXPECT_LE(bus_.slept, 3 * (16ms + kMargin) + 5 * kPoll);
  // A piece with a rate but a ratio of 0 gets no further time.
  bus_.next[reg::kSnapRate] = {7, 7};
  bus_.values[reg::kSnapRatio] = 0;
  bus_.forget();
  EXPECT_THROW(stream_->finish(), TimeoutError);
  EXPECT_LE(bus_.slept, 16ms + kMargin + 5 * kPoll);
}

// Two pieces at the lowest ratio. A piece counts for at most 4e18 clocks. The sum of the clocks wraps to 141,072 in 64
// bits.
TEST_F(StreamBudget, APieceThatTakesForEverIsNoTimeOut) {
  card_->set_ratio(1);
  FeedCommand endless = feed_of((std::uint64_t{1} << 40) - 1, 0);
  endless.floor = 1;
  constexpr std::uint64_t kWrap = std::uint64_t{1} << 48;  // 2^64, divided by 2^16 for the ratio
  constexpr std::uint64_t kRest = kWrap - 4'000'000'000'000'000'000 % kWrap;
  static_assert(kRest % 256 == 0);
  const FeedCommand rest = feed_of(kRest / 256, std::uint64_t{1} << 56);  // a tick every 256 clocks
  begin({endless, rest, line_of(1)});
  bus_.next[reg::kStatus] = std::deque<std::uint32_t>(3000, field::kStatusBusy);
  bus_.next[reg::kFeedBegun] = std::deque<std::uint32_t>(3000, 1);
  bus_.values[reg::kFeedBegun] = 2;
  bus_.values[reg::kStatus] = 0;
  EXPECT_FALSE(stream_->finish().busy);
  EXPECT_EQ(bus_.slept, 3001 * kPoll);
}

}  // namespace
}  // namespace trammel::driver
