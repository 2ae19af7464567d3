// Decodes a stream of a page: its bytes and its numbers.
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <string>
#include <vector>

namespace trammel::report {

inline std::string from_base64(const std::string& text) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(kDigits.find(c));
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes += static_cast<char>(bits >> held & 0xFF);
  }
  return bytes;
}

struct Elements {
  std::size_t count = 0;
  std::string bytes;
};

inline Elements elements(const std::string& page, const std::string& name) {
  const std::string begin = "<script type=\"text/plain\" data-stream=\"" + name + "\">";
  Elements found;
  for (std::size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at + 1)) {
    const std::size_t from = at + begin.size();
    found.bytes += from_base64(page.substr(from, page.find('<', from) - from));
    ++found.count;
  }
  return found;
}

inline std::string inflated(const std::string& bytes, std::size_t size) {
  std::string out(size + 1, '\0');
  auto length = static_cast<uLongf>(out.size());
  const int status = uncompress(reinterpret_cast<Bytef*>(out.data()), &length,
                                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()));
  EXPECT_EQ(status, Z_OK);
  out.resize(length);
  return out;
}

// Numbers of a stream that contains only varints.
inline std::vector<std::uint64_t> varints(const std::string& page, const std::string& name) {
  std::vector<std::uint64_t> numbers;
  std::uint64_t value = 0;
  unsigned shift = 0;
  for (const char byte : inflated(elements(page, name).bytes, 1 << 20)) {
    value |= std::uint64_t{static_cast<unsigned char>(byte) & 0x7FU} << shift;
    shift += 7;
    if ((static_cast<unsigned char>(byte) & 0x80U) != 0) continue;
    numbers.push_back(value);
    value = 0;
    shift = 0;
  }
  return numbers;
}

}  // namespace trammel::report
