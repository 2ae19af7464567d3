// A stream of bytes to a card and back: a serial line, an SPI device, a TCP connection. It carries frames
// (docs/reference/frames.md); FrameBus makes a Bus of it.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace trammel::driver {

// One connection to one card. One thread at a time.
class ByteLink {
 public:
  virtual ~ByteLink() = default;

  // Sends all of them, or throws LinkError.
  virtual void send(const std::uint8_t* bytes, std::size_t count) = 0;
  // Waits for at most `longest` until something has come; returns how many bytes were put into `bytes`, 0 for none.
  // Throws LinkError when the link is gone.
  virtual std::size_t receive(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) = 0;
  // Begins anew: a break and the byte from which the card measures the baud rate, or a connection opened again. Drops
  // bytes that have come and were not received. Does nothing on a link without either. Throws LinkError.
  virtual void restart() = 0;

  // How long so many bytes are on their way at most, there or back.
  virtual std::chrono::nanoseconds time_of(std::size_t bytes) const = 0;
  // A clock that only rises, and a wait by it.
  virtual std::chrono::nanoseconds now() const = 0;
  virtual void sleep(std::chrono::nanoseconds time) = 0;

  // As of Bus.
  virtual std::string hold_origin() const { return {}; }

 protected:
  ByteLink() = default;
  ByteLink(const ByteLink&) = default;
  ByteLink& operator=(const ByteLink&) = default;
};

}  // namespace trammel::driver
