// Computes an axis's steps_per_mm from a measured distance, and changes that number in the text of a machine file; all
// other bytes stay the same. All functions are thread-safe, and pure except read_machine_text().
#pragma once

#include <cstddef>
#include <string>

#include "trammel/machine/machine.hpp"

namespace trammel::machine {

// The new scale in the format of a machine file: steps_per_mm * commanded / measured, in 7 digits, which is 0.1 um per
// metre. Distances in mm (degrees for A, B and C), both nonzero and of the same sign.
std::string calibrated_scale(double steps_per_mm, double commanded, double measured);

// The text of a machine file. If it cannot be read, throws MachineError as load_machine() does.
std::string read_machine_text(const std::string& path);

// A machine file's text in which one number was changed.
struct ChangedText {
  std::string text;
  std::size_t line = 0;     // line of the number, from 1
  std::string line_is_now;  // the whole new line, with its comment, without its line end
};

// Replaces the axis's steps_per_mm by `number`. `letter`: upper case, of an axis in the file. `name`: name of the file,
// for messages. Throws MachineError if the text is not a valid machine file before or after the change.
ChangedText with_steps_per_mm(const std::string& text, const std::string& name, char letter, const std::string& number);

}  // namespace trammel::machine
