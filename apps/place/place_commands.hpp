// `trammel position`, `zero` and `recover`: the machine's place, which a card outside keeps.
#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

void add_place_commands(CLI::App& app);

}  // namespace trammel::app
