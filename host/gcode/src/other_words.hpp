// Words of other controllers that the reader knows by name but does not obey, and their treatment. Internal to the
// reader.
#pragma once

#include <cstdint>
#include <string_view>

namespace trammel::gcode {

enum class Treatment : std::uint8_t {
  kLeftOut,       // nothing else on a line that begins with it is read; listed
  kText,          // the same, and the rest of the line is text for people
  kFullPercent,   // left out if the line has S100, else kRefused
  kRetraction,    // left out if only S follows: G10 and G11 of a printer
  kPrintersWait,  // left out if nothing follows and the program is for a printer
  kRefused,       // refused, unless the user leaves its lines out
  kNeverLeftOut,  // it moves the machine, or changes the meaning of later lines
};

// Always, or depending on the words after it.
constexpr bool is_left_out(Treatment treatment) {
  return treatment != Treatment::kRefused && treatment != Treatment::kNeverLeftOut;
}

struct OtherWord {
  char letter;
  int tenths;  // as code_of() gives it
  Treatment treatment;
  std::string_view why;  // reason for the refusal; empty if the name is reason enough
};

const OtherWord* begin_other_words();
const OtherWord* end_other_words();

// nullptr for a word that is not in the table.
const OtherWord* find_other_word(char letter, int tenths);

// The name of the Klipper command, such as START_PRINT, that the line begins with instead of words; empty for other
// lines.
std::string_view command_name(std::string_view line);

}  // namespace trammel::gcode
