// Gives a simulated card to other programs, to one that moves it and to some that read: docs/user/serve.md; what goes
// over the stream: docs/reference/card-url.md. One thread.
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

// A token that nobody guesses: 128 bits of the system's random numbers.
std::string random_token();
// Letters, digits, '-' and '_', 1 to 64 of them: what a URL and a line carry.
bool is_token(const std::string& text);

struct Settings {
  std::string token;                    // who says it may move the card
  std::uint32_t clock_hz = 1'000'000;   // of the card
  bool real_time = true;                // else as fast as it can
  std::uint32_t baud = 0;               // what frames' bytes take, ten bits each, in card time; 0: nothing
  std::chrono::milliseconds hello{};    // a client that has said nothing sensible for so long is let go; 0: never
  std::chrono::milliseconds silence{};  // and one that has fallen silent
  std::function<void(const std::string&)> note = [](const std::string&) {};  // what the operator should know
  // The machine behind the engine's pins, where it has one: clients read it and press its buttons. It outlives the
  // server, and nobody else uses it while turn() runs.
  world::World* world = nullptr;
  // What these clients see as the path; true: count anew, from here.
  std::function<world::PathCount(bool anew)> path;
};

class CardServer {
 public:
  struct Counts {
    std::uint64_t clients = 0;
    std::uint64_t refused = 0;   // of further ones: no place, wrong token, rubbish
    std::uint64_t requests = 0;  // frames that were answered
    std::uint64_t dropped = 0;   // frames that were damaged
    std::uint64_t holds = 0;     // clients that could move and went
  };

  // `engine` and `listener` must outlive it.
  CardServer(sim::Engine& engine, transport::Listener& listener, Settings settings);
  ~CardServer();
  CardServer(const CardServer&) = delete;
  CardServer& operator=(const CardServer&) = delete;

  // Takes what has come, and lets the card's time go on: some milliseconds at most.
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
  Client* mover() const;  // the one that may move the card; nullptr where there is none
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
  frames::Endpoint motion_;          // the mover's: a connection that is made anew finds its session again
  frames::Session reading_session_;  // of the reader that went last, for the next one, which may be the same
  std::vector<Leaving> leaving_;
  std::string held_by_;  // who has left the card in its hold, and why; empty where it does not hold for that
};

}  // namespace trammel::serve
