// How the speed of a run changes along the path, and why so. Pure.
#pragma once

#include <string>

#include "trammel/machine/machine.hpp"
#include "trammel/run/run_settings.hpp"

namespace trammel::run {

struct PlannedProfile {
  bool s_curve = false;      // otherwise trapezoids
  std::string without_jerk;  // letters of the axes for which it is a trapezoid; empty where the settings name a profile
};

PlannedProfile planned_profile(const machine::Machine& machine, const RunSettings& settings);

}  // namespace trammel::run
