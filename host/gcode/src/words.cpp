#include "words.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdint>

#include "characters.hpp"
#include "expression.hpp"

namespace trammel::gcode {
namespace {

// Whole numbers up to kExactWhole and these powers of ten are exact doubles. Their quotient is rounded only once, so it
// is the double nearest to the decimal number.
constexpr std::uint64_t kExactWhole = std::uint64_t{1} << 53;
constexpr std::array<double, 23> kPowersOfTen = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                                 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

bool is_printable(char c) { return c > ' ' && c < '\x7f'; }

// Appends the digits from `at` on to `whole`; returns where they end.
const char* add_digits(const char* at, const char* end, std::uint64_t& whole) {
  for (; at < end && is_digit(*at); ++at) {
    whole = whole * 10 + static_cast<std::uint64_t>(*at - '0');
  }
  return at;
}

}  // namespace

// A letter, blanks, [+-] digits [. digits] with one digit at least.
[[gnu::always_inline]] inline bool WordScanner::parse(Word& word, Problem& problem) {
  const char* const text = line_.data();
  const char* const end = text + line_.size();
  const char* at = text + at_ + 1;
  while (at < end && is_space(*at)) {
    ++at;
  }
  const char* const number = at;
  const bool negative = at < end && *at == '-';
  at += at < end && (negative || *at == '+') ? 1 : 0;
  const char* const first = at;
  std::uint64_t whole = 0;  // all digits as one number; overflows above 19 digits
  at = add_digits(at, end, whole);
  auto digits = static_cast<std::size_t>(at - first);
  std::size_t decimals = 0;
  if (at < end && *at == '.') {
    const char* const point = at + 1;
    at = add_digits(point, end, whole);
    decimals = static_cast<std::size_t>(at - point);
    digits += decimals;
  }
  const std::size_t from = at_;
  at_ = static_cast<std::size_t>((digits == 0 ? number : at) - text);
  if (digits == 0 && starts_expression(line_.substr(at_))) {
    return expression(from, word, problem);
  }
  if (digits == 0 && is_bare(from)) {
    word = Word{upper(text[from]), 0, std::string_view(text + from, 1), false, true};
    return true;
  }
  if (digits == 0 || (at < end && !is_space(*at) && !may_follow(*at))) {
    return at < end && digits != 0 && *at == 'e' ? exponent(from, problem) : malformed(from, problem);
  }
  double value = 0;
  if (digits <= 18 && whole <= kExactWhole) {
    value = static_cast<double>(whole);
    value = decimals == 0 ? value : value / kPowersOfTen[decimals];
  } else if (!convert(static_cast<std::size_t>(first - text), at_, value)) {
    return out_of_range(from, problem);
  }
  if (value > kLargestValue) {
    return out_of_range(from, problem);
  }
  word = Word{upper(text[from]), negative ? -value : value, std::string_view(text + from, at_ - from)};
  return true;
}

bool WordScanner::next(Word& word, Problem& problem) {
  while (at_ < line_.size()) {
    const char c = line_[at_];
    if (is_letter(c)) {
      failed_ = c == 'O' || c == 'o' ? !o_word(problem) : !parse(word, problem);
      return !failed_;
    }
    if (c == ';') {
      return false;
    }
    if (is_space(c)) {
      ++at_;
    } else if (c == '#') {
      if (!assignment(problem)) {
        failed_ = true;
        return false;
      }
    } else if (c != '(') {
      failed_ = true;
      return unexpected(problem);
    } else if (!skip_comment(problem)) {
      failed_ = true;
      return false;
    }
  }
  return false;
}

bool WordScanner::skip_comment(Problem& problem) {
  const std::size_t close = line_.find(')', at_);
  if (close == std::string_view::npos) {
    return problem.set(ErrorCode::kCommentNotClosed, "comment without ')'");
  }
  if (line_.substr(at_ + 1, close - at_ - 1).find('(') != std::string_view::npos) {
    return problem.set(ErrorCode::kCommentInComment, "'(' inside a comment");
  }
  at_ = close + 1;
  return true;
}

// at_ is at the value; `from` is the word's letter.
bool WordScanner::expression(std::size_t from, Word& word, Problem& problem) {
  ExpressionReader reader(line_, at_, parameters_);
  Value value;
  if (!reader.value(value, problem)) {
    return false;
  }
  at_ = reader.at();
  word = Word{upper(line_[from]), value.value, line_.substr(from, at_ - from), value.later};
  return true;
}

bool WordScanner::assignment(Problem& problem) {
  ExpressionReader reader(line_, at_, parameters_);
  if (!reader.assignment(parameters_, problem)) {
    return false;
  }
  at_ = reader.at();
  return true;
}

bool WordScanner::o_word(Problem& problem) const {
  std::string_view text = line_.substr(at_, line_.find_first_of("(;", at_) - at_);
  while (is_space(text.back())) text.remove_suffix(1);
  return problem.set(ErrorCode::kOWord,
                     fmt::format("O-word '{}': subroutines, loops and branches are not supported: let the CAM program "
                                 "write their lines out",
                                 quote(text)));
}

bool WordScanner::unexpected(Problem& problem) const {
  const char c = line_[at_];
  if (c == '%') {
    return problem.set(ErrorCode::kTextBesidePercent, "'%' beside other words: it needs a line of its own");
  }
  if (!is_printable(c)) {
    return problem.set(ErrorCode::kUnexpectedCharacter,
                       fmt::format("unexpected byte 0x{:02x}", static_cast<unsigned char>(c)));
  }
  if (c == '$') {
    return problem.set(ErrorCode::kUnexpectedCharacter,
                       fmt::format("'{}' is a setting or command for Grbl, no word of a program: remove the line",
                                   quote(line_.substr(at_, line_.find_first_of(" \t(;", at_) - at_))));
  }
  if (c == '@' || c == '^') {
    return problem.set(ErrorCode::kUnexpectedCharacter,
                       fmt::format("'{}': no polar coordinates: let the CAM program write X and Y", c));
  }
  std::size_t end = at_ + 1;
  while (end < line_.size() && is_printable(line_[end]) && !is_letter(line_[end])) {
    ++end;
  }
  return problem.set(ErrorCode::kUnexpectedCharacter,
                     fmt::format("unexpected '{}'", quote(line_.substr(at_, end - at_))));
}

// Whether a character other than a blank may follow a number directly. A lower-case e may not: programs print exponents
// with it (1.5e-05). Read as two words, that would move the axis E.
bool WordScanner::may_follow(char c) {
  return (is_letter(c) && c != 'e') || c == '(' || c == ';' || c == '%' || !is_printable(c);
}

bool WordScanner::out_of_range(std::size_t from, Problem& problem) const {
  return problem.set(ErrorCode::kNumberOutOfRange,
                     fmt::format("number out of range in '{}'", quote(line_.substr(from, at_ - from))));
}

// For more digits than a double holds exactly. std::from_chars rounds only once, too.
bool WordScanner::convert(std::size_t from, std::size_t end, double& value) const {
  const char* const last = line_.data() + end;
  const auto result = std::from_chars(line_.data() + from, last, value, std::chars_format::fixed);
  // Too small for a double: 0 is the nearest.
  if (result.ec == std::errc::result_out_of_range) {
    const std::string_view text = line_.substr(from, end - from);
    value = 0;
    return text.substr(0, text.find('.')).find_first_not_of('0') == std::string_view::npos;
  }
  return result.ec == std::errc() && result.ptr == last;
}

// Whether the letter has no number; at_ is after the letter and the blanks that follow it.
bool WordScanner::is_bare(std::size_t letter) const {
  if (at_ == line_.size() || line_[at_] == ';' || line_[at_] == '(') return true;
  return is_letter(line_[at_]) && at_ > letter + 1;
}

// The message quotes from the word's letter to the next blank or letter.
bool WordScanner::malformed(std::size_t from, Problem& problem) const {
  std::size_t end = at_;
  while (end < line_.size() && is_printable(line_[end]) && !is_letter(line_[end])) {
    ++end;
  }
  while (is_space(line_[end - 1])) {
    --end;
  }
  return problem.set(ErrorCode::kMalformedNumber,
                     fmt::format("malformed number in '{}'", quote(line_.substr(from, end - from))));
}

bool WordScanner::exponent(std::size_t from, Problem& problem) const {
  std::size_t end = at_ + 1;
  while (end < line_.size() && is_printable(line_[end]) && !is_letter(line_[end])) {
    ++end;
  }
  return problem.set(ErrorCode::kExponent,
                     fmt::format("malformed number in '{}': write it without exponent; before an axis e put a blank",
                                 quote(line_.substr(from, end - from))));
}

int code_of(double value) {
  const double tenths = value * 10;
  if (!(tenths >= 0 && tenths < 100'000)) {
    return -1;
  }
  const int whole = static_cast<int>(tenths + 0.5);
  const double off = tenths - whole;
  // The tenths of a decimal fraction are off by a few ulps only.
  return off > 1e-6 || off < -1e-6 ? -1 : whole;
}

}  // namespace trammel::gcode
