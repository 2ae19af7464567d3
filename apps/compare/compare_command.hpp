// `trammel compare`: compares all methods on one curve or on random lines.
#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

void add_compare_command(CLI::App& app);

}  // namespace trammel::app
