// What a program leaves to the next one: parameters, offsets, homes and the tool in the spindle, by LinuxCNC's numbers.
// One "number value" a line, as in LinuxCNC's .var files.
#pragma once

#include <map>
#include <string>

namespace trammel::app {

// A file that is not there is an empty one. Throws UsageError, naming file and line, for what is no parameter.
std::map<int, double> load_parameters(const std::string& file);

// What load_parameters() reads as the same numbers.
std::string parameters_text(const std::map<int, double>& parameters);

}  // namespace trammel::app
