// The parser state that Grbl reports with $G. Plain data.
#pragma once

#include <string>

namespace trammel::grbl {

struct Modal {
  int motion = 0;   // tenths: 0, 10, 20, 30, 382 .. 385, 800
  int system = 54;  // G54 .. G59
  int plane = 17;
  bool inches = false;
  bool absolute = true;
  bool inverse_time = false;
  int spindle = 5;  // M3, M4, M5
  bool mist = false;
  bool flood = false;
  int tool = 0;
  double feed = 0;         // mm/min
  double speed = 0;        // S
  double tool_length = 0;  // mm, G43.1 Z

  double mm_per_unit() const { return inches ? 25.4 : 1; }
};

// "G38.2" for 382.
std::string g_word(int tenths);
// "[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]"; `report_inches`: $13.
std::string parser_state(const Modal& modal, bool report_inches);
// Lines that bring the project's reader to this state, except motion mode, coordinate system and spindle.
std::string preamble(const Modal& modal);

}  // namespace trammel::grbl
