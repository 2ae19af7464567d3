// Inputs that an option sets at a given card time.
#pragma once

#include <string>

#include "trammel/simulation/operation.hpp"

namespace trammel::app {

// Parses SECONDS:INPUT:LEVEL of --input-at; INPUT may be estop. Throws UsageError for malformed text.
simulation::OperatorEvent input_event(const std::string& text);

}  // namespace trammel::app
