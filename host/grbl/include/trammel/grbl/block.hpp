// One line of G-code as Grbl 1.1h reads it: which words it takes, which it refuses and by which number. What the line
// does with coordinates is the project's reader's (interpreter.hpp). Pure functions.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "trammel/grbl/modal.hpp"
#include "trammel/grbl/numbers.hpp"

namespace trammel::grbl {

struct Block {
  std::string text;  // the same for the project's reader, one line or two; empty: nothing is left for it
  Modal after;       // the state behind it
  int line_number = 0;
  bool moves = false;    // axis motion, a dwell
  bool outputs = false;  // spindle or coolant
  bool probe = false;
  bool probe_away = false;
  bool probe_must_trip = false;
  bool dwell = false;
  bool pause = false;    // M0
  bool end = false;      // M2, M30
  bool offsets = false;  // a coordinate offset changes

  // Grbl answers ok only when all before it, and it, are done.
  bool waits() const { return probe || dwell || pause || end; }
};

// `line`: cleaned(). `axes`: letters that may be used.
Status parse_block(std::string_view line, const Modal& before, std::string_view axes, Block& block);

// What stands behind "$J=": axis words, F, and G20, G21, G90, G91, G53 for this line alone. `text` is one line of G1.
Status parse_jog(std::string_view line, const Modal& before, std::string_view axes, Block& block);

}  // namespace trammel::grbl
