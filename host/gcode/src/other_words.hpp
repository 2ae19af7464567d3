// Words of other controllers that the reader knows by name but does not obey, and what becomes of them. Internal to the
// reader.
#pragma once

#include <cstdint>
#include <string_view>

namespace trammel::gcode {

enum class Treatment : std::uint8_t {
  kLeftOut,       // nothing of a line that begins with it is read; listed
  kText,          // the same; text for people stands behind it
  kFullPercent,   // left out with S100, else kRefused
  kRetraction,    // left out where S at most stands behind it: G10 and G11 of a printer
  kPrintersWait,  // left out where nothing stands behind it and the program is for a printer
  kRefused,       // unless the user leaves its lines out
  kNeverLeftOut,  // it moves the machine, or the lines behind it mean something else without it
};

// Always, or with some words behind it.
constexpr bool is_left_out(Treatment treatment) {
  return treatment != Treatment::kRefused && treatment != Treatment::kNeverLeftOut;
}

struct OtherWord {
  char letter;
  int tenths;  // as code_of() gives it
  Treatment treatment;
  std::string_view why;  // it is refused; empty where the name says all
};

const OtherWord* begin_other_words();
const OtherWord* end_other_words();

// nullptr for all words that the table does not name.
const OtherWord* find_other_word(char letter, int tenths);

// The name at the beginning of a line that is a command of Klipper, such as START_PRINT, and no words; empty for other
// lines.
std::string_view command_name(std::string_view line);

}  // namespace trammel::gcode
