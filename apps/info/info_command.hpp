#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

// Registers `trammel info`.
void add_info_command(CLI::App& app);

}  // namespace trammel::app
