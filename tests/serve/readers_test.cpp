// Clients without the token: they read while another client moves the card, and cannot write anything that moves it.
#include <gmock/gmock.h>

#include <optional>

#include "clients_fixture.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/driver/stream.hpp"

namespace trammel::serve {
namespace {

using namespace std::chrono_literals;
using test::ClientEnd;
using test::kClock;
using ::testing::HasSubstr;
using transport::StreamLink;
namespace reg = card_map::reg;

class ReadersTest : public test::ClientsTest {};

// Readers come before and after the client that moves the card. They take neither its place nor its requests.
TEST_F(ReadersTest, ReadersReadBesideWhoMovesTheCard) {
  start(settings());
  StreamLink early(opener(), StreamLink::Hello{});
  driver::FrameBus early_bus(early);
  driver::Card early_card = driver::Card::open(early_bus);
  StreamLink moving(opener(), StreamLink::Hello{"secret"});
  driver::FrameBus bus(moving);
  driver::Card card = driver::Card::open(bus);
  StreamLink late(opener(), std::nullopt);
  driver::FrameBus late_bus(late);
  driver::Card late_card = driver::Card::open(late_bus);
  EXPECT_TRUE(moving.may_move());
  EXPECT_THROW(late_card.set_hold(true), driver::RefusedError);
  for (int i = 1; i <= 20; ++i) {
    driver::run_line(card, driver::plan_line(card.timing(), {100}, 10ms));
    EXPECT_EQ(early_card.read_snapshot().position[0], 100 * i);
    EXPECT_EQ(late_card.read_snapshot().position[0], 100 * i);
    EXPECT_EQ(early_card.read_status().busy, false);
  }
  EXPECT_EQ(early.reconnections() + moving.reconnections() + late.reconnections(), 0U);
  EXPECT_EQ(server_->counts().holds, 0U);
}

// Without real time, only the client that moves the card advances the card's time. A reader's wait ends although that
// time does not advance.
TEST_F(ReadersTest, AReadersWaitDoesNotPassTheMoversTime) {
  start(settings());
  StreamLink moving(opener(), StreamLink::Hello{"secret"});
  driver::FrameBus bus(moving);
  driver::Card card = driver::Card::open(bus);
  StreamLink reading(opener(), StreamLink::Hello{});
  driver::FrameBus reading_bus(reading);
  const std::uint64_t before = engine_->cycles();
  const auto begun = std::chrono::steady_clock::now();
  reading.sleep(50ms);
  EXPECT_GE(std::chrono::steady_clock::now() - begun, 50ms);
  EXPECT_EQ(engine_->cycles(), before);
}

// A reader reconnects beside other clients, and sees that its card was not reset.
TEST_F(ReadersTest, AReaderThatWasCutReadsOn) {
  start(settings());
  std::optional<std::uint64_t> life = 3000;
  StreamLink cut(
      [&] {
        return std::make_unique<ClientEnd>(*server_, listener_, std::exchange(life, std::nullopt),
                                           ClientEnd::End::kCut);
      },
      StreamLink::Hello{});
  driver::FrameBus bus(cut);
  driver::Access magic = driver::read_of(reg::kMagic);
  StreamLink other(opener(), StreamLink::Hello{});
  driver::FrameBus other_bus(other);
  for (int i = 0; i < 200; ++i) {
    ASSERT_EQ(bus.transfer(&magic, 1), 1U);
    ASSERT_EQ(magic.data, card_map::kMagicValue);
  }
  EXPECT_EQ(cut.reconnections(), 1U);
}

TEST_F(ReadersTest, ManyReadersLeaveAPlaceForWhoMovesTheCard) {
  start(settings());
  std::vector<std::unique_ptr<StreamLink>> readers;
  for (int i = 0; i < 8; ++i) readers.push_back(std::make_unique<StreamLink>(opener(), StreamLink::Hello{}));
  EXPECT_THAT(link_error(""), HasSubstr("as many clients read as the server takes"));
  const StreamLink moving(opener(), StreamLink::Hello{"secret"});
  EXPECT_TRUE(moving.may_move());
}

TEST_F(ReadersTest, WithoutTheTokenNothingIsWrittenThatMoves) {
  start(settings());
  for (const bool hello : {true, false}) {
    StreamLink link(opener(), hello ? std::optional(StreamLink::Hello{}) : std::nullopt);
    driver::FrameBus bus(link);
    driver::Card card = driver::Card::open(bus);
    EXPECT_EQ(link.may_move(), !hello) << "who says no hello is not told";
    EXPECT_EQ(card.read_snapshot().position[0], 0);
    EXPECT_FALSE(card.refusal());
    card.clear_refusal();
    EXPECT_THROW(driver::Stream{card}, driver::RefusedError);
    EXPECT_THROW(card.set_hold(true), driver::RefusedError);
    EXPECT_THROW(card.abort(), driver::RefusedError);
    EXPECT_THROW(card.configure_axis(0, {}), driver::RefusedError);
    EXPECT_THROW(driver::run_line(card, driver::plan_line(card.timing(), {100}, 10ms)), driver::RefusedError);
    // Every register, for every value.
    for (std::uint32_t address = 0; address < card_map::kWindowBytes; address += 4) {
      if (address == reg::kRefusal) continue;
      const bool control = address == reg::kControl;
      driver::Access access = driver::write_of(address, control ? card_map::field::kControlAbort : 1);
      ASSERT_EQ(bus.transfer(&access, 1), 0U) << address;
    }
  }
  engine_->wait(kClock);
  EXPECT_EQ(engine_->positions()[0], 0);
  EXPECT_EQ(engine_->read(reg::kHold), 0U) << "who cannot move leaves nothing behind";
  EXPECT_EQ(engine_->read(reg::kSlew), 0xFFFFFFFU);
}

}  // namespace
}  // namespace trammel::serve
