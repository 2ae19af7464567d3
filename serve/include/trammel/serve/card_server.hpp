// Serves a simulated card to other programs: one that moves it, and several that read (docs/user/serve.md). The
// protocol of the stream is in docs/reference/card-url.md. One thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trammel/frames/endpoint.hpp"
#include "trammel/sim/engine.hpp"
#include "trammel/transport/byte_stream.hpp"
#include "trammel/world/state.hpp"
#include "trammel/world/world.hpp"

namespace trammel::serve {

// A token that cannot be guessed: 128 bits of the system's random numbers.
std::string random_token();
// Whether `text` is a valid token: letters, digits, '-' and '_', 1 to 64 of them, which fit in a URL and in a line.
bool is_token(const std::string& text);

struct Settings {
  std::string token;                    // a client that sends it may move the card
  std::uint32_t clock_hz = 1'000'000;   // clock of the card
  bool real_time = true;                // false: the card runs as fast as possible
  std::uint32_t baud = 0;               // simulated baud rate of frames, ten bits per byte, in card time; 0: no delay
  std::chrono::milliseconds hello{};    // time for a new client's first valid hello or request; 0: unlimited
  std::chrono::milliseconds silence{};  // time after which a silent client is disconnected; 0: never
  std::function<void(const std::string&)> note = [](const std::string&) {};  // receives messages for the operator
  // The machine behind the engine's pins, if any: clients read it and press its buttons. It must outlive the server,
  // and only the server may use it while turn() runs.
  world::World* world = nullptr;
  // The path as these clients see it; true: restart the count from here.
  std::function<world::PathCount(bool anew)> path;
};

class CardServer {
 public:
  struct Counts {
    std::uint64_t clients = 0;
    std::uint64_t refused = 0;   // refused clients: no place, wrong token, invalid data
    std::uint64_t requests = 0;  // frames answered
    std::uint64_t dropped = 0;   // damaged frames
    std::uint64_t holds = 0;     // clients that could move the card and left
  };

  // `engine` and `listener` must outlive the object.
  CardServer(sim::Engine& engine, transport::Listener& listener, Settings settings);
  ~CardServer();
  CardServer(const CardServer&) = delete;
  CardServer& operator=(const CardServer&) = delete;

  // Handles the received bytes, and advances the card's time, for some milliseconds at most.
  void turn();

  bool has_client() const { return !clients_.empty(); }
  const Counts& counts() const { return counts_; }

 private:
  class Client;
  class Pace;
  class WorldClients;
  struct Leaving;

  void admit();
  frames::Endpoint::Answer make(bool write, std::uint32_t address, std::uint32_t data);
  frames::Endpoint::Answer make_reading(bool write, std::uint32_t address, std::uint32_t data);
  void serve_clients();
  void serve_client(Client& client, std::chrono::nanoseconds longest);
  void forget(Client& client);
  void lose_client(Client& client, const std::string& why);
  void send_to_world(Client& client, bool may_press, std::string came);
  world::PathCount path(bool anew) const { return settings_.path ? settings_.path(anew) : world::PathCount{}; }
  Client* mover() const;  // the client that may move the card; nullptr if there is none
  std::size_t readers() const;
  std::optional<std::uint64_t> clocks_to_next() const;
  void hold(const std::string& why);
  void refuse(std::unique_ptr<transport::ByteStream> stream, const std::string& why);
  void drain_leaving();
  void pass_time();
  bool card_moves();

  sim::Engine& engine_;
  transport::Listener& listener_;
  Settings settings_;
  Counts counts_;
  std::vector<std::unique_ptr<Client>> clients_;  // the oldest first
  std::unique_ptr<Pace> pace_;
  std::unique_ptr<WorldClients> at_world_;
  frames::Endpoint motion_;          // session of the mover; kept, so that a new connection continues it
  frames::Session reading_session_;  // session of the reader that left last; the next reader may be the same
  std::vector<Leaving> leaving_;
  std::string held_by_;  // client that left the card in its hold, and why; empty if there is no such hold
};

}  // namespace trammel::serve
