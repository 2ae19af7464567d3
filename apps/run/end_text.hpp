// The end position of a run as text for people. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "trammel/run/end_position.hpp"

namespace trammel::app {

// A line for each axis, "  X: ends at pulse 800 (10.0000 mm)". If two motors move an axis together: a line for each
// axis, "  X: ends at 10.0000 mm", and one for all motors, "  motors: at pulses 1600, 0, 0". `made`: pulses by motor,
// printed first; empty if they were not counted.
std::string end_text(const run::EndPosition& end, const std::vector<std::uint64_t>& made = {});

}  // namespace trammel::app
