// Parses one line of G-code by the rules of Grbl 1.1h: the words that it accepts, and the error numbers for those that
// it refuses. The project's reader interprets the coordinates of the line (interpreter.hpp). Pure functions.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "trammel/grbl/modal.hpp"
#include "trammel/grbl/numbers.hpp"

namespace trammel::grbl {

struct Block {
  std::string text;  // the line for the project's reader, one or two lines; empty if it has nothing to do
  Modal after;       // parser state after the line
  int line_number = 0;
  bool moves = false;    // axis motion or dwell
  bool outputs = false;  // spindle or coolant
  bool probe = false;
  bool probe_away = false;
  bool probe_must_trip = false;
  bool dwell = false;
  bool pause = false;    // M0
  bool end = false;      // M2, M30
  bool offsets = false;  // a coordinate offset changes

  // Whether Grbl answers ok only when the line and all earlier ones are done.
  bool waits() const { return probe || dwell || pause || end; }
};

// `line`: the result of cleaned(). `axes`: letters of the permitted axes.
Status parse_block(std::string_view line, const Modal& before, std::string_view axes, Block& block);

// Parses the text after "$J=": axis words, F, and G20, G21, G90, G91, G53 for this line only. `text` becomes one line
// of G1.
Status parse_jog(std::string_view line, const Modal& before, std::string_view axes, Block& block);

}  // namespace trammel::grbl
