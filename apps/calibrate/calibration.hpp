// What `trammel calibrate` computes and says, of the text of a machine file.
#pragma once

#include <string>

#include "trammel/machine/machine.hpp"

namespace trammel::app {

struct Measured {
  std::string axis;      // as it was given: a letter of the machine, in either case
  double commanded = 0;  // mm, or degrees for A, B and C
  double actual = 0;     // as measured
  bool force = false;    // take a ratio outside 0.5 to 2, too
};

struct Calibration {
  std::string text;   // the machine file with the new scale
  std::string said;   // what came out, lines for people; the lines of the machine file as they are to be
  std::string doubt;  // what else was measured in the old scale; empty when nothing was
  bool changed = false;
};

// `name` is the machine file's, for messages. Throws UsageError for distances that tell nothing, MachineError where the
// file is none or would be none with the new scale.
Calibration calibrate(const Measured& measured, const std::string& text, const std::string& name);

}  // namespace trammel::app
