// `trammel linuxcnc`: owns a card for LinuxCNC's realtime modules.
#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

void add_linuxcnc_command(CLI::App& app);

}  // namespace trammel::app
