// The table [inputs] of a machine file.
#pragma once

#include <string>
#include <toml.hpp>
#include <vector>

#include "numbers.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::machine {

// Throws MachineError: `key` of `table` ("axis.x.") is none of `names`.
[[noreturn]] void refuse_key(const Source& source, const toml::value& value, const std::string& table,
                             const std::string& key, const std::vector<std::string>& names);

// Entries of [inputs]; the machine's axes are known. Throws MachineError.
void set_inputs(const Source& source, Machine& machine, const toml::table& table);

// Throws MachineError where an input's roles want it normally open and closed, or where a ramp is asked for that the
// declared overtravel is too short for.
void check_inputs(const Machine& machine);

}  // namespace trammel::machine
