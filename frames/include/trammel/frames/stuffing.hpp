// Frames in a byte stream. Each ends with kEnd, which occurs nowhere else (docs/reference/frames.md). Plain values; not
// thread-safe.
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

// Takes a stream byte by byte, and returns the bodies of frames whose CRC is correct.
class Deframer {
 public:
  // Bodies longer than `most` bytes are skipped.
  explicit Deframer(std::size_t most) : most_(most) {}

  // True when this byte ended a frame with a correct CRC. Its body is valid until the next call.
  bool take(std::uint8_t byte);
  const Bytes& body() const { return body_; }
  // Drops an incomplete frame.
  void clear();
  // Skips all bytes up to the next kEnd.
  void pass_over() { bad_ = true; }
  // Frames that were started and not returned: damaged, truncated or too long.
  std::uint64_t dropped() const { return dropped_; }

 private:
  bool end();
  void add(std::uint8_t byte);

  std::size_t most_;
  Bytes bytes_;  // body and CRC received so far
  Bytes body_;
  Crc32 crc_;
  bool escaped_ = false;
  bool bad_ = false;
  std::uint64_t dropped_ = 0;
};

}  // namespace trammel::frames
