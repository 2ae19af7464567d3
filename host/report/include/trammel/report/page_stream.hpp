// A stream of bytes in a page: deflated (zlib's format), in base64, divided into as many script elements as necessary.
// Several streams can thus be written concurrently in bounded memory. Not thread-safe.
//
//     <script type="text/plain" data-stream="NAME">base64</script>
//
// Each base64 text of a stream's elements decodes to bytes; in order, these bytes form the deflated stream.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "trammel/run/text_sink.hpp"

namespace trammel::report {

class PageStream {
 public:
  // `name`: letters, digits and '-'. The sink must outlive the stream.
  PageStream(run::TextSink& sink, std::string name);
  ~PageStream();
  PageStream(const PageStream&) = delete;
  PageStream& operator=(const PageStream&) = delete;

  void bytes(std::string_view text);
  // 7 bits per byte, the lowest first; the highest bit indicates that more bytes follow.
  void varint(std::uint64_t value);
  // Encodes 0, -1, 1, -2, ... as 0, 1, 2, 3, ...
  void zigzag(std::int64_t value) {
    const auto bits = static_cast<std::uint64_t>(value);
    varint(bits << 1 ^ (value < 0 ? ~std::uint64_t{0} : 0));
  }
  // Little endian.
  void number(float value);
  void number(double value);
  // Writes the rest; nothing may follow.
  void finish();

 private:
  struct Deflate;
  void append(const void* data, std::size_t size);
  void little_endian(std::uint64_t bits, std::size_t size);
  void drain(int flush);
  void write_element();

  run::TextSink& sink_;
  std::string name_;
  std::unique_ptr<Deflate> deflate_;
  std::vector<unsigned char> pending_;   // bytes not yet deflated
  std::vector<unsigned char> deflated_;  // bytes not yet written
};

// The bytes as base64 text, with '=' at the end where necessary.
std::string base64(const unsigned char* data, std::size_t size);

}  // namespace trammel::report
