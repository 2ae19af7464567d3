// Text from outside, such as a file's name, for a message.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace trammel::machine {

// One line of valid UTF-8: control characters and bytes that are no UTF-8 as escapes (\n, \t, \r, \x1b), cut to `most`
// bytes, at least 3.
std::string one_line(std::string_view text, std::size_t most);

// Of a file's name.
inline constexpr std::size_t kLongestName = 500;

}  // namespace trammel::machine
