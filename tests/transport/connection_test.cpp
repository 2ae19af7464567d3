// `sim:` works like other URLs: a connection on which a card is opened.
#include "trammel/transport/connection.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "trammel/driver/card.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::transport {
namespace {

using namespace std::chrono_literals;

TEST(Connection, OpensASimulatedCardThatMoves) {
  Connection connection(parse_card_url("sim:?axes=3&clock=2000000"));
  driver::Card card = driver::Card::open(connection.bus());
  EXPECT_EQ(card.identification().axes, 3U);
  EXPECT_EQ(card.identification().clock_hz, 2'000'000U);
  EXPECT_TRUE(connection.may_move());
  EXPECT_EQ(connection.frames(), nullptr);
  ASSERT_NE(connection.engine(), nullptr);
  EXPECT_EQ(connection.engine(), &connection.bus());
  driver::run_line(card, driver::plan_line(card.timing(), {20, -40}, 1ms));
  EXPECT_EQ(card.read_snapshot().position[0], 20);
  EXPECT_EQ(connection.engine()->positions(), (std::vector<std::int64_t>{20, -40, 0}));
}

TEST(Connection, RefusesASimulatedCardThatCannotBe) {
  CardUrl url;
  url.axes = 9;
  EXPECT_THROW(Connection{url}, std::invalid_argument);
}

}  // namespace
}  // namespace trammel::transport
