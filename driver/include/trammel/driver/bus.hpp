// The driver's only way to a card: accesses to 32-bit registers, and time. A transport (memory window, SPI, serial
// line, simulated card) is one class derived from Bus; docs/reference/bus.md shows one.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace trammel::driver {

// One register access. `address`: bytes within the card's 4 KiB window, a multiple of 4.
struct Access {
  std::uint32_t address = 0;
  std::uint32_t data = 0;  // to write, or what was read
  bool write = false;
};

constexpr Access read_of(std::uint32_t address) { return {address, 0, false}; }
constexpr Access write_of(std::uint32_t address, std::uint32_t data) { return {address, data, true}; }

// One connection to one card.
//
// Thread-safety: none; one thread at a time uses a bus and everything built upon it. Two connections to a card may be
// used by two threads where the transport says so.
class Bus {
 public:
  virtual ~Bus() = default;

  // Makes `count` accesses in order, none for a count of 0, and puts the data of reads in their place. Returns how many
  // were made: fewer than `count` only if the card refused accesses[result]; none after it was made. Throws LinkError,
  // with the transport's message, when the link fails: which accesses were made is then not known.
  virtual std::size_t transfer(Access* accesses, std::size_t count) = 0;

  // Returns after at least `time` (>= 0): a sleep with hardware, clocks in simulation. Earlier only where the check of
  // an InterruptScope ends the call that sleeps.
  virtual void sleep(std::chrono::nanoseconds time) = 0;

  // Whether a refusal shows in transfer(). If it does not (posted writes), transfer() returns `count`, and the driver
  // reads the refusals from the card before it reports success.
  virtual bool reports_refusals() const = 0;

  // Whether the card's interrupt line reaches this transport.
  virtual bool has_interrupt() const { return false; }

  // Returns when the card's interrupt is raised or after `longest`, whichever comes first; true for the interrupt. At
  // once when it is raised already.
  virtual bool wait_for_interrupt(std::chrono::nanoseconds longest) {
    sleep(longest);
    return false;
  }

  // Who has made the card hold, for messages; empty if the transport does not know.
  virtual std::string hold_origin() const { return {}; }

 protected:
  Bus() = default;
  Bus(const Bus&) = default;
  Bus& operator=(const Bus&) = default;
};

}  // namespace trammel::driver
