// Where a run ends, for people. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "trammel/machine/machine.hpp"

namespace trammel::app {

// By axis of the machine: mm (degrees).
std::vector<double> end_millimetres(const machine::Machine& machine, const std::vector<std::int64_t>& pulses);

// A line for each axis, "  X: ends at pulse 800 (10.0000 mm)"; where two motors move an axis together, a line for each
// axis, "  X: ends at 10.0000 mm", and one for all motors, "  motors: at pulses 1600, 0, 0". `made`: pulses made by
// motor, told first; empty where nobody counted.
std::string end_text(const std::string& axes, const std::vector<std::int64_t>& pulses,
                     const std::vector<double>& millimetres, bool joint_for_each_axis,
                     const std::vector<std::uint64_t>& made = {});

}  // namespace trammel::app
