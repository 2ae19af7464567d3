#include "trammel/machine/one_line.hpp"

#include <fmt/format.h>

namespace trammel::machine {
namespace {

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80; }

// Size in bytes of the UTF-8 character at the beginning of `text`; 0 if it is not valid. By RFC 3629 only the shortest
// form is valid, without surrogates, up to U+10FFFF.
std::size_t character_size(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  const std::size_t size = first < 0x80                     ? 1
                           : first >= 0xc2 && first <= 0xdf ? 2
                           : first >= 0xe0 && first <= 0xef ? 3
                           : first >= 0xf0 && first <= 0xf4 ? 4
                                                            : 0;
  if (size == 0 || text.size() < size) return 0;
  for (std::size_t i = 1; i < size; ++i) {
    if (!continues(text[i])) return 0;
  }
  const auto second = static_cast<unsigned char>(size > 1 ? text[1] : 0);
  const bool too_long = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool beyond = (first == 0xed && second > 0x9f) || (first == 0xf4 && second > 0x8f);
  return too_long || beyond ? 0 : size;
}

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

std::string one_line(std::string_view text, std::size_t most) {
  constexpr std::string_view kCut = "...";
  std::string result;
  std::size_t before_cut = 0;  // size to which the result is cut
  while (!text.empty()) {
    const std::size_t size = character_size(text);
    const bool control = static_cast<unsigned char>(text[0]) < 0x20 || text[0] == '\x7f';
    result += size == 0 || control ? escaped(text[0]) : std::string(text.substr(0, size));
    text.remove_prefix(size == 0 ? 1 : size);
    if (result.size() > most) return result.substr(0, before_cut).append(kCut);
    if (result.size() + kCut.size() <= most) before_cut = result.size();
  }
  return result;
}

}  // namespace trammel::machine
