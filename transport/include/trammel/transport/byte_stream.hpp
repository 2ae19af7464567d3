// Streams of bytes between processes and to serial ports, at both ends, whatever they carry. One thread at a
// time.
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

  // Sends all of them. Throws driver::LinkError, also when the other end takes nothing for a second.
  virtual void write(const std::uint8_t* bytes, std::size_t count) = 0;
  // Waits for at most `longest` until something has come; returns how many bytes were put into `bytes`, 0 for none.
  // Throws driver::LinkError when the other end is gone.
  virtual std::size_t read(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) = 0;
  // The other end, for messages.
  virtual std::string peer() const = 0;
  // Whether everybody at the other end had let go of the stream since the last call: bytes read since may be another
  // client's.
  virtual bool changed_hands() { return false; }

 protected:
  ByteStream() = default;
  ByteStream(const ByteStream&) = default;
  ByteStream& operator=(const ByteStream&) = default;
};

class SerialStream : public ByteStream {
 public:
  // Holds the line at 0 for a quarter of a second; drops bytes that have come and were not read.
  virtual void send_break() = 0;
};

// Where others connect to.
class Listener {
 public:
  virtual ~Listener() = default;

  // The client that has come, without waiting; nullptr for none.
  virtual std::unique_ptr<ByteStream> accept() = 0;
  // Whether a client sees that the server has let go of its stream.
  virtual bool ends_streams() const { return true; }
  // What a client gives as --card, but for the token.
  virtual std::string url() const = 0;

 protected:
  Listener() = default;
  Listener(const Listener&) = default;
  Listener& operator=(const Listener&) = default;
};

// All of these throw driver::LinkError, saying what there is to do.
std::unique_ptr<ByteStream> connect_tcp(const std::string& host, std::uint16_t port, std::chrono::milliseconds longest);
std::unique_ptr<SerialStream> open_serial(const std::string& device, std::uint32_t baud);
// A port of 0: one that is free.
std::unique_ptr<Listener> listen_tcp(const std::string& host, std::uint16_t port);
// A pseudo-terminal; one client at a time, who may come and go.
std::unique_ptr<Listener> open_pseudo_terminal();

}  // namespace trammel::transport
