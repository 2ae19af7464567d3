#include "left_out.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "characters.hpp"
#include "word_set.hpp"

namespace trammel::gcode {
namespace {

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  return text;
}

// Reads a code in tenths and removes it from the text; -1 if there is none.
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

// Reads the word at the beginning of the line and removes it; `tenths` is -1 if there is none.
CodeWord word_at(std::string_view& line) {
  const char letter = line.empty() ? ' ' : upper(line.front());
  if (letter != 'M' && letter != 'G') return {letter, -1};
  line = without_blanks(line.substr(1));
  return {letter, code_at(line)};
}

// Of a text that begins with a digit. G4 and G04 give the same.
std::size_t first_two_digits(std::string_view text) {
  const auto first = static_cast<std::size_t>(text[0] - '0');
  return text.size() > 1 && is_digit(text[1]) ? first * 10 + static_cast<std::size_t>(text[1] - '0') : first;
}

// The line without its line number.
std::string_view without_number(std::string_view line) {
  if (line.empty() || upper(line.front()) != 'N') return line;
  std::string_view rest = without_blanks(line.substr(1));
  return code_at(rest) < 0 ? line : without_blanks(rest);
}

bool has_full_percent(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string_view number = without_blanks(text.substr(i + 1));
    if (upper(text[i]) == 'S' && code_at(number) == 1000) return true;
  }
  return false;
}

// Whether the treatment of a word leaves out its line; `rest` is the text after the word.
bool leaves_out(Treatment treatment, std::string_view rest, bool for_printers) {
  const std::string_view words = rest.substr(0, rest.find_first_of("(;"));
  switch (treatment) {
    case Treatment::kLeftOut:
    case Treatment::kText:
      return true;
    case Treatment::kFullPercent:
      return has_full_percent(words);
    case Treatment::kPrintersWait:
      return for_printers && without_blanks(words).empty();
    case Treatment::kRetraction:
      return words.find_first_not_of(" \tSs0123456789") == std::string_view::npos;
    default:
      return false;
  }
}

}  // namespace

std::string name_of(char letter, int tenths) {
  return tenths % 10 == 0 ? fmt::format("{}{}", letter, tenths / 10)
                          : fmt::format("{}{}.{}", letter, tenths / 10, tenths % 10);
}

LeftOut::LeftOut(const std::vector<CodeWord>& more) {
  for (const CodeWord& word : more) entries_.push_back({word, Treatment::kLeftOut, name_of(word.letter, word.tenths)});
  for (const OtherWord* word = begin_other_words(); word != end_other_words(); ++word) {
    if (!is_left_out(word->treatment)) continue;
    entries_.push_back({{word->letter, word->tenths}, word->treatment, name_of(word->letter, word->tenths)});
  }
  for (const Entry& entry : entries_) {
    if (entry.word.letter == 'G') g_numbers_.set(first_two_digits(std::string_view(entry.name).substr(1)));
  }
}

// A fast test of two digits: most lines of most programs begin with a G word, and few of those are left out.
bool LeftOut::may_begin(std::string_view line) const {
  const char letter = line.empty() ? ' ' : upper(line.front());
  if (letter != 'G') return letter == 'M' || letter == 'N';
  if (line.size() < 2 || !is_digit(line[1])) return line.size() >= 2 && is_space(line[1]);
  return g_numbers_.test(first_two_digits(line.substr(1)));
}

const LeftOut::Entry* LeftOut::entry_of(const CodeWord& word, std::string_view rest) const {
  const auto entry = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& known) {
    return known.word.letter == word.letter && known.word.tenths == word.tenths &&
           leaves_out(known.treatment, rest, for_printers_);
  });
  return entry != entries_.end() ? &*entry : nullptr;
}

bool LeftOut::find(std::string_view line, std::string_view& name, Problem& problem) {
  failed_ = false;
  if (!may_begin(line)) return false;
  line = without_number(line);
  const CodeWord word = word_at(line);
  const Entry* const entry = word.tenths < 0 ? nullptr : entry_of(word, line);
  if (entry == nullptr) return false;
  for_printers_ = true;
  name = entry->name;
  failed_ = !look_behind(line, *entry, problem);
  return true;
}

std::string LeftOut::unknown(std::string_view line) const {
  line = without_number(line);
  const CodeWord word = word_at(line);
  const bool known = word.tenths < 0 || has_effect(word) || entry_of(word, line) != nullptr;
  return known || !why_not_left_out(word).empty() ? std::string() : name_of(word.letter, word.tenths);
}

// Refuses G and M words after the first word. Allows other words of any kind, also without numbers, and texts in
// quotes.
bool LeftOut::look_behind(std::string_view rest, const Entry& entry, Problem& problem) {
  if (entry.treatment == Treatment::kText) return true;
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

std::vector<std::string> refused_words() {
  std::vector<std::string> words;
  for (const OtherWord* word = begin_other_words(); word != end_other_words(); ++word) {
    if (!is_left_out(word->treatment)) words.push_back(name_of(word->letter, word->tenths));
  }
  return words;
}

void add_left_out(std::vector<std::string>& words) {
  for (const OtherWord* word = begin_other_words(); word != end_other_words(); ++word) {
    if (is_left_out(word->treatment) && !has_effect({word->letter, word->tenths}))
      words.push_back(name_of(word->letter, word->tenths));
  }
}

}  // namespace trammel::gcode
