// `trammel home`: axes find their switches, and with them machine zero.
#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

void add_home_command(CLI::App& app);

}  // namespace trammel::app
