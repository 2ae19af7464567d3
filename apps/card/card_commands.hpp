#pragma once

#include "common/command_line.hpp"

namespace trammel::app {

// Registers `trammel monitor`, `dump` and `selftest`: looks at a card.
void add_card_commands(CLI::App& app);

}  // namespace trammel::app
