// Links to cards that speak frames: driver::FrameBus makes a bus of each. Time is the host's unless it says otherwise.
// One thread at a time.
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

// Time of the machine that the program runs on.
class HostTimeLink : public driver::ByteLink {
 public:
  std::chrono::nanoseconds now() const override;
  void sleep(std::chrono::nanoseconds time) override;
};

// A serial line: every connection begins with a break and the byte from which the card measures the baud rate.
class SerialLink final : public HostTimeLink {
 public:
  using Open = std::function<std::unique_ptr<SerialStream>()>;

  // Opens; throws what `open` does.
  SerialLink(Open open, std::uint32_t baud) : open_(std::move(open)), stream_(open_()), baud_(baud) {}

  void send(const std::uint8_t* bytes, std::size_t count) override;
  std::size_t receive(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override;
  // Opens a line that was lost.
  void restart() override;
  std::chrono::nanoseconds time_of(std::size_t bytes) const override;

 private:
  Open open_;
  std::unique_ptr<SerialStream> stream_;  // nullptr: lost
  std::uint32_t baud_;
};

// A card behind a stream that can be opened again. With a hello it is one of `trammel serve`
// (docs/reference/card-url.md): time passes in that card, which may be slower or faster than real time. Without, frames
// go over the stream and nothing else, such as over a bridge to a serial line.
class StreamLink final : public driver::ByteLink {
 public:
  using Open = std::function<std::unique_ptr<ByteStream>()>;
  struct Hello {
    std::string token;  // empty: for reading alone
  };

  struct Options {
    // How long the link tries to open a lost stream again.
    std::chrono::nanoseconds reopen = std::chrono::seconds(3);
    // How long the answer to a wait may take, of the host's time, and how often a wait is sent.
    std::chrono::nanoseconds answer = std::chrono::seconds(20);
    unsigned sends = 2;
  };

  // Connects. Throws driver::LinkError: what `open` throws, or why the server refuses.
  StreamLink(Open open, std::optional<Hello> hello) : StreamLink(std::move(open), std::move(hello), Options()) {}
  StreamLink(Open open, std::optional<Hello> hello, const Options& options);

  // Whether a server takes commands that move; otherwise it refuses every write but the order for a snapshot.
  bool may_move() const { return may_move_; }
  // A wait that is not answered for so long ends, and a server has so long for its hello, where Options say longer.
  void set_patience(std::chrono::nanoseconds patience) { patience_ = patience; }
  // How often a connection that was lost has been made anew: the server had the card hold then.
  std::uint64_t reconnections() const { return reconnections_; }

  void send(const std::uint8_t* bytes, std::size_t count) override;
  std::size_t receive(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override;
  // Opens a stream that was lost; where that has failed before, it tries once.
  void restart() override;
  std::chrono::nanoseconds time_of(std::size_t) const override { return {}; }
  std::chrono::nanoseconds now() const override;
  // With a hello in card time. Ends early where an InterruptScope's check ends the call.
  void sleep(std::chrono::nanoseconds time) override;
  // Whom the server names in its hello.
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
  std::uint32_t waits_ = 0;               // each has a number, so that a late answer is not taken for the next one's
  bool given_up_ = false;
  std::unique_ptr<ByteStream> stream_;  // nullptr: lost
  bool may_move_ = true;
  std::string hold_origin_;
  std::uint64_t reconnections_ = 0;
};

// Linux's spidev. One exchange for what is sent; the reply comes in later ones.
class SpiLink final : public HostTimeLink {
 public:
  struct Options {
    std::uint32_t sck_hz = 1'000'000;
    unsigned mode = 0;  // 0 or 3
  };

  // Throws driver::LinkError. `calls` must outlive it.
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
  std::uint8_t last_;  // received
};

}  // namespace trammel::transport
