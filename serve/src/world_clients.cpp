#include "world_clients.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "client.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::serve {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kMaxWorldClients = 8;
constexpr std::size_t kLongestRequest = 200;
// Card time from a press to its answer: by then the default contact has stopped bouncing, and the default filter has
// passed the level.
constexpr double kSettled = 0.02;  // s

}  // namespace

void CardServer::WorldClients::admit(std::unique_ptr<transport::ByteStream>& stream, bool may_press, std::string came) {
  if (server_.settings_.world == nullptr) {
    throw Unwanted("this card has no machine behind its pins: start it by `trammel serve --world default`");
  }
  if (clients_.size() == kMaxWorldClients) throw Unwanted("as many clients are at the machine as the server takes");
  Client client;
  client.stream = std::move(stream);
  client.may_press = may_press;
  client.came = std::move(came);
  try {
    send(client, "trammel 1 world");
  } catch (const driver::LinkError&) {
    return;
  }
  clients_.push_back(std::move(client));
}

void CardServer::WorldClients::serve() {
  clients_.erase(std::remove_if(clients_.begin(), clients_.end(), [this](Client& client) { return !stays(client); }),
                 clients_.end());
}

bool CardServer::WorldClients::stays(Client& client) {
  try {
    read(client);
    if (client.request) make(client);
    if (client.due) answer(client);
    // One request at a time: the next one waits for the answer.
    while (!client.request && !client.due && client.came.find('\n') != std::string::npos) take_line(client);
    return true;
  } catch (const driver::LinkError& error) {
    server_.settings_.note(fmt::format("client gone ({})", error.what()));
  } catch (const Unwanted& error) {
    server_.settings_.note(fmt::format("{} at the machine refused: {}", client.stream->peer(), error.what()));
  }
  return false;
}

void CardServer::WorldClients::read(Client& client) {
  std::uint8_t bytes[256];
  while (const std::size_t count = client.stream->read(bytes, sizeof(bytes), 0ns)) {
    client.came.append(reinterpret_cast<const char*>(bytes), count);
    client.heard = Clock::now();
  }
  if (client.came.size() > kLongestRequest) throw Unwanted("a request is one line, and waits for its answer");
  const auto most = server_.settings_.silence;
  const bool waits = client.request || client.due;
  if (most.count() != 0 && !waits && Clock::now() - client.heard > most) throw Unwanted("it has fallen silent");
}

void CardServer::WorldClients::take_line(Client& client) {
  const std::size_t end = client.came.find('\n');
  const std::string line = client.came.substr(0, end);
  client.came.erase(0, end + 1);
  try {
    const world::Request request = world::parse_request(line, *server_.settings_.world);
    if (request.kind != world::Request::Kind::kState && !client.may_press) {
      throw std::invalid_argument("the server lets nobody press or count without its token");
    }
    client.request = request;
  } catch (const std::invalid_argument& error) {
    return send(client, fmt::format("no: {}", error.what()));
  }
  make(client);
  if (client.due) answer(client);
}

// Executes the request if its condition is met.
void CardServer::WorldClients::make(Client& client) {
  using Kind = world::Request::Kind;
  world::World& world = *server_.settings_.world;
  const world::Request request = *client.request;
  if (request.when && !world::holds(*request.when, world, server_.path(false).steps)) return;
  client.request.reset();
  double seconds = 0;
  if (request.kind == Kind::kCount) server_.path(true);
  if (request.kind == Kind::kPress || request.kind == Kind::kRelease) {
    request.kind == Kind::kPress ? world.press(request.button) : world.release(request.button);
    seconds = kSettled;
    server_.settings_.note(fmt::format("{} has {} {}", client.stream->peer(),
                                       request.kind == Kind::kPress ? "pressed" : "released", request.button));
  }
  client.due = server_.engine_.cycles() + static_cast<std::uint64_t>(seconds * server_.settings_.clock_hz);
  client.life = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

// As for a reader: if a client decides when the card's time advances, answers are timed by the host's clock while that
// time does not advance.
bool CardServer::WorldClients::mover_decides() const {
  return !server_.settings_.real_time && server_.mover() != nullptr;
}

void CardServer::WorldClients::answer(Client& client) {
  const bool passed = *client.due <= server_.engine_.cycles() || (mover_decides() && client.life <= Clock::now());
  if (!passed) return;
  client.due.reset();
  client.heard = Clock::now();
  send(client, "ok " + world::state_json(*server_.settings_.world, server_.path(false)));
}

void CardServer::WorldClients::send(Client& client, const std::string& line) const {
  const std::string text = line + "\n";
  client.stream->write(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

std::optional<std::uint64_t> CardServer::WorldClients::clocks_to_next() const {
  const std::uint64_t now = server_.engine_.cycles();
  std::optional<std::uint64_t> next;
  for (const Client& client : clients_) {
    if (!client.due) continue;
    const std::uint64_t clocks = *client.due > now ? *client.due - now : 0;
    next = std::min(next.value_or(clocks), clocks);
  }
  return next;
}

}  // namespace trammel::serve
