// A run's result for people and for programs.
#pragma once

#include <string>

#include "program_run.hpp"

namespace trammel::app {

// Some lines of text, units in every one.
std::string summary(const RunResult& result);

// Throws std::runtime_error when the file cannot be written; "-" is standard output.
void write_json(const RunResult& result, const std::string& file);

}  // namespace trammel::app
