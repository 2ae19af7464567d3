// Where a command that moves a card outside begins, told before anything moves.
#pragma once

#include "trammel/run/card_place.hpp"

namespace trammel::app {

// A note on standard error: that machine zero is here since the card was reset, or where the machine stands, and which
// soft limits are off; nothing at machine zero with all limits.
void tell_of_start(const run::Start& start, const run::CardPlace& found);

}  // namespace trammel::app
