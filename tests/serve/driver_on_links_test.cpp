// The same tests of the driver on a simulated card in this process, and on cards behind a server with TCP and with a
// pseudo-terminal.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <atomic>
#include <thread>

#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/serve/card_server.hpp"
#include "trammel/sim/engine.hpp"
#include "trammel/transport/card_url.hpp"
#include "trammel/transport/connection.hpp"

namespace trammel::serve {
namespace {

using namespace std::chrono_literals;
using driver::Card;
using driver::Stream;
using ::testing::HasSubstr;
namespace reg = card_map::reg;
namespace field = card_map::field;

enum class Place { kHere, kTcp, kTerminal };

// A card and the connection to it.
class Bench {
 public:
  explicit Bench(Place place) {
    if (place == Place::kHere) return;
    listener_ = place == Place::kTcp ? transport::listen_tcp("127.0.0.1", 0) : transport::open_pseudo_terminal();
    Settings settings;
    settings.token = "secret";
    settings.clock_hz = 1'000'000;
    settings.real_time = false;
    server_ = std::make_unique<CardServer>(*engine_, *listener_, settings);
    thread_ = std::thread([this] {
      while (!ended_) server_->turn();
    });
    connect();
  }
  ~Bench() { end(); }

  driver::Bus& bus() { return connection_ ? connection_->bus() : *engine_; }
  std::string url() const { return listener_->url(); }
  void disconnect() { connection_.reset(); }
  // The card's positions in the simulation, after all clients have disconnected.
  std::vector<std::int64_t> end() {
    connection_.reset();
    ended_ = true;
    if (thread_.joinable()) thread_.join();
    return engine_->positions();
  }
  void connect() {
    if (!listener_) return;
    connection_.reset();
    connection_ = std::make_unique<transport::Connection>(
        transport::parse_card_url(listener_->url() + "?token=secret&timeout=20000"));
    ASSERT_TRUE(connection_->may_move());
  }

 private:
  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine(sim::EngineOptions{4, 1'000'000, false});
  std::unique_ptr<transport::Listener> listener_;
  std::unique_ptr<CardServer> server_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
  std::unique_ptr<transport::Connection> connection_;
};

driver::LineCommand line_of(std::uint64_t ticks, std::int64_t pulses) {
  driver::LineCommand line;
  line.ticks = ticks;
  line.mask = 1;
  const std::int64_t whole = std::int64_t{1} << 40;
  line.increment[0] =
      (pulses * whole + (pulses < 0 ? 1 : -1)) / static_cast<std::int64_t>(ticks) + (pulses < 0 ? -1 : 1);
  return line;
}

driver::FeedCommand feed_of(std::uint64_t ticks) {
  driver::FeedCommand feed;
  feed.ticks = ticks;
  feed.rate = std::uint64_t{1} << 60;  // one tick per 16 clocks
  feed.floor = 1;
  return feed;
}

class DriverOnLinks : public ::testing::TestWithParam<Place> {
 protected:
  Bench bench_{GetParam()};
};

TEST_P(DriverOnLinks, KnowsWhoTheCardIs) {
  const Card card = Card::open(bench_.bus());
  EXPECT_EQ(card.identification().axes, 4U);
  EXPECT_EQ(card.identification().clock_hz, 1'000'000U);
}

TEST_P(DriverOnLinks, SettingsAreKept) {
  Card card = Card::open(bench_.bus());
  driver::AxisSettings settings;
  settings.step_length = 3us;
  settings.direction_hold = 7us;
  card.configure_axis(2, settings);
  card.set_ratio(0x8000);
  EXPECT_EQ(card.parts().registers.read(reg::step_length(2)), 3U);
  EXPECT_EQ(card.parts().registers.read(reg::dir_hold(2)), 7U);
  EXPECT_EQ(card.parts().registers.read(reg::kRatioFeed), 0x8000U);
}

TEST_P(DriverOnLinks, ALineEndsWhereItShould) {
  Card card = Card::open(bench_.bus());
  driver::run_line(card, driver::plan_line(card.timing(), {200, -100, 3}, 20ms));
  const driver::Snapshot now = card.read_snapshot();
  EXPECT_EQ(now.position[0], 200);
  EXPECT_EQ(now.position[1], -100);
  EXPECT_EQ(now.position[2], 3);
  EXPECT_EQ(bench_.end(), (std::vector<std::int64_t>{200, -100, 3, 0}));
}

TEST_P(DriverOnLinks, AStreamLongerThanTheQueues) {
  Card card = Card::open(bench_.bus());
  Stream stream(card);
  for (int i = 0; i < 300; ++i) {
    stream.put(feed_of(128));
    stream.put(line_of(128, i % 2 == 0 ? 7 : -3));
  }
  stream.put(driver::EndCommand{});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_EQ(stream.sent(), 601U);
  EXPECT_EQ(bench_.end()[0], 150 * 7 - 150 * 3);
}

TEST_P(DriverOnLinks, ADwellTakesItsTime) {
  Card card = Card::open(bench_.bus());
  Stream stream(card);
  stream.send({driver::DwellCommand{100'000}, driver::EndCommand{}});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_GE(card.read_snapshot().time, 100'000U);
}

TEST_P(DriverOnLinks, RefusalsHaveTheirReason) {
  Card card = Card::open(bench_.bus());
  std::array<driver::Access, 3> accesses{driver::write_of(reg::step_length(0), 5), driver::write_of(reg::kAxes, 1)};
  try {
    card.parts().registers.transfer(accesses.data(), 2, "test");
    FAIL();
  } catch (const driver::RefusedError& error) {
    EXPECT_EQ(error.reason(), static_cast<std::uint8_t>(card_map::Reason::ReadOnly));
    EXPECT_EQ(error.address(), reg::kAxes);
  }
  EXPECT_EQ(card.parts().registers.read(reg::step_length(0)), 5U) << "the one before was made";
  EXPECT_FALSE(card.refusal());
}

TEST_P(DriverOnLinks, AFaultIsNamedAndCleared) {
  Card card = Card::open(bench_.bus());
  Stream stream(card);
  stream.send({feed_of(100), line_of(99, 1), driver::EndCommand{}});
  EXPECT_THROW(stream.finish(), driver::FaultError);
  EXPECT_EQ(card.read_faults(), field::kFaultTickMismatch);
  card.clear_faults();
  stream.restart();
  stream.send({feed_of(10), line_of(10, 1), driver::EndCommand{}});
  EXPECT_TRUE(stream.finish().ended);
}

TEST_P(DriverOnLinks, HoldAndStopOnThePath) {
  Card card = Card::open(bench_.bus());
  card.set_slew_time(10ms);
  Stream stream(card);
  stream.send({feed_of(60'000), line_of(60'000, 1000), driver::EndCommand{}});
  bench_.bus().sleep(200ms);
  card.set_hold(true);
  bench_.bus().sleep(20ms);
  const driver::Snapshot held = card.read_snapshot();
  EXPECT_TRUE(held.status.held);
  bench_.bus().sleep(50ms);
  EXPECT_EQ(card.read_snapshot().position[0], held.position[0]);
  const driver::Snapshot end = card.stop();
  EXPECT_GT(end.position[0], 100);
  EXPECT_LT(end.position[0], 1000);
  EXPECT_FALSE(card.busy());
  EXPECT_EQ(bench_.end()[0], end.position[0]);
}

TEST_P(DriverOnLinks, ProgramsOfSeveralConnections) {
  machine::Machine machine = machine::default_machine();
  for (const char* text : {"G1 X1 Y2 F6000\nG2 X3 Y2 I1\n", "G1 X1 F6000\nG1 X-3\nY-2\nX0 Y0\n"}) {
    bench_.connect();
    Card card = Card::open(bench_.bus());
    card.take_over();
    run::Runner runner([&] { return std::make_unique<gcode::TextLines>(text, "p.ngc"); }, machine,
                       planner::limits_of(card.identification()));
    runner.plan();
    runner.run(card);  // throws unless the card's counts equal the plan's
  }
  EXPECT_EQ(bench_.end(), (std::vector<std::int64_t>{240, 160, 0, 0}));
}

INSTANTIATE_TEST_SUITE_P(
    Places, DriverOnLinks, ::testing::Values(Place::kHere, Place::kTcp, Place::kTerminal), [](const auto& place) {
      return std::string(place.param == Place::kHere ? "Here" : place.param == Place::kTcp ? "Tcp" : "Terminal");
    });

// A TCP port in front of a server's port. It loses each wait.
class LossyRelay {
 public:
  explicit LossyRelay(const std::string& server)
      : server_(transport::parse_card_url(server)), thread_([this] { run(); }) {}
  ~LossyRelay() {
    ended_ = true;
    thread_.join();
  }
  std::string url() const { return listener_->url(); }

 private:
  void run() {
    std::unique_ptr<transport::ByteStream> client;
    for (; !ended_ && !client; std::this_thread::sleep_for(1ms)) client = listener_->accept();
    try {
      const auto card = transport::connect_tcp(server_.host, server_.port, 5s);
      while (!ended_) {
        carry(*client, *card);
        carry(*card, *client);
      }
    } catch (const driver::LinkError&) {
    }
  }
  static void carry(transport::ByteStream& from, transport::ByteStream& to) {
    std::array<std::uint8_t, 4096> bytes{};
    const std::size_t count = from.read(bytes.data(), bytes.size(), 1ms);
    const std::string text(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
    if (text.find("wait ") == std::string::npos) to.write(bytes.data(), count);
  }

  std::unique_ptr<transport::Listener> listener_ = transport::listen_tcp("127.0.0.1", 0);
  transport::CardUrl server_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

// A wait is limited to twice the timeout in the URL, and not by the driver's own limit.
TEST(StreamLinks, AWaitKeepsToTheTimeoutOfTheUrl) {
  Bench bench(Place::kTcp);
  bench.disconnect();
  const LossyRelay relay(bench.url());
  transport::Connection connection(transport::parse_card_url(relay.url() + "?token=secret&timeout=150"));
  const auto begun = std::chrono::steady_clock::now();
  connection.bus().sleep(10ms);
  const auto waited = std::chrono::steady_clock::now() - begun;
  EXPECT_GE(waited, 300ms);
  EXPECT_LT(waited, 5s);
}

// A serial line without a hello, as for a card: a break, 55, frames. The server allows reading.
TEST(SerialLine, ReadsWithoutAHello) {
  const auto engine = sim::make_model_engine(sim::EngineOptions{3, 2'000'000, false});
  const auto listener = transport::open_pseudo_terminal();
  Settings settings;
  settings.token = "secret";
  settings.clock_hz = 2'000'000;
  CardServer server(*engine, *listener, settings);
  std::atomic<bool> ended{false};
  std::thread thread([&] {
    while (!ended) server.turn();
  });
  try {
    transport::Connection connection(transport::parse_card_url(listener->url() + "?timeout=20000"));
    Card card = Card::open(connection.bus());
    EXPECT_EQ(card.identification().axes, 3U);
    EXPECT_THROW(card.set_hold(true), driver::RefusedError);
  } catch (const driver::Error& error) {
    ADD_FAILURE() << error.what();
  }
  ended = true;
  thread.join();
}

std::string why_not(const std::string& url) {
  try {
    transport::Connection connection(transport::parse_card_url(url));
    Card::open(connection.bus());
  } catch (const driver::Error& error) {
    return error.what();
  }
  return "";
}

// Sends a greeting, but is not a card. `then` handles the client after that.
class FalseServer {
 public:
  FalseServer(std::string greeting, std::function<void(transport::ByteStream&)> then)
      : greeting_(std::move(greeting)), then_(std::move(then)), thread_([this] { serve(); }) {}
  ~FalseServer() {
    ended_ = true;
    thread_.join();
  }
  std::string url() const { return listener_->url(); }
  unsigned clients() const { return clients_; }

 private:
  void serve() {
    for (; !ended_; std::this_thread::sleep_for(1ms)) {
      const std::unique_ptr<transport::ByteStream> stream = listener_->accept();
      if (stream) serve(*stream);
    }
  }
  void serve(transport::ByteStream& stream) {
    ++clients_;
    try {
      std::uint8_t hello[64];
      stream.read(hello, sizeof(hello), 1s);
      stream.write(reinterpret_cast<const std::uint8_t*>(greeting_.data()), greeting_.size());
      for (; !ended_; stream.read(hello, sizeof(hello), 1ms)) then_(stream);
    } catch (const driver::LinkError&) {
    }
  }

  std::unique_ptr<transport::Listener> listener_ = transport::listen_tcp("127.0.0.1", 0);
  std::string greeting_;
  std::function<void(transport::ByteStream&)> then_;
  std::atomic<bool> ended_{false};
  std::atomic<unsigned> clients_{0};
  std::thread thread_;
};

// One try is enough: a peer that does not answer the first frame is not a card. With as many tries as a known card
// gets, the test would take two minutes.
TEST(NoCard, AServerWithoutOne) {
  const std::string rubbish(4096, 'x');
  for (const bool loud : {false, true}) {
    const FalseServer server("trammel 1 motion\n", [&](transport::ByteStream& stream) {
      if (loud) stream.write(reinterpret_cast<const std::uint8_t*>(rubbish.data()), rubbish.size());
    });
    EXPECT_THAT(why_not(server.url() + "?timeout=30"), HasSubstr("no card answers within 30 ms: what said hello"));
    EXPECT_EQ(server.clients(), 1U);
  }
}

TEST(NoCard, WhatAServerSaysIsFitForATerminal) {
  const auto nothing = [](transport::ByteStream&) {};
  const FalseServer server("trammel 1 refused: \x1b[31mred\a\r\n", nothing);
  EXPECT_THAT(why_not(server.url()), ::testing::EndsWith(": refused: ?[31mred??"));
  const FalseServer terse("trammel 1 refused: \n", nothing);
  EXPECT_THAT(why_not(terse.url()), ::testing::EndsWith(": refused: for no reason that it gives"));
  const FalseServer closes("", [](transport::ByteStream&) { throw driver::LinkError("enough"); });
  EXPECT_THAT(why_not(closes.url()), HasSubstr("is `trammel serve` running there?"));
}

TEST(NoCard, SaysWhatIsThere) {
  EXPECT_THAT(why_not("tcp://127.0.0.1:1"), HasSubstr("Connection refused: is `trammel serve` running there?"));
  EXPECT_THAT(why_not("serial:/dev/no-such-device"), HasSubstr("no such device"));
  EXPECT_THAT(why_not("serial:/dev/null"), HasSubstr("cannot open it as a serial line"));
  EXPECT_THAT(why_not("mmap:/dev/no-such-device"), HasSubstr("cannot open it"));
  // A listener that says nothing, and a server that knows nothing of cards.
  const auto listener = transport::listen_tcp("127.0.0.1", 0);
  EXPECT_THAT(why_not(listener->url() + "?hello=no&timeout=20"), HasSubstr("no card answers"));
  std::thread other([&] {
    std::unique_ptr<transport::ByteStream> stream;
    for (int i = 0; i < 1000 && !stream; ++i) {
      stream = listener->accept();
      if (stream && stream->peer().empty()) stream.reset();
      std::this_thread::sleep_for(1ms);
    }
    const std::string text = "220 mail ready\n";
    try {
      if (stream) stream->write(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    } catch (const driver::LinkError&) {
    }
    std::this_thread::sleep_for(50ms);
  });
  // Earlier connections still wait in the listener's queue.
  while (listener->accept()) {
  }
  EXPECT_THAT(why_not(listener->url()), HasSubstr("what answers is no `trammel serve`"));
  other.join();
  try {
    const std::string url = listener->url();
    transport::listen_tcp("127.0.0.1", static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1))));
    FAIL() << "twice on one port";
  } catch (const driver::LinkError& error) {
    EXPECT_THAT(error.what(), HasSubstr("in use"));
  }
}

}  // namespace
}  // namespace trammel::serve
