// How the speed changes, and why so: what `trammel run` says of S-curves and trapezoids.
#pragma once

#include <string>
#include <vector>

#include "trammel/machine/machine.hpp"
#include "trammel/run/planned_profile.hpp"

namespace trammel::app {

const char* profile_name(const run::PlannedProfile& profile);  // as of --profile
std::string profile_text(const run::PlannedProfile& profile);  // a line

// A line an axis whose acceleration would take more than a second to rise: most likely not mm/s^3.
std::vector<std::string> jerk_warnings(const machine::Machine& machine);

}  // namespace trammel::app
