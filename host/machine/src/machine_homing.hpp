// The tables [homing.<letter>] of a machine file.
#pragma once

#include <toml.hpp>

#include "numbers.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::machine {

// Sets the tables of [homing]; the machine's axes must be set before. Throws MachineError.
void set_homing(const Source& source, Machine& machine, const toml::table& axes);

// Throws MachineError if an axis cannot home as described: it has no input for its switch or index, no bound for its
// search, or velocities or positions outside its limits.
void check_homing(const Machine& machine);

}  // namespace trammel::machine
