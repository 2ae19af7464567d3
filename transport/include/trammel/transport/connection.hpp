// A bus to the card that a URL names. One thread at a time.
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
  // Connects, or makes the simulated card of `sim:`, whose time passes while the driver sleeps. Throws
  // driver::LinkError with what to do, and std::invalid_argument for a simulated card with axes or a clock out of
  // range.
  explicit Connection(const CardUrl& url);
  ~Connection();
  Connection(Connection&&) noexcept;
  Connection& operator=(Connection&&) = delete;

  driver::Bus& bus() { return *bus_; }
  // The same, where it goes by frames; nullptr for a window in memory and a simulated card.
  driver::FrameBus* frames() { return frames_; }
  // The same, where it is a simulated card (its inputs, its steps, its reset); else nullptr.
  sim::Engine* engine() { return engine_; }

  // False where `trammel serve` gives reading alone, for want of its token.
  bool may_move() const;
  // From now on a card that is silent for so long counts as lost: its watchdog has stopped it by then. Nothing changes
  // where the URL says how long an answer may take.
  void set_patience(std::chrono::nanoseconds patience);
  // Whether the last request had no answer.
  bool lost() const;
  // How often a connection to `trammel serve` that was lost has been made anew; each time the card was made to hold.
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
