// Distances that a machine needs to stop, for the choice of limit switches, soft limits and jogs. Pure functions of a
// machine file.
#pragma once

#include <optional>
#include <vector>

#include "trammel/machine/machine.hpp"

namespace trammel::machine {

// Stopping distance of an axis from its max_velocity v; mm, or degrees for A, B and C. T is hold_seconds(), the time
// from full speed to rest.
struct StopWay {
  double ramp = 0;  // v * T / 2
  // For an axis with a limit switch: the distance during the filter and a scan of the inputs.
  std::optional<double> filter;

  // Total distance from the switch to rest.
  double behind_switch() const { return filter.value_or(0) + ramp; }
};
// By axis of the machine.
std::vector<StopWay> stop_ways(const Machine& machine);

// Whether the stopping distance of an axis fits into its overtravel; true for an axis without a limit switch.
bool ramp_fits(const StopWay& way, const MachineAxis& axis);

}  // namespace trammel::machine
