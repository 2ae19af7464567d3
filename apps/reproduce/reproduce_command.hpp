// `trammel reproduce`: reproduces every table and figure of both papers.
#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

void add_reproduce_command(CLI::App& app);

}  // namespace trammel::app
