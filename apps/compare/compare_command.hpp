// trammel compare: all methods side by side, on one curve or over random lines.
#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

void add_compare_command(CLI::App& app);

}  // namespace trammel::app
