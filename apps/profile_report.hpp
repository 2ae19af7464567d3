// How the speed changes, and why so: what `trammel run` says of S-curves and trapezoids.
#pragma once

#include <string>
#include <vector>

#include "trammel/machine/machine.hpp"
#include "trammel/run/run_settings.hpp"

namespace trammel::app {

struct ProfileReport {
  bool s_curve = false;
  std::string without_jerk;  // letters of the axes for which it is a trapezoid; empty where one was asked for
};

ProfileReport profile_of(const machine::Machine& machine, const run::RunSettings& settings);

const char* name_of(const ProfileReport& profile);  // as of --profile
std::string summary(const ProfileReport& profile);  // a line

// A line an axis whose acceleration would take more than a second to rise: most likely not mm/s^3.
std::vector<std::string> jerk_warnings(const machine::Machine& machine);

}  // namespace trammel::app
