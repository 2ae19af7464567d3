// What a run may do otherwise than the program and the machine file say. Plain data.
#pragma once

#include <cstddef>
#include <optional>

#include "trammel/gcode/reader.hpp"
#include "trammel/planner/block.hpp"
#include "trammel/planner/card_limits.hpp"
#include "trammel/planner/planner.hpp"
#include "trammel/run/replay.hpp"

namespace trammel::run {

struct RunSettings {
  gcode::ReaderOptions reader;
  // Where the machine stands at the program's first line, machine coordinates in mm.
  gcode::Coordinates start{};
  // The run begins at the first command of this line. Those before it are planned and left out; the outputs that they
  // leave are set first. The run begins with a ramp of the card's ratio, so each path has its ticks of the whole run.
  std::size_t first_line = 1;
  // The run begins at this place, in the same way, and `first_line` means nothing. The machine stands at `position`.
  struct Place {
    PathPlace path;
    planner::Pulses position{};
  };
  std::optional<Place> place;
  // Where the machine stands, if it is known: a run that begins elsewhere is refused before anything moves.
  std::optional<planner::Pulses> stands_at;
  planner::ArcsBy arcs = planner::ArcsBy::kGenerator;  // and what the card has
  planner::SpeedProfile profile = planner::SpeedProfile::kByMachine;
  planner::PathTicks ticks;   // where the run goes on with a program of which Outcome::ticks told
  bool single_block = false;  // each line of the program ends in a stop, and the next is sent when the card is idle
};

}  // namespace trammel::run
