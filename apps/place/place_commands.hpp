// `trammel position`, `zero` and `recover`: the machine's place, which an external card keeps.
#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

void add_place_commands(CLI::App& app);

}  // namespace trammel::app
