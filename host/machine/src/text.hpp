// Reads the text of machine files, and prepares text for messages. Internal to the library.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "trammel/machine/one_line.hpp"

namespace trammel::machine {

// The name that needs the fewest letter changes to become `wrong`, at most half of the letters of the longer one; empty
// if there is none.
std::string nearest(std::string_view wrong, const std::vector<std::string>& names);

// The first line, from 1, on which brackets or dotted keys nest deeper than `most`; 0: none. A recursive TOML reader
// would overflow its stack on such a text.
std::size_t too_deep_line(std::string_view toml, std::size_t most);

// Longest name or text within a message, bytes.
inline constexpr std::size_t kLongestQuote = 80;

// Throws a MachineError with the message converted to one line.
[[noreturn]] void refuse(const std::string& message);

// Reads the file. If it is longer than the longest machine text, reads only a little more than that, because a pipe may
// never end. Refuses anything except a file or a pipe.
std::string text_of_file(const std::string& path);

}  // namespace trammel::machine
