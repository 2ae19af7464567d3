// The card's end of a byte stream, without time: what the frame engine does with each byte. A server that has a card,
// and tests, take it as it is; the golden model of the engine adds its clocks. Not thread-safe.
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

  // A byte from the host; the reply to a request that it ends is appended to `out`.
  void take(std::uint8_t byte, Bytes& out);
  // A new connection: what has come of a frame is forgotten, the epoch moves on.
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
