// The right to move the card on a pseudo-terminal. The clients open the terminal themselves, and the server takes its
// turns only while a client waits, so the order of events is the same on every machine.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <chrono>

#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/serve/card_server.hpp"
#include "trammel/sim/engine.hpp"
#include "trammel/transport/links.hpp"

namespace trammel::serve {
namespace {

using namespace std::chrono_literals;
using transport::StreamLink;
namespace reg = card_map::reg;

class TerminalClient final : public transport::ByteStream {
 public:
  TerminalClient(const std::string& terminal, CardServer& server)
      : file_(::open(terminal.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK)), server_(server) {
    if (file_ < 0) throw driver::LinkError("no terminal " + terminal);
  }
  ~TerminalClient() override { ::close(file_); }
  TerminalClient(const TerminalClient&) = delete;
  TerminalClient& operator=(const TerminalClient&) = delete;
  void write(const std::uint8_t* bytes, std::size_t count) override {
    ASSERT_EQ(::write(file_, bytes, count), static_cast<ssize_t>(count));
  }
  std::size_t read(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override {
    const auto until = std::chrono::steady_clock::now() + longest;
    do {
      server_.turn();
      const ssize_t count = ::read(file_, bytes, room);
      if (count > 0) return static_cast<std::size_t>(count);
    } while (std::chrono::steady_clock::now() < until);
    return 0;
  }
  std::string peer() const override { return "terminal"; }

 private:
  int file_;
  CardServer& server_;
};

class TerminalTest : public ::testing::Test {
 protected:
  static Settings settings() {
    Settings settings;
    settings.token = "secret";
    settings.clock_hz = 1'000'000;
    settings.real_time = false;
    return settings;
  }
  StreamLink::Open opener() {
    return [this] { return std::make_unique<TerminalClient>(name_, server_); };
  }
  static std::size_t write(driver::Bus& bus, std::uint32_t value) {
    driver::Access access = driver::write_of(reg::kHoldLimit, value);
    return bus.transfer(&access, 1);
  }

  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine(sim::EngineOptions{4, 1'000'000, false});
  std::unique_ptr<transport::Listener> listener_ = transport::open_pseudo_terminal();
  std::string name_ = listener_->url().substr(std::string("serial:").size());
  CardServer server_{*engine_, *listener_, settings()};
};

// The next client opens the terminal before the server has noticed the close. It gets no rights, also without a hello.
TEST_F(TerminalTest, RightsEndWithTheClose) {
  {
    StreamLink owner(opener(), StreamLink::Hello{"secret"});
    driver::FrameBus bus(owner);
    EXPECT_EQ(write(bus, 7), 1U);
  }
  StreamLink next(opener(), std::nullopt);
  driver::FrameBus bus(next);
  EXPECT_EQ(write(bus, 8), 0U);
  EXPECT_EQ(engine_->read(reg::kHoldLimit), 7U);
  EXPECT_EQ(engine_->read(reg::kHold), 1U) << "the owner has gone";
  EXPECT_EQ(server_.counts().holds, 1U);
}

// Another program that opens the terminal, finds it in use and closes it again does not change the owner's rights.
TEST_F(TerminalTest, AnotherOneThatOnlyLooksChangesNothing) {
  StreamLink owner(opener(), StreamLink::Hello{"secret"});
  driver::FrameBus bus(owner);
  for (std::uint32_t i = 1; i <= 3; ++i) {
    { const TerminalClient other(name_, server_); }
    EXPECT_EQ(write(bus, i), 1U);
  }
  EXPECT_EQ(engine_->read(reg::kHold), 0U);
  EXPECT_EQ(engine_->read(reg::kHoldLimit), 3U);
}

}  // namespace
}  // namespace trammel::serve
