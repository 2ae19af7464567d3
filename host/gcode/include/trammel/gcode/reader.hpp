// G-code reader: a whole program becomes a list of motions in machine coordinates, checked before anything moves.
// The meaning is LinuxCNC's (RS274/NGC). Where dialects differ:
//   - a value stands in the units that hold at the end of its line (G20 F10: inches a minute);
//   - E follows G90 and G91 like any axis until the program says M82 or M83, then those alone; bare G28 leaves E;
//   - G4 P is in seconds; a line with '/' is skipped; M2, M30 or a second '%' end the program;
//   - G61 and G64 are accepted: the planner stops exactly at every end of a motion, which satisfies both.
// Pure and thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::gcode {

// what() is "file:line: message".
class ProgramError : public std::runtime_error {
 public:
  ProgramError(const std::string& file, std::size_t line, const std::string& message);
  const std::string& file() const { return file_; }
  std::size_t line() const { return line_; }
  const std::string& message() const { return message_; }

 private:
  std::string file_;
  std::size_t line_;
  std::string message_;
};

// By axis index of the machine; machine coordinates in mm (degrees for A, B and C).
using Coordinates = std::array<double, card_map::kMaxAxes>;

enum class MotionKind { kTraverse, kLine, kArc, kDwell, kEnd };

struct Motion {
  MotionKind kind = MotionKind::kLine;
  std::size_t line = 0;    // of the source, from 1
  Coordinates target{};    // all but kDwell and kEnd
  double feed = 0;         // mm/s along the path; 0 for kTraverse and where `seconds` counts
  double seconds = 0;      // kDwell, or the duration of a motion under G93
  bool clockwise = false;  // the rest: kArc; seen with the plane's first axis to the right and the second up
  bool full_circle = false;
  std::uint8_t axis_x = 0;  // of the plane: X Y, Z X or Y Z
  std::uint8_t axis_y = 0;
  double centre_x = 0;  // machine coordinates
  double centre_y = 0;
};

struct Program {
  std::string file;
  Coordinates start{};
  std::vector<Motion> motions;                  // the last one is kEnd
  std::map<std::string, std::size_t> accepted;  // words without effect yet and how often, such as {"M3", 2}
};

// Reads `text`; `file` names it in messages; `start` is where the machine stands.
// Throws ProgramError for the first thing that is not understood or not allowed.
Program read_program(std::string_view text, const std::string& file, const machine::Machine& machine,
                     const Coordinates& start = {});

// As read_program; an unreadable file is a ProgramError at line 0.
Program read_program_file(const std::string& path, const machine::Machine& machine, const Coordinates& start = {});

}  // namespace trammel::gcode
