// The computations and the output of `trammel calibrate`, from the text of a machine file.
#pragma once

#include <string>

#include "trammel/machine/machine.hpp"

namespace trammel::app {

struct Measured {
  std::string axis;      // as given: a letter of the machine, in either case
  double commanded = 0;  // mm, or degrees for A, B and C
  double actual = 0;     // measured distance
  bool force = false;    // accept a ratio outside 0.5 to 2
};

struct Calibration {
  std::string text;   // the machine file with the new scale
  std::string said;   // output for people: the result, and the new lines of the machine file
  std::string doubt;  // other values that may have been measured in the old scale; empty if there are none
  bool changed = false;
};

// `name`: of the machine file, for messages. Throws UsageError for distances from which no scale follows, and
// MachineError if the file is not valid before or after the change.
Calibration calibrate(const Measured& measured, const std::string& text, const std::string& name);

}  // namespace trammel::app
