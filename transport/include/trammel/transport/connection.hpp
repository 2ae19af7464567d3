// A bus to the card with a given URL. One thread at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "trammel/driver/bus.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/transport/card_url.hpp"

namespace trammel::sim {
class Engine;
}

namespace trammel::transport {

class StreamLink;

class Connection {
 public:
  // Connects, or creates the simulated card of `sim:`, whose time passes while the driver sleeps. Throws
  // driver::LinkError, whose message says what to do, and std::invalid_argument for a simulated card with axes or a
  // clock out of range.
  explicit Connection(const CardUrl& url);
  ~Connection();
  Connection(Connection&&) noexcept;
  Connection& operator=(Connection&&) = delete;

  driver::Bus& bus() { return *bus_; }
  // The bus as a FrameBus, if it uses frames; nullptr for a window in memory and for a simulated card.
  driver::FrameBus* frames() { return frames_; }
  // The bus as an engine, for a simulated card (its inputs, its steps, its reset); else nullptr.
  sim::Engine* engine() { return engine_; }

  // False if `trammel serve` allows reading only, because its token was not given.
  bool may_move() const;
  // Sets the time after which a silent card counts as lost, because its watchdog has stopped it by then. No effect if
  // the URL sets the timeout of an answer.
  void set_patience(std::chrono::nanoseconds patience);
  // Whether the last request got no answer.
  bool lost() const;
  // Number of times that a lost connection to `trammel serve` was restored. The server made the card hold each time.
  std::uint64_t reconnections() const;

 private:
  std::unique_ptr<driver::ByteLink> link_;
  StreamLink* stream_ = nullptr;
  std::unique_ptr<driver::Bus> bus_;
  driver::FrameBus* frames_ = nullptr;
  sim::Engine* engine_ = nullptr;
  bool timeout_given_ = false;
};

}  // namespace trammel::transport
