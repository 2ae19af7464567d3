// Text files named by the user. Internal to the library.
#pragma once

#include <string>

namespace trammel::world {

// Reads a file or a pipe. Throws WorldError if it cannot be read or is longer than kLongestWorldText. `what`: the kind
// of file, for the message.
std::string text_of_file(const std::string& path, const char* what);

}  // namespace trammel::world
