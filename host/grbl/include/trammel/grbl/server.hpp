// The clients of one controller: one sends lines, the others read along. A client that only reads may ask for reports
// ('?') and for a feed hold ('!'); what else it sends is dropped. One thread.
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

  // `note`: who comes and goes, for the operator.
  explicit Server(Note note) : note_(std::move(note)) {}

  // What the controller says, to all clients. One that does not take it is let go.
  void write(const std::string& text);

  // Takes who has come to `listener` (may be null), and hands what has come to the controller; waits for nothing.
  void turn(transport::Listener* listener, Controller& controller);
  // A client that is there from the beginning.
  void add(std::unique_ptr<transport::ByteStream> stream, Controller& controller);

  bool has_clients() const { return !clients_.empty(); }

 private:
  // The first one sends; the others read.
  using Client = std::unique_ptr<transport::ByteStream>;
  bool serve(std::size_t index, Controller& controller);
  void forget(std::size_t index, const std::string& why, Controller* controller);
  void greet(Controller& controller);

  Note note_;
  std::vector<Client> clients_;
};

}  // namespace trammel::grbl
