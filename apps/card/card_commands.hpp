#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

// Registers `trammel monitor`, `dump`, `selftest` and `drives`, which inspect a card or switch its drives.
void add_card_commands(CLI::App& app);

}  // namespace trammel::app
