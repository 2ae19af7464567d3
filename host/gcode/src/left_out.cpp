#include "left_out.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "characters.hpp"

namespace trammel::gcode {
namespace {

constexpr int kBedLevelling = 290;
constexpr int kMessage = 1170;
constexpr int kAlways[] = {730, 1040, 1050, 1060, 1070, 1090, 1100, kMessage, 1400, 1900, 2010, 2020, 2030, 2040, 2050};

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  return text;
}

// A code in tenths, and the text behind it; -1 where there is none.
int code_at(std::string_view& text) {
  constexpr int kLargest = 100'000;
  int tenths = 0;
  std::size_t at = 0;
  for (; at < text.size() && is_digit(text[at]) && tenths < kLargest; ++at) tenths = tenths * 10 + (text[at] - '0');
  if (at == 0) return -1;
  tenths *= 10;
  if (at + 1 < text.size() && text[at] == '.' && is_digit(text[at + 1])) {
    tenths += text[at + 1] - '0';
    at += 2;
  }
  if (at < text.size() && (is_digit(text[at]) || text[at] == '.')) return -1;
  text.remove_prefix(at);
  return tenths;
}

// The line's number.
std::string_view without_number(std::string_view line) {
  if (line.empty() || upper(line.front()) != 'N') return line;
  std::string_view rest = without_blanks(line.substr(1));
  return code_at(rest) < 0 ? line : without_blanks(rest);
}

}  // namespace

std::string name_of(char letter, int tenths) {
  return tenths % 10 == 0 ? fmt::format("{}{}", letter, tenths / 10)
                          : fmt::format("{}{}.{}", letter, tenths / 10, tenths % 10);
}

LeftOut::LeftOut(const std::vector<int>& more) {
  const auto add = [&](char letter, int tenths) {
    entries_.push_back({letter, tenths, tenths == kMessage, name_of(letter, tenths)});
  };
  add('G', kBedLevelling);
  for (const int tenths : kAlways) add('M', tenths);
  for (const int tenths : more) add('M', tenths);
}

bool LeftOut::find(std::string_view line, std::string_view& name, Problem& problem) {
  failed_ = false;
  line = without_number(line);
  const char letter = line.empty() ? ' ' : upper(line.front());
  if (letter != 'M' && letter != 'G') return false;
  std::string_view rest = without_blanks(line.substr(1));
  if (letter == 'G' && rest.substr(0, 2) != "29") return false;
  const int tenths = code_at(rest);
  const auto entry = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& known) { return known.letter == letter && known.tenths == tenths; });
  if (entry == entries_.end()) return false;
  name = entry->name;
  failed_ = !look_behind(rest, *entry, problem);
  return true;
}

// Words of any kind, also without numbers and with texts in quotes; not what moves.
bool LeftOut::look_behind(std::string_view rest, const Entry& entry, Problem& problem) {
  if (entry.text) return true;
  bool quoted = false;
  int depth = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const char c = rest[i];
    if (c == '"') quoted = !quoted && depth == 0;
    if (quoted) continue;
    if (c == ';' && depth == 0) break;
    depth += c == '(' ? 1 : c == ')' && depth > 0 ? -1 : 0;
    const bool begins = i == 0 || !is_letter(rest[i - 1]);
    const char letter = upper(c);
    if (depth > 0 || !begins || (letter != 'G' && letter != 'M')) continue;
    std::string_view number = without_blanks(rest.substr(i + 1));
    if (code_at(number) < 0) continue;
    return problem.set(ErrorCode::kBesideLeftOut, fmt::format("'{}' beside {}, whose line is left out",
                                                              quote(without_blanks(rest.substr(i))), entry.name));
  }
  return true;
}

void add_left_out(std::vector<std::string>& words) {
  words.push_back(name_of('G', kBedLevelling));
  for (const int tenths : kAlways) words.push_back(name_of('M', tenths));
}

}  // namespace trammel::gcode
