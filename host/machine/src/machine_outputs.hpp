// The tables [outputs] and [spindle] of a machine file.
#pragma once

#include <toml.hpp>

#include "numbers.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::machine {

// Sets the entries of [outputs]; the machine's axes must be set before. Throws MachineError, also for entries that
// contradict each other.
void set_outputs(const Source& source, Machine& machine, const toml::table& table);

// Sets the entries of [spindle], under the same conditions.
void set_spindle(const Source& source, Machine& machine, const toml::table& table);

}  // namespace trammel::machine
