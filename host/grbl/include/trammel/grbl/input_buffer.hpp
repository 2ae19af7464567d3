// Buffers a sender's bytes: real-time commands are executed at once, the rest waits as lines. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace trammel::grbl {

// Buffer size that senders assume: the number of bytes that may be sent before the answer to the first line.
inline constexpr std::size_t kReceiveBuffer = 128;
// Grbl's line buffer: a line with more bytes, not counting blanks and comments, is error:11.
inline constexpr std::size_t kLongestLine = 79;

class InputBuffer {
 public:
  // `realtime` is called for '?', '!', '~', 0x18 and 0x80 .. 0xFF. 0xC2 (the first UTF-8 byte of 0x80 .. 0xBF) is
  // dropped.
  explicit InputBuffer(std::function<void(std::uint8_t)> realtime) : realtime_(std::move(realtime)) {}

  // Bytes beyond kMost waiting bytes are dropped, as Grbl drops those beyond its 128.
  void put(std::string_view bytes);
  // The next line without its end; CR LF ends one line. A line that is too long is returned whole; cleaned() cuts it.
  std::optional<std::string> take();
  void clear();
  bool has_bytes() const { return !waiting_.empty(); }

  // Number of bytes that a sender may add now without loss, at most kReceiveBuffer.
  std::size_t room() const;

  // Larger than kReceiveBuffer, so that a client that sends without counting does not lose bytes soon.
  static constexpr std::size_t kMost = 65536;

 private:
  void keep(char c);

  std::function<void(std::uint8_t)> realtime_;
  std::string waiting_;
  bool after_return_ = false;
};

// Converts a line as Grbl does before it parses it: removes blanks, control characters, comments and '/', and converts
// letters to upper case. A line that begins with '%' becomes empty. A line of more than kLongestLine bytes is cut after
// kLongestLine + 1.
std::string cleaned(std::string_view line);

}  // namespace trammel::grbl
