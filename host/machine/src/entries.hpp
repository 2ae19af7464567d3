// Reads entries of a machine file that are not numbers, and refuses unknown names. Each function throws a MachineError
// with file and line.
#pragma once

#include <string>
#include <toml.hpp>
#include <vector>

#include "numbers.hpp"

namespace trammel::machine {

// Refuses `key` of `table` ("axis.x."), which is not one of `names`.
[[noreturn]] void refuse_key(const Source& source, const toml::value& value, const std::string& table,
                             const std::string& key, const std::vector<std::string>& names);

// The value, which must be one of `words`.
std::string word(const Source& source, const std::string& path, const toml::value& value,
                 const std::vector<std::string>& words);

bool true_or_false(const Source& source, const std::string& path, const toml::value& value);

}  // namespace trammel::machine
