// The tables [homing.<letter>] of a machine file.
#pragma once

#include <toml.hpp>

#include "numbers.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::machine {

// Tables of [homing]; the machine's axes are known. Throws MachineError.
void set_homing(const Source& source, Machine& machine, const toml::table& axes);

// Throws MachineError where an axis cannot home as it says: no input for its switch or index, no bound for its search,
// velocities or places that the axis does not allow.
void check_homing(const Machine& machine);

}  // namespace trammel::machine
