// Frames in a byte stream: each ends with kEnd, which stands nowhere else (docs/reference/frames.md).
// Plain values; not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "trammel/frames/crc32.hpp"

namespace trammel::frames {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kEnd = 0xC0;
constexpr std::uint8_t kEscape = 0xDB;
constexpr std::uint8_t kEscapedEnd = 0xDC;
constexpr std::uint8_t kEscapedEscape = 0xDD;
constexpr std::size_t kCrcBytes = 4;

// Appends `body`, its CRC and kEnd to `stream`.
void append_frame(Bytes& stream, const Bytes& body);

// Takes a stream byte by byte and gives out the bodies of frames whose CRC is good.
class Deframer {
 public:
  // Bodies longer than `most` bytes are passed over.
  explicit Deframer(std::size_t most) : most_(most) {}

  // True when this byte ended a frame with a good CRC; its body stands until the next call.
  bool take(std::uint8_t byte);
  const Bytes& body() const { return body_; }
  // Forgets what has come of a frame.
  void clear();
  // What comes up to the next kEnd is no frame.
  void pass_over() { bad_ = true; }
  // Frames that were begun and not given out: damaged, cut or too long.
  std::uint64_t dropped() const { return dropped_; }

 private:
  bool end();
  void add(std::uint8_t byte);

  std::size_t most_;
  Bytes bytes_;  // body and CRC, as far as they have come
  Bytes body_;
  Crc32 crc_;
  bool escaped_ = false;
  bool bad_ = false;
  std::uint64_t dropped_ = 0;
};

}  // namespace trammel::frames
