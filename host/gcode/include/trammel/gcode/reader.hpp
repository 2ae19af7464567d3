// G-code reader: lines become motions in machine coordinates, one at a time, in memory that does not grow with the
// program. The meaning is LinuxCNC's (RS274/NGC). Where dialects differ:
//   - a value stands in the units that hold at the end of its line (G20 F10: inches per minute);
//   - E follows G90 and G91 like any axis until the program says M82 or M83, then those alone; bare G28 leaves E;
//   - G4 P is in seconds, and so is G4 S; a line with '/' is skipped (ReaderOptions);
//   - G28 takes axis letters without numbers; G31 is G38.3 for one line; O1234 before all words is no subroutine;
//   - M2, M30 or a '%' that does not open the program end it. What follows M2 and M30 is not read; beside a '%' and
//     behind the last one only blanks and comments may stand;
//   - lines of slicers for hardware that the card does not have are left out and told (ReaderOptions::left_out);
//   - M3 to M5 and M7 to M9 switch the outputs that the machine file names for them, before the line's motion, and M2
//     and M30 switch all of these off; other ends of the program leave them;
//   - a lower-case e right behind a number looks like an exponent, which G-code does not have: it is refused;
//   - Q of G64 (naive cam) has no effect and is told.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trammel/gcode/error.hpp"
#include "trammel/gcode/line_source.hpp"
#include "trammel/gcode/motion.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::gcode {

// A G or M word: M862.3 is {'M', 8623}.
struct CodeWord {
  char letter;
  int tenths;
};

// The operator's switches.
struct ReaderOptions {
  bool block_delete = true;  // lines with '/' are skipped; else they are lines like any other
  double feed_scale = 1;     // on every programmed feed, > 0; no motion's path depends on it
  // Words whose lines are left out beside those that always are, none of which why_not_left_out() speaks against.
  std::vector<CodeWord> left_out;
  // At a word that could be left out, read on to the end of the program: the error names all of these.
  bool name_all_unknown = false;
  // Numbered parameters before the first line: #1 to #5000, offsets and homes as LinuxCNC numbers them.
  std::map<int, double> parameters;
  // What holds before the first line: 30, 40 or 50 for M3, M4 or M5, whose outputs are so already, and S.
  int spindle = 50;
  double spindle_speed = 0;
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

  // False after the motion kEnd, and at the first error: then error() tells it. A line gives all of its motions or
  // none.
  bool next(Motion& motion);
  const std::optional<Error>& error() const;

  // Before the first next(): a program that ends before line `line` is an error.
  void must_reach(std::size_t line);

  // Words without effect yet and how often, so far, such as {"M3", 2}.
  const std::map<std::string, std::size_t>& accepted() const;
  // After a motion kProbe next() gives false, without an error, until one of the next two tells where it ended.
  bool awaits_probe() const;
  // Machine coordinates: where the probe's input changed, and where the machine stands. `tripped`: it did change.
  void probed(const Coordinates& edge, const Coordinates& rest, bool tripped);
  // For a check of the program before it runs: at the motion's target, but not known yet. What depends on it can only
  // be checked when it is reached (Motion::later).
  void assume_probed();
  // Lines so far that depend on assumed probes.
  std::size_t lines_on_probes() const;
  // Parameters, offsets and homes by number, those that are not 0.
  std::map<int, double> parameters() const;

  // For messages.
  const std::string& file() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

// Why lines that begin with a word are never left out: it moves the machine, or other lines depend on it. Empty where
// they can be.
std::string_view why_not_left_out(const CodeWord& word);

// Every word that the reader understands, as "G38.2", "X" or "M104"; and those that it refuses with a reason.
std::vector<std::string> known_words();
std::vector<std::string> refused_words();

}  // namespace trammel::gcode
