// The driver's only way to a card: reads and writes of 32-bit registers, and time. A transport (PCIe window, SPI, UART,
// simulated card) is one class derived from Bus.
#pragma once

#include <cstddef>
#include <cstdint>

namespace trammel::driver {

// Where the words of a block go.
enum class Addressing {
  kIncrementing,  // word i to address + 4 * i
  kFixed,         // every word to `address` (the stream port)
};

// One card's register window. Addresses are byte addresses within the card's 4 KiB window, multiples of 4.
//
// Errors: an access that the card or the link refuses throws BusError with the address refused and the direction. A
// write that throws has not taken effect; of a block, the words before the refused one have.
// Thread-safety: none; one thread at a time uses a bus and everything built upon it.
class Bus {
 public:
  virtual ~Bus() = default;

  virtual std::uint32_t read(std::uint32_t address) = 0;

  virtual void write(std::uint32_t address, std::uint32_t value) = 0;

  // Writes `count` words in order; a transport may send them as one burst. `count` may be 0: no access then.
  virtual void write_block(std::uint32_t address, const std::uint32_t* words, std::size_t count,
                           Addressing addressing) = 0;

  // Lets at least `card_clocks` clocks of the card pass: a sleep with hardware, clock cycles in simulation.
  virtual void wait(std::uint64_t card_clocks) = 0;

 protected:
  Bus() = default;
  Bus(const Bus&) = default;
  Bus& operator=(const Bus&) = default;
};

}  // namespace trammel::driver
