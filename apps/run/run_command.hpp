#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

// Registers `trammel run`.
void add_run_command(CLI::App& app);

}  // namespace trammel::app
