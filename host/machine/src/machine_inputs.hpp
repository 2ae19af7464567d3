// The table [inputs] of a machine file.
#pragma once

#include <string>
#include <toml.hpp>

#include "numbers.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::machine {

// Entries of [inputs]; the machine's axes are known. Throws MachineError.
void set_inputs(const Source& source, Machine& machine, const toml::table& table);

// Throws MachineError where an input's roles want it normally open and closed, or where a ramp is asked for that the
// declared overtravel is too short for.
void check_inputs(const Machine& machine);

}  // namespace trammel::machine
