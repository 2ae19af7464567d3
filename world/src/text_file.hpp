// Texts that a user names. Internal to the library.
#pragma once

#include <string>

namespace trammel::world {

// Of a file or a pipe. Throws WorldError: it cannot be read, or is longer than kLongestWorldText. `what` it should be,
// for the message.
std::string text_of_file(const std::string& path, const char* what);

}  // namespace trammel::world
