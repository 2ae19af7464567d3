// Inputs that an option sets at a time of the card.
#pragma once

#include <string>

#include "trammel/simulation/operation.hpp"

namespace trammel::app {

// SECONDS:INPUT:LEVEL of --input-at, where INPUT may be estop; UsageError for what is malformed.
simulation::OperatorEvent input_event(const std::string& text);

}  // namespace trammel::app
