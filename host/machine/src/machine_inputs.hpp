// The table [inputs] of a machine file.
#pragma once

#include <string>
#include <toml.hpp>

#include "numbers.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::machine {

// Sets the entries of [inputs]; the machine's axes must be set before. Throws MachineError.
void set_inputs(const Source& source, Machine& machine, const toml::table& table);

// Throws MachineError if the roles of an input require both normally open and normally closed, or if a ramp is
// requested for which the declared overtravel is too short.
void check_inputs(const Machine& machine);

}  // namespace trammel::machine
