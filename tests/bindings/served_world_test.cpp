// trammel_machine.h with the simulated machine of a served card.
#include <gmock/gmock.h>

#include <atomic>
#include <string>
#include <thread>

#include "trammel/serve/card_server.hpp"
#include "trammel/transport/byte_stream.hpp"
#include "trammel/world/engine_in_world.hpp"
#include "trammel/world/world_file.hpp"
#include "trammel_machine.h"

namespace {

using namespace trammel;
using ::testing::HasSubstr;

constexpr std::uint32_t kClock = 1'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;

// Runs a server in a second thread.
class ServedWorldTest : public ::testing::Test {
 protected:
  ServedWorldTest() {
    serve::Settings settings;
    settings.token = "secret";
    settings.clock_hz = kClock;
    settings.real_time = false;
    settings.world = &world_;
    settings.path = [](bool) { return world::PathCount{}; };
    server_ = std::make_unique<serve::CardServer>(engine_, *listener_, settings);
    thread_ = std::thread([this] {
      while (!ended_) server_->turn();
    });
  }
  ~ServedWorldTest() override {
    ended_ = true;
    thread_.join();
  }
  std::string url(const char* token) const { return listener_->url() + token; }

  world::World world_{world::default_world(), kClock};
  world::EngineInWorld engine_{sim::make_model_engine(sim::EngineOptions{4, kClock, false}), world_};
  std::unique_ptr<transport::Listener> listener_ = transport::listen_tcp("127.0.0.1", 0);
  std::unique_ptr<serve::CardServer> server_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

TEST_F(ServedWorldTest, IsReadAndPressedWhileTheCardMoves) {
  trammel_card* card = nullptr;
  trammel_world* world = nullptr;
  trammel_world_state state{};
  ASSERT_EQ(trammel_open(url("?token=secret").c_str(), &card), TRAMMEL_OK) << trammel_last_error()->text;
  ASSERT_EQ(trammel_open_world(url("?token=secret").c_str(), &world), TRAMMEL_OK) << trammel_last_error()->text;
  ASSERT_EQ(trammel_read_world(world, &state), TRAMMEL_OK) << trammel_last_error()->text;
  EXPECT_EQ(state.axis_count, 4U);
  EXPECT_EQ(state.axes[1].letter, 'Y');
  trammel_one_shot line{};
  line.pulses[0] = 4000;
  line.duration_ns = 2 * kSecond;
  ASSERT_EQ(trammel_start_line(card, &line, nullptr), TRAMMEL_OK);
  ASSERT_EQ(trammel_press(world, "estop", nullptr, 10 * kSecond, &state), TRAMMEL_OK) << trammel_last_error()->text;
  EXPECT_TRUE(state.emergency_stop);
  EXPECT_EQ(trammel_wait_until_idle(card, 10 * kSecond), TRAMMEL_FAULT);
  EXPECT_THAT(trammel_last_error()->text, HasSubstr("EMERGENCY_STOP"));
  ASSERT_EQ(trammel_release(world, "estop", nullptr, 10 * kSecond, &state), TRAMMEL_OK);
  EXPECT_FALSE(state.emergency_stop);
  trammel_close_world(world);
  trammel_close(card);
}

TEST_F(ServedWorldTest, ErrorsAreTheServers) {
  trammel_world* world = nullptr;
  ASSERT_EQ(trammel_open_world(url("").c_str(), &world), TRAMMEL_OK);
  EXPECT_EQ(trammel_press(world, "estop", nullptr, kSecond, nullptr), TRAMMEL_ARGUMENT);
  EXPECT_THAT(trammel_last_error()->text, HasSubstr("token"));
  trammel_close_world(world);
  EXPECT_EQ(trammel_open_world(url("?token=wrong").c_str(), &world), TRAMMEL_LINK);
  EXPECT_EQ(world, nullptr);
  ASSERT_EQ(trammel_open_world(url("?token=secret").c_str(), &world), TRAMMEL_OK);
  EXPECT_EQ(trammel_press(world, "nothing", nullptr, kSecond, nullptr), TRAMMEL_ARGUMENT);
  EXPECT_THAT(trammel_last_error()->text, HasSubstr("no such button: "));
  EXPECT_EQ(trammel_press(world, "estop", "X > 40", kSecond / 10, nullptr), TRAMMEL_LINK) << "it never comes";
  trammel_close_world(world);
}

}  // namespace
