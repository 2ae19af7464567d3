#include "trammel/serve/card_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "client.hpp"
#include "pace.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::serve {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;
namespace reg = card_map::reg;
namespace field = card_map::field;

// A client that is sent away is listened to for so long, so that the reason reaches it.
constexpr auto kFarewell = 1s;
constexpr auto kLook = 2ms;  // where nothing is due

// What changes nothing that moves: the order for a snapshot, and forgetting what was refused.
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
      endpoint_([this](bool write, std::uint32_t address, std::uint32_t data) { return make(write, address, data); }) {}

CardServer::~CardServer() = default;

frames::Endpoint::Answer CardServer::make(bool write, std::uint32_t address, std::uint32_t data) {
  if (write && !client_->may_move() && !serves_reading(address, data)) return {true, 0};
  driver::Access access{address, data, write};
  const bool made = engine_.transfer(&access, 1) == 1;
  if (write && made && address == reg::kHold && data == 0) held_by_.clear();
  return {!made, access.data};
}

void CardServer::turn() {
  if (client_) serve_client(0ns);
  admit();
  drain_leaving();
  pass_time();
}

void CardServer::admit() {
  std::unique_ptr<transport::ByteStream> stream = listener_.accept();
  if (!stream) return;
  // Who comes when the one before has gone is not a second one: its end is here by now.
  if (client_) serve_client(0ns);
  if (client_) return refuse(std::move(stream), "another client is connected: one at a time");
  ++counts_.clients;
  settings_.note(fmt::format("{} has come", stream->peer()));
  endpoint_.connect();  // nothing that its predecessor has left of a frame
  client_ = std::make_unique<Client>(
      std::move(stream), engine_, endpoint_, settings_,
      [this] { hold(client_->peer() + ": another one has its place"); }, held_by_);
}

void CardServer::serve_client(std::chrono::nanoseconds longest) {
  const std::uint64_t before = client_->requests();
  try {
    client_->serve(longest);
    counts_.requests += client_->requests() - before;
  } catch (const driver::LinkError& error) {
    lose_client(error.what());
  } catch (const Unwanted& error) {
    std::unique_ptr<transport::ByteStream> stream = client_->take_stream();
    lose_client(stream->peer() + ": " + error.what());
    refuse(std::move(stream), error.what());
  }
  counts_.dropped = endpoint_.dropped();
}

void CardServer::lose_client(const std::string& why) {
  const bool could_move = client_->may_move();
  client_.reset();
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

// In real time the card keeps up with life; else it runs to what the client waits for, and where nobody says how long
// he waits, for as long as something moves.
void CardServer::pass_time() {
  const std::optional<std::uint64_t> next = client_ ? client_->clocks_to_next() : std::nullopt;
  if (next && *next == 0) return;
  const bool stands = !settings_.real_time && !next && ((client_ && client_->waits_by_itself()) || !card_moves());
  const std::uint64_t clocks = stands ? 0 : pace_->due(next.value_or(settings_.clock_hz));
  if (clocks != 0) return pace_->run(clocks);
  if (client_) return serve_client(kLook);
  std::this_thread::sleep_for(kLook);
}

bool CardServer::card_moves() {
  const std::uint32_t status = engine_.read(reg::kStatus);
  return (status & field::kStatusBusy) != 0 && (status & field::kStatusHeld) == 0;
}

}  // namespace trammel::serve
