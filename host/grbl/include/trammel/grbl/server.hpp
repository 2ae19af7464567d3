// The clients of one controller: one sends lines, the others only read. A reading client may send report requests ('?')
// and feed holds ('!'); its other bytes are dropped. Used by one thread.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "trammel/grbl/controller.hpp"
#include "trammel/transport/byte_stream.hpp"

namespace trammel::grbl {

class Server {
 public:
  using Note = std::function<void(const std::string&)>;

  // `note`: reports connecting and disconnecting clients to the operator.
  explicit Server(Note note) : note_(std::move(note)) {}

  // Sends the controller's text to all clients. A client that does not accept it is disconnected.
  void write(const std::string& text);

  // Accepts a new client of `listener` (may be null), and passes received bytes on to the controller; does not wait.
  void turn(transport::Listener* listener, Controller& controller);
  // Adds a client that is connected from the beginning.
  void add(std::unique_ptr<transport::ByteStream> stream, Controller& controller);

  bool has_clients() const { return !clients_.empty(); }

 private:
  // The first client sends; the others read.
  using Client = std::unique_ptr<transport::ByteStream>;
  bool serve(std::size_t index, Controller& controller);
  void forget(std::size_t index, const std::string& why, Controller* controller);
  void greet(Controller& controller);

  Note note_;
  std::vector<Client> clients_;
};

}  // namespace trammel::grbl
