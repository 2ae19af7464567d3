#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

// Registers `trammel line`.
void add_line_command(CLI::App& app);

}  // namespace trammel::app
