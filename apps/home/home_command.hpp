// `trammel home`: axes find their switches, and machine zero is set from them.
#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

void add_home_command(CLI::App& app);

}  // namespace trammel::app
