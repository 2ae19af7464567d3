// Links to cards that use frames; driver::FrameBus makes a bus of each. Time is the host's unless a comment says
// otherwise. One thread at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "trammel/driver/byte_link.hpp"
#include "trammel/transport/byte_stream.hpp"
#include "trammel/transport/system_calls.hpp"

namespace trammel::transport {

// A link whose time is that of the host.
class HostTimeLink : public driver::ByteLink {
 public:
  std::chrono::nanoseconds now() const override;
  void sleep(std::chrono::nanoseconds time) override;
};

// A serial line. Every connection begins with a break and the byte from which the card measures the baud rate.
class SerialLink final : public HostTimeLink {
 public:
  using Open = std::function<std::unique_ptr<SerialStream>()>;

  // Opens the line; throws what `open` throws.
  SerialLink(Open open, std::uint32_t baud) : open_(std::move(open)), stream_(open_()), baud_(baud) {}

  void send(const std::uint8_t* bytes, std::size_t count) override;
  std::size_t receive(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override;
  // Reopens a line that was lost.
  void restart() override;
  std::chrono::nanoseconds time_of(std::size_t bytes) const override;

 private:
  Open open_;
  std::unique_ptr<SerialStream> stream_;  // null: lost
  std::uint32_t baud_;
};

// A card behind a stream that can be reopened. With a hello, the server is `trammel serve`
// (docs/reference/card-url.md): time is that of its card, which may be slower or faster than real time. Without a
// hello, the stream carries only frames, for example over a bridge to a serial line.
class StreamLink final : public driver::ByteLink {
 public:
  using Open = std::function<std::unique_ptr<ByteStream>()>;
  struct Hello {
    std::string token;  // empty: reading only
  };

  struct Options {
    // Time for which the link tries to reopen a lost stream.
    std::chrono::nanoseconds reopen = std::chrono::seconds(3);
    // Longest time of the host for the answer to a wait, and the number of times that a wait is sent.
    std::chrono::nanoseconds answer = std::chrono::seconds(20);
    unsigned sends = 2;
  };

  // Connects. Throws what `open` throws, and driver::LinkError with the reason if the server refuses.
  StreamLink(Open open, std::optional<Hello> hello) : StreamLink(std::move(open), std::move(hello), Options()) {}
  StreamLink(Open open, std::optional<Hello> hello, const Options& options);

  // Whether the server accepts commands that move the card. Otherwise it refuses every write except the request for a
  // snapshot and the clearing of REFUSAL.
  bool may_move() const { return may_move_; }
  // Limits the time for the answer to a wait, and for the server's hello, to `patience` if Options say longer.
  void set_patience(std::chrono::nanoseconds patience) { patience_ = patience; }
  // Number of times that a lost connection was restored; the server made the card hold each time.
  std::uint64_t reconnections() const { return reconnections_; }

  void send(const std::uint8_t* bytes, std::size_t count) override;
  std::size_t receive(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override;
  // Reopens a stream that was lost. After an earlier failure it tries once only.
  void restart() override;
  std::chrono::nanoseconds time_of(std::size_t) const override { return {}; }
  std::chrono::nanoseconds now() const override;
  // With a hello the time is card time. Ends early if the check of an InterruptScope ends the call.
  void sleep(std::chrono::nanoseconds time) override;
  // The origin of the hold that the server named in its hello.
  std::string hold_origin() const override { return hold_origin_; }

 private:
  void connect();
  void say_hello();
  void wait(std::chrono::nanoseconds time);
  std::chrono::nanoseconds at_most(std::chrono::nanoseconds time) const;
  bool answered(const std::string& text);

  Open open_;
  std::optional<Hello> hello_;
  Options options_;
  std::chrono::nanoseconds patience_{0};  // 0: as Options say
  std::uint32_t waits_ = 0;               // number of the last wait; distinguishes a late answer from the next one's
  bool given_up_ = false;
  std::unique_ptr<ByteStream> stream_;  // null: lost
  bool may_move_ = true;
  std::string hold_origin_;
  std::uint64_t reconnections_ = 0;
};

// A card behind Linux's spidev. A request is sent in one exchange; the reply arrives in later ones.
class SpiLink final : public HostTimeLink {
 public:
  struct Options {
    std::uint32_t sck_hz = 1'000'000;
    unsigned mode = 0;  // 0 or 3
  };

  // Throws driver::LinkError. `calls` must outlive the object.
  SpiLink(const std::string& device, const Options& options, SystemCalls& calls = linux_calls());
  ~SpiLink() override;
  SpiLink(const SpiLink&) = delete;
  SpiLink& operator=(const SpiLink&) = delete;

  void send(const std::uint8_t* bytes, std::size_t count) override;
  std::size_t receive(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override;
  void restart() override { came_.clear(); }
  std::chrono::nanoseconds time_of(std::size_t bytes) const override;

 private:
  void set(unsigned long request, void* value, const char* what);
  void exchange(const std::uint8_t* bytes, std::size_t count);
  [[noreturn]] void fail(const char* what) const;

  std::string device_;
  Options options_;
  SystemCalls& calls_;
  int file_ = -1;
  std::deque<std::uint8_t> came_;
  std::uint8_t last_;  // last byte received
};

}  // namespace trammel::transport
