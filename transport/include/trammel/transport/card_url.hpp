// The URL of a card: docs/reference/card-url.md. Plain values and a pure function, thread-safe.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace trammel::transport {

struct CardUrl {
  enum class Kind { kSim, kTcp, kSerial, kSpi, kMmap };

  Kind kind = Kind::kSim;
  std::string text;  // the URL as given, without the token: for messages
  std::string host;  // kTcp
  std::uint16_t port = 0;
  std::string device;  // path of kSerial, kSpi, kMmap

  std::string token;                                 // kTcp, kSerial: the token that `trammel serve` printed
  bool hello = true;                                 // kTcp: the other end is `trammel serve`
  std::optional<std::chrono::milliseconds> timeout;  // kTcp, kSerial, kSpi: timeout of an answer
  std::uint32_t baud = 115'200;                      // kSerial
  std::uint32_t sck_hz = 1'000'000;                  // kSpi
  unsigned mode = 0;                                 // kSpi: 0 or 3
  std::uint64_t offset = 0;                          // kMmap: byte offset in the file, a multiple of 4
  bool interrupt = true;                             // kMmap: use the interrupt of a UIO device that has one
  unsigned axes = 4;                                 // kSim
  std::uint32_t clock_hz = 1'000'000;                // kSim
};

// Throws driver::ArgumentError; the message says what to write instead.
CardUrl parse_card_url(const std::string& text);

}  // namespace trammel::transport
