// The entries of a world file, as parts of a description. Internal to the library.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "table.hpp"
#include "trammel/world/description.hpp"

namespace trammel::world {

// What is in a file, and where: for messages about the whole.
struct Reading {
  Description world;
  std::vector<std::pair<std::string, std::size_t>> lines;  // of "switch x_minus", "axis X"
};

// Each throws WorldError. The axes come first, and the events last: they name what is there.
void read_axes(Table& root, Reading& reading);
void read_switch(Table& table, Reading& reading);
void read_button(Table& table, Reading& reading);
void read_events(Table& root, Reading& reading);

}  // namespace trammel::world
