// An axis's steps_per_mm from a measured distance, and its number in the machine file changed with all else kept byte
// for byte. The functions are pure, but for read_machine_text(), and thread-safe.
#pragma once

#include <cstddef>
#include <string>

#include "trammel/machine/machine.hpp"

namespace trammel::machine {

// As a machine file takes it: steps_per_mm * commanded / measured, in 7 digits, which is 0.1 um in a metre. Distances
// in mm (degrees for A, B and C), neither of them 0, of the same sign.
std::string calibrated_scale(double steps_per_mm, double commanded, double measured);

// The text of a machine file. Throws MachineError as load_machine() does where it cannot be read.
std::string read_machine_text(const std::string& path);

// A machine file's text in which one number was changed.
struct ChangedText {
  std::string text;
  std::size_t line = 0;     // of the number, from 1
  std::string line_is_now;  // the whole line, with its comment and without its end
};

// Writes `number` in the place of the axis's steps_per_mm. `letter` is in upper case, of an axis that the file has;
// `name` is the file's, for messages. Throws MachineError where the text is no machine file, or would not be one with
// this number.
ChangedText with_steps_per_mm(const std::string& text, const std::string& name, char letter, const std::string& number);

}  // namespace trammel::machine
