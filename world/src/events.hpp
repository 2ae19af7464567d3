// One line of a script. Internal to the library.
#pragma once

#include <string>

#include "trammel/world/description.hpp"

namespace trammel::world {

// "at 1.5 s press estop". Throws WorldError at that place.
Event parse_event(const std::string& text, const std::string& file, std::size_t line, const Description& world);

}  // namespace trammel::world
