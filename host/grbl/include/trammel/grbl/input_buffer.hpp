// A sender's bytes: real-time commands are taken out at once, the rest waits as lines. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace trammel::grbl {

// What senders count on: so many bytes may be under way before the answer to the first line.
inline constexpr std::size_t kReceiveBuffer = 128;
// Grbl's line buffer: one more byte in a line, blanks and comments aside, is error:11.
inline constexpr std::size_t kLongestLine = 79;

class InputBuffer {
 public:
  // Called for '?', '!', '~', 0x18 and 0x80 .. 0xFF; a 0xC2 (UTF-8's first byte of 0x80 .. 0xBF) is dropped.
  explicit InputBuffer(std::function<void(std::uint8_t)> realtime) : realtime_(std::move(realtime)) {}

  // Bytes beyond kMost that wait are dropped, as Grbl drops those beyond its 128.
  void put(std::string_view bytes);
  // The next line without its end; CR LF ends one line. Of a line that is too long, kLongestLine + 1 bytes.
  std::optional<std::string> take();
  void clear();
  bool has_bytes() const { return !waiting_.empty(); }

  // Bytes that a sender may add now without one being dropped, at most kReceiveBuffer.
  std::size_t room() const;

  // More than kReceiveBuffer, so that a client that sends without counting loses nothing soon.
  static constexpr std::size_t kMost = 65536;

 private:
  void keep(char c);

  std::function<void(std::uint8_t)> realtime_;
  std::string waiting_;
  bool after_return_ = false;
};

// A line as Grbl's parser gets it: without blanks, control characters, comments and '/', letters in upper case; a line
// that begins with '%' is empty. More than kLongestLine bytes are cut off behind one of them.
std::string cleaned(std::string_view line);

}  // namespace trammel::grbl
