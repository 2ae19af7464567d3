// Clients that look at the machine behind the card and press its buttons, beside the one that moves the card:
// docs/reference/card-url.md. They are served between two turns of the card, in the server's one thread, so nothing of
// theirs falls into an access.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trammel/serve/card_server.hpp"
#include "trammel/transport/byte_stream.hpp"
#include "trammel/world/state.hpp"

namespace trammel::serve {

class CardServer::WorldClients {
 public:
  // `server` must outlive it.
  explicit WorldClients(CardServer& server) : server_(server) {}

  // A client that has said its hello; `came`: what it sent behind that. Throws Unwanted where there is no world, and
  // where as many have come as are served.
  void admit(std::unique_ptr<transport::ByteStream>& stream, bool may_press, std::string came);
  // Takes what has come, presses what is due, sends what is due. Who goes or is sent away is forgotten.
  void serve();
  // Clocks until an answer is due; none where none waits for time.
  std::optional<std::uint64_t> clocks_to_next() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Client {
    std::unique_ptr<transport::ByteStream> stream;
    bool may_press = false;
    std::string came;                        // not taken yet
    std::optional<world::Request> request;   // that waits for its condition
    std::optional<std::uint64_t> due;        // clock at which its answer leaves
    Clock::time_point life = Clock::now();   // when that would be in real time
    Clock::time_point heard = Clock::now();  // something
  };

  bool stays(Client& client);
  void read(Client& client);
  void take_line(Client& client);
  void make(Client& client);
  void answer(Client& client);
  void send(Client& client, const std::string& line) const;
  bool mover_decides() const;

  CardServer& server_;
  std::vector<Client> clients_;
};

}  // namespace trammel::serve
