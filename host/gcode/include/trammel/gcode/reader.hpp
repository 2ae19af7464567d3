// G-code reader: turns lines into motions in machine coordinates, one at a time, in memory that does not grow with the
// program. G-code has the meaning that LinuxCNC gives it (RS274/NGC). Decisions where dialects differ:
//   - a value is in the units that are in force at the end of its line (G20 F10: inches per minute);
//   - E follows G90 and G91 like any axis until the program says M82 or M83, and only these from then on; G28 without
//     axis letters does not move E;
//   - G4 P is in seconds, and so is G4 S; a line with '/' is skipped (ReaderOptions);
//   - G28 takes axis letters without numbers; G31 is G38.3 for one line; O1234 before all words is a program number,
//     not a subroutine;
//   - M2, M30 or a '%' that does not open the program end it. Lines after M2 and M30 are not read; on the line of a
//     '%', and after the last one, only blanks and comments are allowed;
//   - lines of slicers for hardware that the card does not have are left out and reported (ReaderOptions::left_out);
//   - M3 to M5 and M7 to M9 switch the outputs that the machine file names for them, before the line's motion. M2 and
//     M30 switch all of these off; other ends of the program do not;
//   - a lower-case e directly after a number looks like an exponent, which G-code does not have: it is refused;
//   - Q of G64 (naive cam) has no effect and is reported.
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
  bool block_delete = true;  // skip lines that begin with '/'; else read them like any other
  double feed_scale = 1;     // factor on every programmed feed, > 0; it changes no path
  // Words whose lines are left out, in addition to the words of the reader's own table. why_not_left_out() must be
  // empty for each of them.
  std::vector<CodeWord> left_out;
  // At a word that could be left out, read on to the end of the program, so that the error names all such words.
  bool name_all_unknown = false;
  // Values of numbered parameters before the first line: #1 to #5000, offsets and homes as LinuxCNC numbers them.
  std::map<int, double> parameters;
  // Spindle state before the first line: 30, 40 or 50 for M3, M4 or M5 (the outputs already have this state), and S.
  int spindle = 50;
  double spindle_speed = 0;
};

// Not thread-safe; allocates no memory after the first lines.
class Reader {
 public:
  // `start`: position of the machine. Lines and machine must outlive the reader.
  Reader(LineSource& lines, const machine::Machine& machine, const Coordinates& start = {},
         const ReaderOptions& options = {});
  ~Reader();
  Reader(Reader&&) noexcept;
  Reader& operator=(Reader&&) noexcept;

  // Gets the next motion. Returns false after the motion kEnd and at the first error, which error() then describes. A
  // line gives all of its motions or none.
  bool next(Motion& motion);
  const std::optional<Error>& error() const;

  // Before the first next(): makes it an error if the program ends before line `line`.
  void must_reach(std::size_t line);

  // Words accepted without effect, such as {"M3", 2}, with their count so far.
  const std::map<std::string, std::size_t>& accepted() const;
  // After a motion kProbe, next() returns false without an error until probed() or assume_probed() tells where the
  // probe ended.
  bool awaits_probe() const;
  // Machine coordinates: `edge`, where the probe's input changed, and `rest`, where the machine is. `tripped`: the
  // input did change.
  void probed(const Coordinates& edge, const Coordinates& rest, bool tripped);
  // For a check of the program before it runs: the probe ends at its target, as an assumption. Lines that depend on it
  // can only be checked when they are reached (Motion::later).
  void assume_probed();
  // The number of lines so far that depend on assumed probes.
  std::size_t lines_on_probes() const;
  // Parameters, offsets and homes by number; without those that are 0.
  std::map<int, double> parameters() const;

  // Name of the source, for messages.
  const std::string& file() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

// The reason why lines that begin with this word are never left out: it moves the machine, or other lines depend on it.
// Empty if they can be left out.
std::string_view why_not_left_out(const CodeWord& word);

// All words that the reader understands, such as "G38.2", "X" or "M104"; and those that it refuses with a reason.
std::vector<std::string> known_words();
std::vector<std::string> refused_words();

}  // namespace trammel::gcode
