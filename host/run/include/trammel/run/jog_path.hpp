// The path of a jog, from where the machine stands to where it would end by itself. Pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "trammel/driver/card_timing.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/block.hpp"

namespace trammel::run {

struct JogPath {
  std::vector<driver::FeedCommand> pieces;
  std::uint64_t ticks = 0;   // feed ticks of the whole path
  std::uint8_t mask = 0;     // axes that move
  planner::Pulses pulses{};  // start to end
  double length = 0;         // mm along the path of all axes
  double speed = 0;          // mm/s along it at full ratio
  double ramp_seconds = 0;   // of the time base, from no ratio to full: half of each axis's acceleration at most
  // It begins at full rate: the time base makes its ramp. Else the pieces begin at rest.
  bool ramped_by_time_base = false;
  // Feed ticks that a stop takes at full ratio, as the time base makes it: of the pieces that do not end at rest too.
  std::uint32_t stop_distance = 0;
};

// Of its ticks those from `from` to `to`: a line that begins and ends at the pulse that is nearest there.
driver::LineCommand line_of(const JogPath& path, std::uint64_t from, std::uint64_t to);

// From `here`, pulses, in the direction of `velocity` (mm/s by axis) to the first soft limit, or as far as the counters
// go. Throws driver::ArgumentError where there is nothing to go.
JogPath jog_path(const machine::Machine& machine, const driver::CardTiming& card, const planner::Pulses& here,
                 const gcode::Coordinates& velocity);
// By `distance` (mm by axis), or to the first soft limit, at `speed` along the path, mm/s.
JogPath jog_path(const machine::Machine& machine, const driver::CardTiming& card, const planner::Pulses& here,
                 const gcode::Coordinates& distance, double speed);

}  // namespace trammel::run
