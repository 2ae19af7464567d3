// The driver's only interface to a card: accesses to 32-bit registers, and time. Each transport (memory window, SPI,
// serial line, simulated card) is a class derived from Bus; docs/reference/bus.md shows an example.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace trammel::driver {

// One register access. `address`: byte offset within the card's 4 KiB window, a multiple of 4.
struct Access {
  std::uint32_t address = 0;
  std::uint32_t data = 0;  // value to write, or value read
  bool write = false;
};

constexpr Access read_of(std::uint32_t address) { return {address, 0, false}; }
constexpr Access write_of(std::uint32_t address, std::uint32_t data) { return {address, data, true}; }

// One connection to one card.
//
// Thread-safety: none; one thread at a time uses a bus and everything built on it. Two threads may use two connections
// to the same card if the transport's documentation says so.
class Bus {
 public:
  virtual ~Bus() = default;

  // Makes `count` accesses in order and stores the values read in `data`. A count of 0 makes none. Returns the number
  // of accesses made. It is less than `count` only if the card refused accesses[result]; no later access was made then.
  // Throws LinkError with the transport's message when the link fails; it is then unknown which accesses were made.
  virtual std::size_t transfer(Access* accesses, std::size_t count) = 0;

  // Returns after at least `time` (>= 0): hardware sleeps, a simulation runs its clock. It returns earlier only if the
  // check of an InterruptScope ends the call that sleeps.
  virtual void sleep(std::chrono::nanoseconds time) = 0;

  // Whether transfer() reports refusals. If it does not (posted writes), transfer() returns `count`, and the driver
  // reads the refusals from the card before it reports success.
  virtual bool reports_refusals() const = 0;

  // Whether the card's interrupt line reaches this transport.
  virtual bool has_interrupt() const { return false; }

  // Waits until the card's interrupt is raised, for at most `longest`. Returns true if the interrupt ended the wait.
  // Returns at once if the interrupt is already raised.
  virtual bool wait_for_interrupt(std::chrono::nanoseconds longest) {
    sleep(longest);
    return false;
  }

  // Describes who put the card into its hold, for messages; empty if the transport does not know.
  virtual std::string hold_origin() const { return {}; }

 protected:
  Bus() = default;
  Bus(const Bus&) = default;
  Bus& operator=(const Bus&) = default;
};

}  // namespace trammel::driver
