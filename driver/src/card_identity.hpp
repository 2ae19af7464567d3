// Who a card is: read when it is opened, and compared later.
#pragma once

#include "trammel/driver/bus.hpp"
#include "trammel/driver/card_timing.hpp"
#include "trammel/driver/identification.hpp"
#include "trammel/driver/low_level/card_parts.hpp"

namespace trammel::driver {

// As Card::open(). Writes nothing.
Identification read_identification(Bus& bus);
// Of a card that read_identification() has taken.
CardTiming read_timing(Bus& bus, const Identification& card);

// Throws LinkError if what answers is no card any more, StateError if it has other step times than it was given.
void check_identity(CardParts& card);

Build read_build(Registers& registers);

}  // namespace trammel::driver
