// Clients that read the machine behind the card and press its buttons, beside the one that moves the card:
// docs/reference/card-url.md. They are served between two turns of the card, in the server's only thread, so they never
// act during an access.
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

  // Admits a client that has sent its hello. `came`: the bytes after it. Throws Unwanted if there is no world, or as
  // many clients as the server serves.
  void admit(std::unique_ptr<transport::ByteStream>& stream, bool may_press, std::string came);
  // Handles received bytes, presses buttons that are due, sends answers that are due. Removes clients that leave or are
  // disconnected.
  void serve();
  // Clocks until an answer is due; nullopt if none waits for time.
  std::optional<std::uint64_t> clocks_to_next() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Client {
    std::unique_ptr<transport::ByteStream> stream;
    bool may_press = false;
    std::string came;                        // bytes not handled yet
    std::optional<world::Request> request;   // request that waits for its condition
    std::optional<std::uint64_t> due;        // clock at which its answer is due
    Clock::time_point life = Clock::now();   // the same in real time
    Clock::time_point heard = Clock::now();  // time of the last bytes
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
