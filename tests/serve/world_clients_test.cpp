// Clients of the world (the machine behind the card), together with the client that moves the card.
#include <gmock/gmock.h>

#include <optional>

#include "clients_fixture.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/transport/served_world.hpp"
#include "trammel/world/engine_in_world.hpp"
#include "trammel/world/world_file.hpp"

namespace trammel::serve {
namespace {

using namespace std::chrono_literals;
using test::ClientEnd;
using test::kClock;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;
using transport::ServedWorld;
using transport::StreamLink;

class WorldClientsTest : public test::ClientsTest {
 protected:
  WorldClientsTest() {
    engine_ = std::make_unique<world::EngineInWorld>(std::move(engine_), world_);
    Settings settings = ClientsTest::settings();
    settings.world = &world_;
    settings.path = [this](bool anew) {
      if (anew) counted_from_ = 3;
      return world::PathCount{counted_from_, "id"};
    };
    start(settings);
  }
  std::unique_ptr<ServedWorld> at_world(const std::string& token = "secret") {
    return std::make_unique<ServedWorld>(std::make_unique<ClientEnd>(*server_, listener_), token);
  }
  template <class Error>
  static std::string error_of(const std::function<void()>& call) {
    try {
      call();
    } catch (const Error& error) {
      return error.what();
    }
    return "none";
  }

  world::World world_{world::default_world(), kClock};
  std::uint64_t counted_from_ = 10;
};

TEST_F(WorldClientsTest, ReadTheMachineAndPressItsButtons) {
  const auto client = at_world();
  EXPECT_THAT(client->request("state"), AllOf(HasSubstr(R"("pressed":[])"), HasSubstr(R"("path":{"steps":10)")));
  EXPECT_THAT(client->request("press estop"), HasSubstr(R"("pressed":["estop"])"));
  EXPECT_TRUE(world_.pressed("estop"));
  EXPECT_TRUE(world_.emergency_stop());
  EXPECT_THAT(notes_, HasSubstr("has pressed estop"));
  EXPECT_THAT(client->request("release estop"), HasSubstr(R"("pressed":[])"));
  EXPECT_FALSE(world_.pressed("estop"));
  EXPECT_THAT(client->request("count"), HasSubstr(R"("path":{"steps":3)"));
}

// By then the contact has settled, also when no other client advances the card's time.
TEST_F(WorldClientsTest, APressIsAnsweredTwentyMillisecondsOfTheCardLater) {
  const auto client = at_world();
  const std::uint64_t before = engine_->cycles();
  client->request("press feed_hold");
  EXPECT_GE(engine_->cycles() - before, kClock / 50);
  EXPECT_LE(engine_->cycles() - before, kClock / 50 + 100);
  const std::uint64_t after = engine_->cycles();
  client->request("state");
  EXPECT_LE(engine_->cycles() - after, 100U) << "a look takes no time but the server's own";
}

TEST_F(WorldClientsTest, WithoutTheTokenTheyLookAlone) {
  const auto reader = at_world("");
  EXPECT_THAT(reader->request("state"), StartsWith(R"({"time_s":)"));
  EXPECT_THAT(error_of<driver::ArgumentError>([&] { reader->request("press estop"); }), HasSubstr("token"));
  EXPECT_THAT(error_of<driver::ArgumentError>([&] { reader->request("count"); }), HasSubstr("token"));
  EXPECT_FALSE(world_.pressed("estop"));
  EXPECT_EQ(counted_from_, 10U);
  EXPECT_THAT(error_of<driver::LinkError>([&] { at_world("guess"); }), HasSubstr("refused: wrong token"));
}

TEST_F(WorldClientsTest, WhatIsNoRequestIsNamedAndTheNextOneIsTaken) {
  const auto client = at_world();
  EXPECT_THAT(error_of<driver::ArgumentError>([&] { client->request("press stop"); }),
              HasSubstr("stop: no such button: feed_hold, cycle_start, estop"));
  EXPECT_THAT(error_of<driver::ArgumentError>([&] { client->request("press\nestop"); }), HasSubstr("one line"));
  EXPECT_THAT(client->request("state"), StartsWith("{"));
}

// The answers and the motion are the same as for one client alone.
TEST_F(WorldClientsTest, BesideTheOneThatMovesTheCard) {
  StreamLink moving(opener(), StreamLink::Hello{"secret"});
  driver::FrameBus bus(moving);
  driver::Card card = driver::Card::open(bus);
  const auto client = at_world();
  for (int i = 1; i <= 20; ++i) {
    driver::run_line(card, driver::plan_line(card.timing(), {100}, 10ms));
    EXPECT_THAT(client->request("state"), HasSubstr("\"commanded\":" + std::to_string(100 * i)));
    EXPECT_EQ(card.read_snapshot().position[0], 100 * i);
  }
  EXPECT_TRUE(moving.may_move());
  EXPECT_EQ(moving.reconnections(), 0U);
  EXPECT_EQ(server_->counts().holds, 0U);
  client->request("press estop");
  EXPECT_TRUE(card.read_status().faulted);
}

TEST_F(WorldClientsTest, APressWaitsForItsPlace) {
  StreamLink moving(opener(), StreamLink::Hello{"secret"});
  driver::FrameBus bus(moving);
  driver::Card card = driver::Card::open(bus);
  ClientEnd client(*server_, listener_);
  const std::string text = "trammel 1 at world secret\npress feed_hold when X > 5\n";
  client.write(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  driver::run_line(card, driver::plan_line(card.timing(), {390}, 200ms));
  EXPECT_FALSE(world_.pressed("feed_hold"));
  driver::run_line(card, driver::plan_line(card.timing(), {20}, 20ms));
  for (int i = 0; i < 5; ++i) server_->turn();
  EXPECT_TRUE(world_.pressed("feed_hold"));
}

TEST_F(WorldClientsTest, WhoGoesPressesNothingAnyMore) {
  {
    ClientEnd client(*server_, listener_);
    const std::string text = "trammel 1 at world secret\npress feed_hold when steps < 5\n";
    client.write(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    for (int i = 0; i < 3; ++i) server_->turn();
  }
  server_->turn();
  counted_from_ = 1;
  for (int i = 0; i < 5; ++i) server_->turn();
  EXPECT_FALSE(world_.pressed("feed_hold"));
  EXPECT_TRUE(at_world()->request("state").size() > 0);
}

TEST_F(WorldClientsTest, RubbishAndCrowdsAreSentAway) {
  EXPECT_THAT(answer_to("trammel 1 at world secret\n" + std::string(300, 'x')), "trammel 1 world\n");
  EXPECT_THAT(notes_, HasSubstr("at the machine refused: a request is one line"));
  EXPECT_THAT(answer_to("trammel 1 at worlds\n"), HasSubstr("refused: wrong token"));
  EXPECT_THAT(answer_to("trammel 1 at world secret\nstate\nstate\n"),
              AllOf(StartsWith("trammel 1 world\nok {"), Not(HasSubstr("no: "))));
  std::vector<std::unique_ptr<ServedWorld>> clients;
  for (int i = 0; i < 8; ++i) clients.push_back(at_world());
  EXPECT_THAT(error_of<driver::LinkError>([&] { at_world(); }), HasSubstr("as many clients are at the machine"));
  clients.pop_back();
  EXPECT_THAT(at_world()->request("state"), StartsWith("{"));
  // Clients of the world do not use up the places for readers.
  const StreamLink reading(opener(), StreamLink::Hello{});
  EXPECT_FALSE(reading.may_move());
}

TEST_F(WorldClientsTest, OneThatMovedTheCardLeavesItInAHold) {
  ClientEnd client(*server_, listener_);
  const std::string text = "trammel 1 secret\ntrammel 1 at world\n";
  client.write(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  for (int i = 0; i < 3; ++i) server_->turn();
  EXPECT_EQ(server_->counts().holds, 1U);
}

using NoWorldTest = test::ClientsTest;

TEST_F(NoWorldTest, ACardWithoutAMachineSaysSo) {
  start(settings());
  EXPECT_THAT(answer_to("trammel 1 at world secret\n"),
              MatchesRegex("trammel 1 refused: this card has no machine behind its pins.*\n"));
  const StreamLink moving(opener(), StreamLink::Hello{"secret"});
  EXPECT_TRUE(moving.may_move());
}

}  // namespace
}  // namespace trammel::serve
