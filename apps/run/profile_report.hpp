// The text of `trammel run` about S-curves and trapezoids.
#pragma once

#include <string>
#include <vector>

#include "trammel/machine/machine.hpp"
#include "trammel/run/planned_profile.hpp"

namespace trammel::app {

const char* profile_name(const run::PlannedProfile& profile);  // as in --profile
std::string profile_text(const run::PlannedProfile& profile);  // one line

// A line for each axis whose acceleration would take more than a second to rise: its jerk is probably not in mm/s^3.
std::vector<std::string> jerk_warnings(const machine::Machine& machine);

}  // namespace trammel::app
