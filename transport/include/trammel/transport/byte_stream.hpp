// Streams of bytes between processes and to serial ports, for both ends, with any content. One thread at a time.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace trammel::transport {

class ByteStream {
 public:
  virtual ~ByteStream() = default;

  // Sends all bytes. Throws driver::LinkError, also if the other end accepts nothing for a second.
  virtual void write(const std::uint8_t* bytes, std::size_t count) = 0;
  // Waits for at most `longest` until bytes have arrived. Returns the number of bytes written to `bytes`, at most
  // `room`; 0 if none arrived. Throws driver::LinkError when the other end is gone.
  virtual std::size_t read(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) = 0;
  // Name of the other end, for messages.
  virtual std::string peer() const = 0;
  // Whether all clients at the other end had closed the stream at some time since the last call. Bytes read since then
  // may come from another client.
  virtual bool changed_hands() { return false; }

 protected:
  ByteStream() = default;
  ByteStream(const ByteStream&) = default;
  ByteStream& operator=(const ByteStream&) = default;
};

class SerialStream : public ByteStream {
 public:
  // Holds the line at 0 for a quarter of a second. Drops bytes that arrived but were not read.
  virtual void send_break() = 0;
};

// Accepts connections.
class Listener {
 public:
  virtual ~Listener() = default;

  // A client that has connected; nullptr for none. Does not wait.
  virtual std::unique_ptr<ByteStream> accept() = 0;
  // Whether a client notices that the server has closed its stream.
  virtual bool ends_streams() const { return true; }
  // The URL for a client's --card, without the token.
  virtual std::string url() const = 0;

 protected:
  Listener() = default;
  Listener(const Listener&) = default;
  Listener& operator=(const Listener&) = default;
};

// All of these throw driver::LinkError, whose message says how to solve the problem.
std::unique_ptr<ByteStream> connect_tcp(const std::string& host, std::uint16_t port, std::chrono::milliseconds longest);
std::unique_ptr<SerialStream> open_serial(const std::string& device, std::uint32_t baud);
// Port 0 selects a free port.
std::unique_ptr<Listener> listen_tcp(const std::string& host, std::uint16_t port);
// A pseudo-terminal. One client at a time; clients may come and go.
std::unique_ptr<Listener> open_pseudo_terminal();

}  // namespace trammel::transport
