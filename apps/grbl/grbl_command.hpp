#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

// `trammel grbl`: a Grbl 1.1 controller in front of a card.
void add_grbl_command(CLI::App& app);

}  // namespace trammel::app
