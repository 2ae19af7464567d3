// A bidirectional stream of bytes to a card: a serial line, an SPI device, a TCP connection. It carries frames
// (docs/reference/frames.md). FrameBus implements a Bus on top of it.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace trammel::driver {

// One connection to one card. Used by one thread at a time.
class ByteLink {
 public:
  virtual ~ByteLink() = default;

  // Sends all bytes, or throws LinkError.
  virtual void send(const std::uint8_t* bytes, std::size_t count) = 0;
  // Waits for at most `longest` until bytes have arrived. Returns the number of bytes written to `bytes`, at most
  // `room`; 0 if none arrived. Throws LinkError when the link is lost.
  virtual std::size_t receive(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) = 0;
  // Restarts the link: sends a break and the byte from which the card measures the baud rate, or reopens the
  // connection. Drops bytes that arrived but were not received. Does nothing on a link that has neither. Throws
  // LinkError.
  virtual void restart() = 0;

  // Longest transmission time of `bytes` bytes, in either direction.
  virtual std::chrono::nanoseconds time_of(std::size_t bytes) const = 0;
  // A monotonic clock, and a wait measured by it.
  virtual std::chrono::nanoseconds now() const = 0;
  virtual void sleep(std::chrono::nanoseconds time) = 0;

  // As Bus::hold_origin().
  virtual std::string hold_origin() const { return {}; }

 protected:
  ByteLink() = default;
  ByteLink(const ByteLink&) = default;
  ByteLink& operator=(const ByteLink&) = default;
};

}  // namespace trammel::driver
