// The tables [outputs] and [spindle] of a machine file.
#pragma once

#include <toml.hpp>

#include "numbers.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::machine {

// Entries of [outputs]; the machine's axes are known. Throws MachineError, also where entries do not go together.
void set_outputs(const Source& source, Machine& machine, const toml::table& table);

// Entries of [spindle], likewise.
void set_spindle(const Source& source, Machine& machine, const toml::table& table);

}  // namespace trammel::machine
