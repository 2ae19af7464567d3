#pragma once

#include <string>

#include "common/command_line.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::app {

// Registers `trammel machine`.
void add_machine_command(CLI::App& app);

// The output of `trammel machine --check`: the stopping distances of each axis, and how limit switches stop the
// machine.
std::string stop_text(const machine::Machine& machine);

}  // namespace trammel::app
