// `trammel steps`: the steps of one method on one curve.
#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

void add_steps_command(CLI::App& app);

}  // namespace trammel::app
