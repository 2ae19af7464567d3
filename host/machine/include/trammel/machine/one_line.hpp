// Prepares untrusted text, such as a file name, for a message.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace trammel::machine {

// Converts the text to one line of valid UTF-8, cut to `most` bytes (at least 3). Control characters and bytes that are
// not UTF-8 become escapes (\n, \t, \r, \x1b).
std::string one_line(std::string_view text, std::size_t most);

// Longest file name in a message, bytes.
inline constexpr std::size_t kLongestName = 500;

}  // namespace trammel::machine
