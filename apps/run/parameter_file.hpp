// The data that a program leaves for the next one: parameters, offsets, homes and the tool in the spindle, with
// LinuxCNC's numbers. One "number value" per line, as in LinuxCNC's .var files.
#pragma once

#include <map>
#include <string>

namespace trammel::app {

// A missing file counts as empty. Throws UsageError, naming file and line, for a line that is not a parameter.
std::map<int, double> load_parameters(const std::string& file);

// Text from which load_parameters() reads the same numbers.
std::string parameters_text(const std::map<int, double>& parameters);

}  // namespace trammel::app
