// A card that another host has left. Not thread-safe.
#pragma once

#include <optional>

#include "trammel/driver/card.hpp"

namespace trammel::run {

// Ends a hold that stands, and drops what is left of a path on which the card holds: its predecessor's. Gives back the
// state at rest where something was dropped. Throws driver::StateError, and changes nothing, where the card moves:
// somebody else moves it.
std::optional<driver::Snapshot> take_over(driver::Card& card);

}  // namespace trammel::run
