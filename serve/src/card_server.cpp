#include "trammel/serve/card_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "client.hpp"
#include "pace.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "world_clients.hpp"

namespace trammel::serve {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;
namespace reg = card_map::reg;
namespace field = card_map::field;

// A refused client's stream is read for this long, so that the reason reaches it.
constexpr auto kFarewell = 1s;
constexpr auto kLook = 2ms;                           // interval of polls when nothing is due
constexpr std::size_t kMaxClients = kMaxReaders + 2;  // plus the mover, and one that has not started

// Whether a reader may make this write: it affects no motion (request for a snapshot, clearing of REFUSAL).
bool serves_reading(std::uint32_t address, std::uint32_t data) {
  return (address == reg::kControl && data == field::kControlSnapshot) || address == reg::kRefusal;
}

}  // namespace

struct CardServer::Leaving {
  std::unique_ptr<transport::ByteStream> stream;
  steady_clock::time_point until;
};

CardServer::CardServer(sim::Engine& engine, transport::Listener& listener, Settings settings)
    : engine_(engine),
      listener_(listener),
      settings_(std::move(settings)),
      pace_(std::make_unique<Pace>(engine, settings_)),
      at_world_(std::make_unique<WorldClients>(*this)),
      motion_([this](bool write, std::uint32_t address, std::uint32_t data) { return make(write, address, data); }) {}

CardServer::~CardServer() = default;

frames::Endpoint::Answer CardServer::make(bool write, std::uint32_t address, std::uint32_t data) {
  driver::Access access{address, data, write};
  const bool made = engine_.transfer(&access, 1) == 1;
  if (write && made && address == reg::kHold && data == 0) held_by_.clear();
  return {!made, access.data};
}

frames::Endpoint::Answer CardServer::make_reading(bool write, std::uint32_t address, std::uint32_t data) {
  return write && !serves_reading(address, data) ? frames::Endpoint::Answer{true, 0} : make(write, address, data);
}

CardServer::Client* CardServer::mover() const {
  const auto found = std::find_if(clients_.begin(), clients_.end(), [](const auto& c) { return c->may_move(); });
  return found == clients_.end() ? nullptr : found->get();
}

std::size_t CardServer::readers() const {
  return static_cast<std::size_t>(
      std::count_if(clients_.begin(), clients_.end(), [](const auto& c) { return c->reads(); }));
}

void CardServer::turn() {
  serve_clients();
  admit();
  at_world_->serve();
  drain_leaving();
  pass_time();
}

void CardServer::admit() {
  std::unique_ptr<transport::ByteStream> stream = listener_.accept();
  if (!stream) return;
  // Serves the others first: the end of a client that left before this one came has arrived by now.
  serve_clients();
  if (clients_.size() == kMaxClients) return refuse(std::move(stream), "the server has no place: try again later");
  ++counts_.clients;
  settings_.note(fmt::format("{} has come", stream->peer()));
  clients_.push_back(std::make_unique<Client>(std::move(stream), *this));
}

// Serves the oldest client first, so that a client that has left frees its place before another one asks for it.
void CardServer::serve_clients() {
  std::vector<Client*> clients;
  for (const auto& client : clients_) clients.push_back(client.get());
  for (Client* const client : clients) serve_client(*client, 0ns);
}

// The client may no longer exist afterwards.
void CardServer::serve_client(Client& client, std::chrono::nanoseconds longest) {
  const std::uint64_t requests = client.requests();
  const std::uint64_t dropped = client.dropped();
  const auto count = [&] {
    counts_.requests += client.requests() - requests;
    counts_.dropped += client.dropped() - dropped;
  };
  try {
    client.serve(longest);
    count();
  } catch (const driver::LinkError& error) {
    count();
    lose_client(client, error.what());
  } catch (const GoesToWorld& hello) {
    count();
    send_to_world(client, hello.may_press, hello.came);
  } catch (const Unwanted& error) {
    count();
    std::unique_ptr<transport::ByteStream> stream = client.take_stream();
    lose_client(client, stream->peer() + ": " + error.what());
    refuse(std::move(stream), error.what());
  }
}

// Removes the client from the card's clients. It could not move the card, because its hello ended that right.
void CardServer::send_to_world(Client& client, bool may_press, std::string came) {
  std::unique_ptr<transport::ByteStream> stream = client.take_stream();
  forget(client);
  try {
    if (!listener_.ends_streams()) throw Unwanted("a terminal has one client, which is the card's: serve it on a port");
    at_world_->admit(stream, may_press, std::move(came));
  } catch (const Unwanted& error) {
    refuse(std::move(stream), error.what());
  }
}

void CardServer::forget(Client& client) {
  if (!client.may_move()) reading_session_ = client.reading_session();
  clients_.erase(std::find_if(clients_.begin(), clients_.end(), [&](const auto& c) { return c.get() == &client; }));
}

void CardServer::lose_client(Client& client, const std::string& why) {
  const bool could_move = client.may_move();
  forget(client);
  if (could_move) return hold(why);
  settings_.note(fmt::format("client gone ({})", why));
}

void CardServer::hold(const std::string& why) {
  engine_.write(reg::kHold, 1);
  held_by_ = why;
  ++counts_.holds;
  settings_.note(fmt::format("client gone ({}): the card holds", why));
}

void CardServer::refuse(std::unique_ptr<transport::ByteStream> stream, const std::string& why) {
  ++counts_.refused;
  settings_.note(fmt::format("{} refused: {}", stream->peer(), why));
  const std::string line = fmt::format("trammel 1 refused: {}\n", why);
  try {
    stream->write(reinterpret_cast<const std::uint8_t*>(line.data()), line.size());
    if (listener_.ends_streams()) leaving_.push_back({std::move(stream), steady_clock::now() + kFarewell});
  } catch (const driver::LinkError&) {
  }
}

void CardServer::drain_leaving() {
  const auto gone = [](Leaving& leaving) {
    std::uint8_t bytes[256];
    try {
      leaving.stream->read(bytes, sizeof(bytes), 0ns);
    } catch (const driver::LinkError&) {
      return true;
    }
    return steady_clock::now() > leaving.until;
  };
  leaving_.erase(std::remove_if(leaving_.begin(), leaving_.end(), gone), leaving_.end());
}

// Clocks until the next answer of the client that moves the card is due; without such a client, of any client,
// including those at the machine.
std::optional<std::uint64_t> CardServer::clocks_to_next() const {
  if (const Client* const client = mover()) return client->clocks_to_next();
  std::optional<std::uint64_t> next = at_world_->clocks_to_next();
  for (const auto& client : clients_) {
    if (const auto clocks = client->clocks_to_next()) next = std::min(next.value_or(*clocks), *clocks);
  }
  return next;
}

// In real time the card follows the host's clock. Otherwise it runs to the time for which the client waits; if no
// client says how long it waits, the card runs as long as it moves.
void CardServer::pass_time() {
  const std::optional<std::uint64_t> next = clocks_to_next();
  if (next && *next == 0) return;
  const bool says_when =
      std::any_of(clients_.begin(), clients_.end(), [](const auto& client) { return client->waits_by_itself(); });
  const bool stands = !settings_.real_time && !next && (says_when || !card_moves());
  const std::uint64_t clocks = stands ? 0 : pace_->due(next.value_or(settings_.clock_hz));
  if (clocks != 0) return pace_->run(clocks);
  if (Client* const client = mover()) return serve_client(*client, kLook);
  if (!clients_.empty()) return serve_client(*clients_.front(), kLook);
  std::this_thread::sleep_for(kLook);
}

bool CardServer::card_moves() {
  const std::uint32_t status = engine_.read(reg::kStatus);
  return (status & field::kStatusBusy) != 0 && (status & field::kStatusHeld) == 0;
}

}  // namespace trammel::serve
