// What a run may do otherwise than the program and the machine file say. Plain data.
#pragma once

#include <cstddef>

#include "trammel/gcode/reader.hpp"
#include "trammel/planner/card_limits.hpp"
#include "trammel/planner/planner.hpp"

namespace trammel::run {

struct RunSettings {
  gcode::ReaderOptions reader;
  // Where the machine stands at the program's first line, machine coordinates in mm.
  gcode::Coordinates start{};
  // Lines before it are read for their modes and positions alone: the machine stands where they end.
  std::size_t first_line = 1;
  planner::ArcsBy arcs = planner::ArcsBy::kGenerator;  // and what the card has
  planner::SpeedProfile profile = planner::SpeedProfile::kByMachine;
  bool single_block = false;  // each line of the program ends in a stop, and the next is sent when the card is idle
};

}  // namespace trammel::run
