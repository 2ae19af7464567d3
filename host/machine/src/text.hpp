// Text of machine files, and of messages about it. Internal to the library.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "trammel/machine/one_line.hpp"

namespace trammel::machine {

// The name that takes the fewest changes of a letter to become `wrong`, or nothing where none has half of its
// letters.
std::string nearest(std::string_view wrong, const std::vector<std::string>& names);

// The first line, from 1, on which brackets or dotted keys nest deeper than `most`; 0: none does. A TOML reader that
// recurses would run out of stack on them.
std::size_t too_deep_line(std::string_view toml, std::size_t most);

// Of a name or a text within a message.
inline constexpr std::size_t kLongestQuote = 80;

// Throws a MachineError, its message made one line.
[[noreturn]] void refuse(const std::string& message);

// A little more than the longest text where the file is longer: a pipe may never end. Refuses what is no file or pipe.
std::string text_of_file(const std::string& path);

}  // namespace trammel::machine
