// Options of a run that neither the program nor the machine file gives. Plain data.
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
  // Machine position at the program's first line, machine coordinates in mm.
  gcode::Coordinates start{};
  // The run begins at the first command of this line. Earlier lines are planned and not executed; only the levels that
  // they leave at the outputs are set first. The run begins with a ramp of the card's ratio, so each path has the same
  // ticks as in the whole run.
  std::size_t first_line = 1;
  // If set, the run begins at this place, in the same way, and `first_line` has no effect. The machine is at
  // `position`.
  struct Place {
    PathPlace path;
    planner::Pulses position{};
  };
  std::optional<Place> place;
  // Present machine position, if it is known: a run that begins elsewhere is refused before any motion.
  std::optional<planner::Pulses> stands_at;
  planner::ArcsBy arcs = planner::ArcsBy::kGenerator;  // limited to the engines of the card
  planner::SpeedProfile profile = planner::SpeedProfile::kByMachine;
  planner::PathTicks ticks;   // initial value for a run that continues another: its Outcome::ticks
  bool single_block = false;  // each line ends in a stop; the next is sent when the card is idle
};

}  // namespace trammel::run
