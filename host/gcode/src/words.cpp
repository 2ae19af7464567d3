#include "words.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace trammel::gcode {
namespace {

// So that no sum or square of coordinates leaves the range of a double.
constexpr double kLargest = 1e12;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_printable(char c) { return c > ' ' && c < '\x7f'; }
bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }
char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

// After the comment that opens at `at`.
std::size_t skip_comment(std::string_view line, std::size_t at) {
  const std::size_t close = line.find(')', at);
  if (close == std::string_view::npos) {
    throw WordError{"comment without ')'"};
  }
  if (line.substr(at + 1, close - at - 1).find('(') != std::string_view::npos) {
    throw WordError{"'(' inside a comment"};
  }
  return close + 1;
}

// End of [+-] digits [. digits], which needs at least one digit.
std::size_t number_end(std::string_view line, std::size_t at) {
  if (at < line.size() && (line[at] == '+' || line[at] == '-')) {
    ++at;
  }
  std::size_t digits = 0;
  for (; at < line.size() && is_digit(line[at]); ++at) {
    ++digits;
  }
  if (at < line.size() && line[at] == '.') {
    for (++at; at < line.size() && is_digit(line[at]); ++at) {
      ++digits;
    }
  }
  return digits == 0 ? std::string_view::npos : at;
}

// The text of the malformed word, for the message: up to the next space or letter, without spaces at
// its end.
std::string_view malformed(std::string_view line, std::size_t from, std::size_t at) {
  while (at < line.size() && is_printable(line[at]) && !is_letter(line[at])) {
    ++at;
  }
  while (is_space(line[at - 1])) {
    --at;
  }
  return line.substr(from, at - from);
}

Word parse_word(std::string_view line, std::size_t& at) {
  const std::size_t from = at;
  ++at;
  while (at < line.size() && is_space(line[at])) {
    ++at;
  }
  const std::size_t end = number_end(line, at);
  constexpr std::string_view kMayFollow = "(;%";
  const bool followed = end < line.size() && is_printable(line[end]) && !is_letter(line[end]) &&
                        kMayFollow.find(line[end]) == std::string_view::npos;
  if (end == std::string_view::npos || followed) {
    throw WordError{fmt::format("malformed number in '{}'", malformed(line, from, at))};
  }
  const std::size_t digits = line[at] == '+' ? at + 1 : at;  // from_chars knows no plus sign
  double value = 0;
  const auto result = std::from_chars(line.data() + digits, line.data() + end, value, std::chars_format::fixed);
  if (result.ec != std::errc() || result.ptr != line.data() + end || std::abs(value) > kLargest) {
    throw WordError{fmt::format("number out of range in '{}'", line.substr(from, end - from))};
  }
  at = end;
  return Word{upper(line[from]), value, line.substr(from, end - from)};
}

}  // namespace

void split_words(std::string_view line, std::vector<Word>& words) {
  words.clear();
  std::size_t at = 0;
  while (at < line.size()) {
    const char c = line[at];
    if (is_space(c)) {
      ++at;
    } else if (c == ';') {
      return;
    } else if (c == '(') {
      at = skip_comment(line, at);
    } else if (is_letter(c)) {
      words.push_back(parse_word(line, at));
    } else {
      throw WordError{is_printable(c) ? fmt::format("unexpected '{}'", malformed(line, at, at + 1))
                                      : fmt::format("unexpected byte 0x{:02x}", static_cast<unsigned char>(c))};
    }
  }
}

int code_of(const Word& word) {
  const double tenths = word.value * 10;
  const double whole = std::round(tenths);
  // Tenths of a decimal fraction are off by a few ulps only.
  if (whole < 0 || whole > 9999 || std::abs(tenths - whole) > 1e-6) {
    throw WordError{fmt::format("unsupported word '{}'", word.text)};
  }
  return static_cast<int>(whole);
}

}  // namespace trammel::gcode
