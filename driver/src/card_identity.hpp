// A card's identification: read when it is opened, and checked later.
#pragma once

#include "trammel/driver/bus.hpp"
#include "trammel/driver/card_timing.hpp"
#include "trammel/driver/identification.hpp"
#include "trammel/driver/low_level/card_parts.hpp"

namespace trammel::driver {

// As Card::open(). Writes nothing.
Identification read_identification(Bus& bus);
// The timing of a card that read_identification() has accepted.
CardTiming read_timing(Bus& bus, const Identification& card);

// Throws LinkError if the device is no longer a card, StateError if its step times are not those that were set.
void check_identity(CardParts& card);

Build read_build(Registers& registers);

}  // namespace trammel::driver
