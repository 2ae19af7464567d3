// How far a machine goes on while it stops: what limit switches, soft limits and jogs need. Pure functions, of a
// machine file alone.
#pragma once

#include <optional>
#include <vector>

#include "trammel/machine/machine.hpp"

namespace trammel::machine {

// Of an axis at its max_velocity v; mm, or degrees for A, B and C. T is hold_seconds(): from full speed to rest.
struct StopWay {
  double ramp = 0;  // v * T / 2
  // Of an axis with a limit switch: what it goes while the filter and a scan of the inputs last.
  std::optional<double> filter;

  // Behind the switch, until it stands.
  double behind_switch() const { return filter.value_or(0) + ramp; }
};
// By axis of the machine.
std::vector<StopWay> stop_ways(const Machine& machine);

// Whether the ramp of an axis fits behind its switch; true where it has none.
bool ramp_fits(const StopWay& way, const MachineAxis& axis);

}  // namespace trammel::machine
