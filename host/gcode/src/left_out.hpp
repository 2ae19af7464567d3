// Lines for hardware that the card does not have (heaters, fans, displays, limits of a printer's firmware), and lines
// that the user names. Such a line begins with a word of the table; nothing else on it is read. Internal to the reader.
#pragma once

#include <bitset>
#include <string>
#include <string_view>
#include <vector>

#include "other_words.hpp"
#include "problem.hpp"
#include "trammel/gcode/reader.hpp"

namespace trammel::gcode {

// "G59.3" or "M104".
std::string name_of(char letter, int tenths);

class LeftOut {
 public:
  // `more`: words in addition to the table.
  explicit LeftOut(const std::vector<CodeWord>& more);

  // Whether the line, given without blanks before it, is such a line; `name` is then its word, valid until the next
  // call. Sets a problem if the line has more G or M words, because these would be lost.
  bool find(std::string_view line, std::string_view& name, Problem& problem);
  // Whether find() set a problem for the last line that it found.
  bool failed() const { return failed_; }
  // Whether the program is for a printer's firmware: find() has found a line, or the program has words for an extruder.
  bool for_printers() const { return for_printers_; }
  void set_for_printers() { for_printers_ = true; }
  // The word at the beginning of the line if it is unknown and `more` may name it; else empty.
  std::string unknown(std::string_view line) const;

 private:
  struct Entry {
    CodeWord word;
    Treatment treatment;
    std::string name;
  };
  bool may_begin(std::string_view line) const;
  const Entry* entry_of(const CodeWord& word, std::string_view rest) const;
  bool look_behind(std::string_view rest, const Entry& entry, Problem& problem);

  std::vector<Entry> entries_;
  std::bitset<100> g_numbers_;  // the first two digits of the G words
  bool failed_ = false;
  bool for_printers_ = false;
};

// Adds the words whose lines are always left out.
void add_left_out(std::vector<std::string>& words);

}  // namespace trammel::gcode
