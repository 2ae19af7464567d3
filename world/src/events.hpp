// One line of a script of events. Internal to the library.
#pragma once

#include <string>

#include "trammel/world/description.hpp"

namespace trammel::world {

// Parses "at 1.5 s press estop". Throws WorldError with file and line.
Event parse_event(const std::string& text, const std::string& file, std::size_t line, const Description& world);

}  // namespace trammel::world
