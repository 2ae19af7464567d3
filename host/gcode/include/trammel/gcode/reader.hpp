// G-code reader: lines become motions in machine coordinates, one at a time, in memory that does not grow with the
// program. The meaning is LinuxCNC's (RS274/NGC). Where dialects differ:
//   - a value stands in the units that hold at the end of its line (G20 F10: inches a minute);
//   - E follows G90 and G91 like any axis until the program says M82 or M83, then those alone; bare G28 leaves E;
//   - G4 P is in seconds; a line with '/' is skipped (ReaderOptions);
//   - M2, M30 or a '%' that does not open the program end it. What follows M2 and M30 is not read; beside a '%' and
//     behind the last one only blanks and comments may stand;
//   - M3 to M5 and M7 to M9 switch the outputs that the machine file names for them, before the line's motion, and M2
//     and M30 switch all of these off; other ends of the program leave them;
//   - a lower-case e right behind a number is taken for an exponent, which G-code has not, and refused;
//   - Q of G64 (naive cam) has no effect and is told.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "trammel/gcode/error.hpp"
#include "trammel/gcode/line_source.hpp"
#include "trammel/gcode/motion.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::gcode {

// Switches of the operator's.
struct ReaderOptions {
  bool block_delete = true;  // lines with '/' are skipped; else they are lines like any other
  double feed_scale = 1;     // on every programmed feed, > 0; no motion's path depends on it
};

// Not thread-safe; allocates nothing after its first lines.
class Reader {
 public:
  // `start` is where the machine stands. Lines and machine must outlive the reader.
  Reader(LineSource& lines, const machine::Machine& machine, const Coordinates& start = {},
         const ReaderOptions& options = {});
  ~Reader();
  Reader(Reader&&) noexcept;
  Reader& operator=(Reader&&) noexcept;

  // False after the motion kEnd, and at the first thing that is not understood or not allowed: then error() says what.
  // A line gives all of its motions or none.
  bool next(Motion& motion);
  const std::optional<Error>& error() const;

  // Before the first next(): reads up to line `line`, which comes next, for modes, position and outputs alone (a first
  // motion kOutput makes these what they would be). False, with an error, at the first thing that is not understood,
  // and where the program ends before that line.
  bool skip_to(std::size_t line);
  // Where the motions read so far end, machine coordinates.
  const Coordinates& position() const;

  // Words without effect yet and how often, so far, such as {"M3", 2}.
  const std::map<std::string, std::size_t>& accepted() const;
  // For messages.
  const std::string& file() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trammel::gcode
