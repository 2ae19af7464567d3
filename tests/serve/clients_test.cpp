// How the server treats clients, and what clients report about servers that refuse them. One thread; no sockets.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <random>
#include <thread>

#include "clients_fixture.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/serve/card_server.hpp"
#include "trammel/transport/links.hpp"

namespace trammel::serve {
namespace {

using namespace std::chrono_literals;
using test::ClientEnd;
using test::ClientsTest;
using test::kClock;
using ::testing::HasSubstr;
using transport::StreamLink;
namespace reg = card_map::reg;

TEST_F(ClientsTest, Hellos) {
  start(settings());
  EXPECT_EQ(answer_to("trammel 1\n"), "trammel 1 reading\n");
  EXPECT_EQ(answer_to("trammel 1 secret\n"), "trammel 1 motion\n");
  EXPECT_EQ(answer_to("\xC0trammel 1 secret\n"), "trammel 1 motion held: the client has gone\n");
  EXPECT_EQ(answer_to("trammel 1 Secret\n"),
            "trammel 1 refused: wrong token: take the one that the server has printed\n");
  EXPECT_EQ(answer_to("trammel 1 secret2\n"), answer_to("trammel 1 \n"));
  EXPECT_EQ(answer_to("trammel 2 secret\n"), "trammel 1 refused: no hello of this version\n");
  EXPECT_EQ(answer_to("t" + std::string(500, 'x')), "trammel 1 refused: no hello of this version\n");
  EXPECT_EQ(answer_to("GET / HTTP/1.1\r\n\r\n"), "trammel 1 refused: neither a hello nor a frame\n");
  const std::string kReading = "trammel 1 reading held: the client has gone\n";
  for (const char* wait : {"wait 10 minutes", "wait 10", "wait  10 1", "wait -1 1", "wait 10 1 ", "wait 1000000001 1",
                           "wait 10 4294967296", "wait", "waits 10 1"}) {
    EXPECT_EQ(answer_to(fmt::format("trammel 1\n{}\xC0wait 2 3\xC0", wait)), kReading + "waited 2 3\xC0") << wait;
  }
  EXPECT_EQ(answer_to("trammel 1\nwait 1000 4294967295\xC0"), kReading + "waited 1000 4294967295\xC0");
  EXPECT_EQ(answer_to("trammel 1\nwait " + std::string(500, '1') + "\xC0wait 0 0\xC0"), kReading + "waited 0 0\xC0");
  EXPECT_EQ(engine_->read(reg::kHold), 1U) << "those with the token have gone";
  EXPECT_EQ(server_->counts().holds, 2U);
  EXPECT_EQ(server_->counts().refused, 6U);
}

// The time for reconnecting passes only once after a permanent loss, however often the driver asks again.
TEST_F(ClientsTest, AServerThatIsGone) {
  start(settings());
  bool gone = false;
  unsigned tries = 0;
  StreamLink link(
      [&]() -> std::unique_ptr<transport::ByteStream> {
        ++tries;
        if (gone) throw driver::LinkError("nobody there");
        return std::make_unique<ClientEnd>(*server_, listener_);
      },
      StreamLink::Hello{"secret"}, {100ms, 20s, 2});
  driver::FrameBus bus(link);
  gone = true;
  server_.reset();
  driver::Access magic = driver::read_of(reg::kMagic);
  EXPECT_THROW(bus.transfer(&magic, 1), driver::LinkError);
  EXPECT_LE(tries, 8U) << "a look each 50 ms, and one for each of the driver's other tries";
  tries = 0;
  EXPECT_THROW(link.restart(), driver::LinkError);
  EXPECT_EQ(tries, 1U);
  start(settings());
  gone = false;
  link.restart();
  EXPECT_EQ(bus.transfer(&magic, 1), 1U) << "and it may come back";
}

TEST_F(ClientsTest, OneAtATimeMovesTheCard) {
  start(settings());
  const StreamLink first(opener(), StreamLink::Hello{"secret"});
  EXPECT_THAT(link_error("secret"), HasSubstr("another client moves the card"));
  EXPECT_TRUE(server_->has_client());
  EXPECT_EQ(engine_->read(reg::kHold), 0U) << "the first one is still there";
}

// A host that is cut off or stopped leaves an open connection. Its watchdog distinguishes it from a client that is only
// silent.
TEST_F(ClientsTest, WhoseWatchdogHasExpiredLosesItsPlace) {
  start(settings());
  StreamLink dead(opener(), StreamLink::Hello{"secret"});
  driver::FrameBus dead_bus(dead);
  driver::Card dead_card = driver::Card::open(dead_bus);
  dead_card.set_watchdog(100ms);
  driver::start_line(dead_card, {1000}, 10s);
  std::this_thread::sleep_for(1100ms);
  EXPECT_THAT(link_error("secret"), HasSubstr("another client moves the card")) << "silent, and its time is not over";
  dead.sleep(200ms);
  ASSERT_NE(engine_->read(reg::kFault) & card_map::field::kFaultWatchdog, 0U);
  EXPECT_THAT(link_error("secret"), HasSubstr("another client moves the card")) << "late, but it speaks";
  std::this_thread::sleep_for(1100ms);
  StreamLink link(opener(), StreamLink::Hello{"secret"});
  driver::FrameBus bus(link);
  driver::Card card = driver::Card::open(bus);
  EXPECT_EQ(engine_->read(reg::kHold), 1U);
  EXPECT_THAT(bus.hold_origin(), HasSubstr("its watchdog had expired, and another client has its place"));
  card.take_over();
  card.clear_faults();
  EXPECT_THROW(dead_card.set_hold(true), driver::LinkError);
  driver::run_line(card, driver::plan_line(card.timing(), {100}, 10ms));
}

// The next client with the token learns of the hold at once, and which client left it. A take-over ends the hold.
TEST_F(ClientsTest, ANewClientIsToldWhoHasLeftTheCardInItsHold) {
  start(settings());
  {
    StreamLink link(opener(), StreamLink::Hello{"secret"});
    driver::FrameBus bus(link);
    driver::Card card = driver::Card::open(bus);
    driver::start_line(card, {1000}, 10s);
    link.sleep(1ms);
  }
  server_->turn();
  StreamLink link(opener(), StreamLink::Hello{"secret"});
  driver::FrameBus bus(link);
  driver::Card card = driver::Card::open(bus);
  EXPECT_THROW(card.wait_until_idle(100s), driver::HeldError);
  try {
    driver::run_line(card, driver::plan_line(card.timing(), {100}, 10ms));
    ADD_FAILURE() << "the line has run";
  } catch (const driver::HeldError& error) {
    EXPECT_STREQ(error.what(), "line: the card holds: the client has gone: take it over, or end the hold");
  }
  ASSERT_TRUE(card.take_over()) << "something was left";
  const std::int32_t before = card.read_snapshot().position[0];
  driver::run_line(card, driver::plan_line(card.timing(), {100}, 10ms));
  EXPECT_EQ(card.read_snapshot().position[0], before + 100);
}

TEST_F(ClientsTest, SilenceAndRubbish) {
  Settings impatient = settings();
  impatient.hello = 50ms;
  impatient.silence = 50ms;
  start(impatient);
  const auto until_gone = [&] {
    const auto begun = std::chrono::steady_clock::now();
    while (server_->has_client() && std::chrono::steady_clock::now() - begun < 10s) server_->turn();
    EXPECT_FALSE(server_->has_client());
  };
  {
    const ClientEnd silent(*server_, listener_);
    until_gone();
    EXPECT_THAT(notes_, HasSubstr("neither a hello nor a request in 0.1 s"));
  }
  notes_.clear();
  {
    ClientEnd slow(*server_, listener_);
    const auto begun = std::chrono::steady_clock::now();
    while (server_->has_client() && std::chrono::steady_clock::now() - begun < 1s) {
      slow.write(&frames::kEnd, 1);
      for (int i = 0; i < 5 && server_->has_client(); ++i) server_->turn();
    }
    EXPECT_THAT(notes_, HasSubstr("neither a hello nor a request in 0.1 s")) << "bytes that say nothing keep a place";
  }
  {
    StreamLink link(opener(), StreamLink::Hello{"secret"});
    driver::FrameBus bus(link);
    until_gone();
    EXPECT_THAT(notes_, HasSubstr("nothing came for 0.1 s"));
    EXPECT_EQ(engine_->read(reg::kHold), 1U) << "who falls silent is gone";
    driver::Access magic = driver::read_of(reg::kMagic);
    EXPECT_EQ(bus.transfer(&magic, 1), 1U) << "it comes back by itself";
    EXPECT_GE(link.reconnections(), 1U);
  }
  ClientEnd loud(*server_, listener_);
  const frames::Bytes rubbish(10'000, 'x');
  loud.write(&frames::kEnd, 1);
  for (int i = 0; i < 7 && server_->has_client(); ++i) {
    loud.write(rubbish.data(), rubbish.size());
    server_->turn();
  }
  EXPECT_THAT(notes_, HasSubstr("no frame in 65536 bytes"));
}

// Connections are cut at any byte, in both directions, and made again. The card was put into a hold each time, and
// every access was made once.
TEST_F(ClientsTest, CutConnectionsAreMadeAnewAndNothingRunsTwice) {
  start(settings());
  std::mt19937_64 random(7);
  StreamLink link(
      [&] { return std::make_unique<ClientEnd>(*server_, listener_, 500 + random() % 1500, ClientEnd::End::kCut); },
      StreamLink::Hello{"secret"});
  driver::FrameBus::Options patient;
  patient.restarts = 10;
  driver::FrameBus bus(link, patient);
  driver::Card card = driver::Card::open(bus);
  driver::StreamOptions options;
  options.progress = [&](const driver::StreamProgress& progress) {
    if (progress.status.held) card.request_hold(false);
  };
  card.take_over();
  driver::Stream stream(card, options);
  driver::LineCommand line;
  line.ticks = 2000;
  line.mask = 1;
  line.increment[0] = std::int64_t{100} * (std::int64_t{1} << 40) / 2000 + 1;
  driver::FeedCommand feed;
  feed.ticks = 2000;
  feed.rate = std::uint64_t{1} << 60;
  feed.floor = 1;
  for (int i = 0; i < 60; ++i) {
    stream.put(line);
    stream.put(feed);
    if (i % 4 == 0) stream.flush();
  }
  stream.put(driver::EndCommand{});
  EXPECT_TRUE(stream.finish().ended);
  EXPECT_EQ(engine_->positions()[0], 6000);
  EXPECT_GE(link.reconnections(), 20U);
  // A cut in the answer to the hello can come before any client was allowed to move: then there is no hold.
  EXPECT_LE(server_->counts().holds, link.reconnections());
}

// Between a client and the server: damages bytes as the test requests, and respects the time limit of a read.
class Relay final : public transport::ByteStream {
 public:
  using Damage = std::function<void(std::vector<std::uint8_t>&, bool to_server)>;
  Relay(CardServer& server, std::unique_ptr<transport::ByteStream> client, Damage damage)
      : server_(server), client_(std::move(client)), damage_(std::move(damage)) {}
  void write(const std::uint8_t* bytes, std::size_t count) override {
    std::vector<std::uint8_t> sent(bytes, bytes + count);
    damage_(sent, true);
    client_->write(sent.data(), sent.size());
  }
  std::size_t read(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override {
    const auto until = std::chrono::steady_clock::now() + longest;
    std::vector<std::uint8_t> came(room);
    std::size_t count = 0;
    do {
      server_.turn();
      count = client_->read(came.data(), room, 0ns);
    } while (count == 0 && std::chrono::steady_clock::now() < until);
    came.resize(count);
    damage_(came, false);
    std::copy(came.begin(), came.end(), bytes);
    return came.size();
  }
  std::string peer() const override { return client_->peer(); }

 private:
  CardServer& server_;
  std::unique_ptr<transport::ByteStream> client_;
  Damage damage_;
};

// Each byte of a wait and of its answer is damaged once: the wait is sent again on the same connection, and takes its
// full time.
TEST_F(ClientsTest, ADamagedWaitIsSentAgain) {
  start(settings());
  bool to_server = true;
  std::optional<std::size_t> place;
  std::size_t damaged = 0;
  const Relay::Damage damage = [&](std::vector<std::uint8_t>& bytes, bool up) {
    if (up != to_server || !place || *place >= bytes.size()) return;
    bytes[*place] ^= 1;
    place.reset();
    ++damaged;
  };
  StreamLink link([&] { return std::make_unique<Relay>(*server_, opener()(), damage); }, StreamLink::Hello{"secret"},
                  {3s, 20ms, 10});
  const auto begun = std::chrono::steady_clock::now();
  for (const bool up : {true, false}) {
    for (std::size_t at = 0; at < 16; ++at) {
      to_server = up;
      place = at;
      const std::uint64_t before = engine_->cycles();
      link.sleep(12'345us);
      EXPECT_GE(engine_->cycles() - before, 12'345U) << "byte " << at << (up ? " of a wait" : " of an answer");
      EXPECT_LE(engine_->cycles() - before, 12'345U * 11);
    }
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begun, 20s);
  EXPECT_EQ(damaged, 32U);
  EXPECT_EQ(server_->counts().clients, 1U);
  EXPECT_EQ(engine_->read(reg::kHold), 0U);
}

// Uses a stream that another object owns.
class Borrowed final : public transport::ByteStream {
 public:
  explicit Borrowed(transport::ByteStream& stream) : stream_(stream) {}
  void write(const std::uint8_t* bytes, std::size_t count) override { stream_.write(bytes, count); }
  std::size_t read(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override {
    return stream_.read(bytes, room, longest);
  }
  std::string peer() const override { return stream_.peer(); }

 private:
  transport::ByteStream& stream_;
};

// The next client on a terminal may come before the server has seen that the one before it has left.
TEST_F(ClientsTest, AnotherOneOnTheSameStreamHasItsOwnRights) {
  start(settings());
  ClientEnd terminal(*server_, listener_);
  const auto say = [&](const std::string& text) {
    terminal.write(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    for (int i = 0; i < 5; ++i) server_->turn();
    std::array<std::uint8_t, 256> bytes{};
    const std::size_t count = terminal.read(bytes.data(), bytes.size(), 0ns);
    return std::string(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
  };
  EXPECT_EQ(say("trammel 1 secret\n"), "trammel 1 motion\n");
  EXPECT_EQ(say("half a frame\xC0trammel 1\n"), "trammel 1 reading held: client: another one has its place\n");
  EXPECT_EQ(engine_->read(reg::kHold), 1U);
  engine_->write(reg::kHold, 0);
  EXPECT_EQ(say("trammel 1 secret\n").rfind("trammel 1 motion", 0), 0U);
  // The start of a serial line: a client of the card without a hello.
  say("U\xC0");
  EXPECT_EQ(engine_->read(reg::kHold), 1U);
  EXPECT_EQ(server_->counts().holds, 2U);
  StreamLink plain([&] { return std::make_unique<Borrowed>(terminal); }, std::nullopt);
  driver::FrameBus bus(plain);
  driver::Access access = driver::write_of(reg::kHold, 0);
  EXPECT_EQ(bus.transfer(&access, 1), 0U) << "it has not inherited what it may do";
}

// 10 bits per byte in card time, in each direction, and not more.
TEST_F(ClientsTest, BaudIsKeptInCardTime) {
  constexpr std::uint32_t kBaud = 115'200;
  start(settings(kBaud));
  StreamLink link(opener(), StreamLink::Hello{"secret"});
  driver::FrameBus bus(link);
  std::vector<driver::Access> reads;
  for (int i = 0; i < 10; ++i) reads.push_back(driver::read_of(reg::kMagic));
  const std::uint64_t before = engine_->cycles();
  for (int i = 0; i < 100; ++i) ASSERT_EQ(bus.transfer(reads.data(), reads.size()), reads.size());
  const auto clocks = static_cast<double>(engine_->cycles() - before);
  // Before stuffing, a request is 14 bytes and its reply 33 and 40. It is assumed that no word of state holds a C0 or
  // DB, which would be stuffed.
  const double least = 100 * (14 + 28 + 4 + 1 + 40) * 10.0 * kClock / kBaud;
  EXPECT_GE(clocks, least);
  EXPECT_LE(clocks, least * 1.1);
}

// The card is not faster than real time. How much slower it may be depends on the machine.
TEST_F(ClientsTest, RealTimeIsNoFasterThanLife) {
  Settings real = settings();
  real.real_time = true;
  const auto begun = std::chrono::steady_clock::now();
  start(real);
  std::chrono::duration<double> life{};
  while (life < 300ms) {
    server_->turn();
    life = std::chrono::steady_clock::now() - begun;
    ASSERT_LE(static_cast<double>(engine_->cycles()), life.count() * kClock);
  }
  EXPECT_GE(engine_->cycles(), 10'000U);
  // A client's wait passes in the card's time.
  StreamLink link(opener(), StreamLink::Hello{});
  const std::uint64_t before = engine_->cycles();
  link.sleep(50ms);
  EXPECT_GE(engine_->cycles() - before, 50'000U);
}

// The rest of one client's request is not joined with the next client's request.
TEST_F(ClientsTest, ANewClientIsANewEpoch) {
  start(settings());
  frames::Request ask;
  frames::Bytes bytes{frames::kEnd};
  frames::append_request(bytes, ask);
  std::vector<std::uint16_t> epochs;
  for (int i = 0; i < 3; ++i) {
    ClientEnd client(*server_, listener_);
    client.write(bytes.data(), bytes.size());
    client.write(bytes.data(), 5);
    frames::Deframer deframer(frames::kMaxReplyBody);
    std::uint8_t byte = 0;
    while (client.read(&byte, 1, 1s) != 0 && !deframer.take(byte)) {
    }
    const auto reply = frames::parse_reply(deframer.body());
    ASSERT_TRUE(reply);
    epochs.push_back(reply->epoch);
  }
  EXPECT_EQ(epochs, (std::vector<std::uint16_t>{1, 2, 3}));
}

}  // namespace
}  // namespace trammel::serve
