// `trammel calibrate`: computes steps_per_mm from a measured distance and writes it to the machine file.
#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

void add_calibrate_command(CLI::App& app);

}  // namespace trammel::app
