// Lines of slicers for hardware that the card does not have: heaters, fans, displays, limits of a printer's firmware.
// Such a line begins with its word, and nothing else of it is read. Internal to the reader.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "problem.hpp"

namespace trammel::gcode {

// "G59.3" or "M104".
std::string name_of(char letter, int tenths);

class LeftOut {
 public:
  // `more`: codes of further M words, in tenths.
  explicit LeftOut(const std::vector<int>& more);

  // Whether the line (without blanks before it) is such a line; `name` is then its word, until the next call. With a
  // problem where it has more G or M words: these would be lost.
  bool find(std::string_view line, std::string_view& name, Problem& problem);
  // Of the last line that find() has found: there was a problem.
  bool failed() const { return failed_; }

 private:
  struct Entry {
    char letter;
    int tenths;
    bool text;  // the rest is text for people
    std::string name;
  };
  bool look_behind(std::string_view rest, const Entry& entry, Problem& problem);

  std::vector<Entry> entries_;
  bool failed_ = false;
};

// To a list of words: those that are always left out.
void add_left_out(std::vector<std::string>& words);

}  // namespace trammel::gcode
