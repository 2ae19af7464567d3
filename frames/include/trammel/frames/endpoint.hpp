// The card's end of a byte stream, without time: the frame engine's response to each byte. A server with a card, and
// tests, use it directly; the golden model of the engine adds the clocks. Not thread-safe.
#pragma once

#include <cstdint>
#include <functional>

#include "trammel/frames/session.hpp"

namespace trammel::frames {

class Endpoint {
 public:
  struct Answer {
    bool refused = false;
    std::uint32_t data = 0;
  };
  // One access to the card's inner register port; address in bytes.
  using Access = std::function<Answer(bool write, std::uint32_t address, std::uint32_t data)>;

  explicit Endpoint(Access access, Session session = Session()) : access_(std::move(access)), session_(session) {}

  // Takes a byte from the host. If it completes a request, the reply is appended to `out`.
  void take(std::uint8_t byte, Bytes& out);
  // Starts a new connection: drops an incomplete frame and increments the epoch.
  void connect();

  const Session& session() const { return session_; }
  std::uint64_t dropped() const { return deframer_.dropped(); }

 private:
  void execute(const Request& request);
  CardState state();

  Access access_;
  Deframer deframer_{kMaxRequestBody};
  Session session_;
};

}  // namespace trammel::frames
