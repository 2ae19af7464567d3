// Words of one line of G-code. Internal to the reader.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trammel::gcode {

// Every "file:line" is added by the caller.
struct WordError {
  std::string message;
};

struct Word {
  char letter;            // upper case
  double value;           // finite
  std::string_view text;  // as written, for messages
};

// The words of a line without its comments; numbers are decimal, without exponent. Throws WordError.
void split_words(std::string_view line, std::vector<Word>& words);

// The code of a G or M word in tenths (G91.1 is 911). Throws WordError when it is no code.
int code_of(const Word& word);

}  // namespace trammel::gcode
