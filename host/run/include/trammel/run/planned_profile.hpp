// The kind of speed profile of a run, and its reason. Pure.
#pragma once

#include <string>

#include "trammel/machine/machine.hpp"
#include "trammel/run/run_settings.hpp"

namespace trammel::run {

struct PlannedProfile {
  bool s_curve = false;      // S-curve; otherwise trapezoidal
  std::string without_jerk;  // letters of axes that make it trapezoidal; empty if the settings name a profile
};

PlannedProfile planned_profile(const machine::Machine& machine, const RunSettings& settings);

}  // namespace trammel::run
