#include "trammel/gcode/error.hpp"

#include <fmt/format.h>

namespace trammel::gcode {
namespace {

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == '\x7f'; }

std::string escaped(char c) {
  switch (c) {
    case '\t':
      return "\\t";
    case '\n':
      return "\\n";
    case '\r':
      return "\\r";
    default:
      return fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  }
}

}  // namespace

std::string describe(const Error& error) {
  // A file may be named in any script, but not with what would break the line.
  std::string file;
  for (const char c : error.file) {
    file += is_control(c) ? escaped(c) : std::string(1, c);
  }
  return fmt::format("{}:{}: {}", file, error.line, error.message);
}

std::string quote(std::string_view text) {
  constexpr std::string_view kCut = "...";
  std::string quoted;
  for (const char c : text) {
    const bool plain = !is_control(c) && static_cast<unsigned char>(c) < 0x80;
    quoted += plain ? std::string(1, c) : escaped(c);
    if (quoted.size() > kLongestQuote) {
      // Escapes are cut too: what is left is still one line.
      quoted.resize(kLongestQuote - kCut.size());
      return quoted.append(kCut);
    }
  }
  return quoted;
}

}  // namespace trammel::gcode
