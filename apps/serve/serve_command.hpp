#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

// Registers `trammel serve`.
void add_serve_command(CLI::App& app);

}  // namespace trammel::app
