#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

// Registers `trammel jog`: moves axes of an external card by hand, by a distance or with the keys of a terminal.
void add_jog_command(CLI::App& app);

}  // namespace trammel::app
