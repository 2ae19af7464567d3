// `trammel methods`: lists the interpolators and their abilities.
#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

void add_methods_command(CLI::App& app);

}  // namespace trammel::app
