// The entries of a world file, as parts of a description. Internal to the library.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "table.hpp"
#include "trammel/world/description.hpp"

namespace trammel::world {

// The contents of a file with the lines of its parts, for messages about the whole.
struct Reading {
  Description world;
  std::vector<std::pair<std::string, std::size_t>> lines;  // name of the part ("switch x_minus", "axis X") and line
};

// Each throws WorldError. Call read_axes() first and read_events() last, because other entries refer to axes, and
// events to buttons.
void read_axes(Table& root, Reading& reading);
void read_switch(Table& table, Reading& reading);
void read_button(Table& table, Reading& reading);
void read_events(Table& root, Reading& reading);

}  // namespace trammel::world
