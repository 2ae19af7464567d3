// Reports the starting position of a command that moves an external card, before any motion.
#pragma once

#include "trammel/run/card_place.hpp"

namespace trammel::app {

// Prints a note on standard error: that machine zero is at the present position because the card was reset, or the
// machine's position; and which soft limits are off. Prints nothing at machine zero with all limits.
void tell_of_start(const run::Start& start, const run::CardPlace& found);

}  // namespace trammel::app
