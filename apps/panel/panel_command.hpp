// `trammel panel`: the machine in a browser.
#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

void add_panel_command(CLI::App& app);

}  // namespace trammel::app
