#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

// Registers `trammel world`.
void add_world_command(CLI::App& app);

}  // namespace trammel::app
