#pragma once

#include <string>

#include "common/command_line.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::app {

// Registers `trammel machine`.
void add_machine_command(CLI::App& app);

// What `trammel machine --check` prints: for each axis the ways that stops take, and how limit switches stop.
std::string stop_text(const machine::Machine& machine);

}  // namespace trammel::app
