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
  // The machine stands at `start`, and nowhere else: a first line that begins elsewhere is refused. Otherwise the
  // machine is taken to stand where that line begins.
  bool start_is_known = false;
  // Lines before it are read for their modes and positions alone.
  std::size_t first_line = 1;
  planner::ArcsBy arcs = planner::ArcsBy::kGenerator;  // and what the card has
  planner::SpeedProfile profile = planner::SpeedProfile::kByMachine;
  bool single_block = false;  // each line of the program ends in a stop, and the next is sent when the card is idle
};

}  // namespace trammel::run
