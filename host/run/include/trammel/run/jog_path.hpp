// The path of a jog, from the machine's present position to the point where the jog ends by itself. Pure functions.
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
  planner::Pulses pulses{};  // from start to end
  double length = 0;         // mm along the path of all axes
  double speed = 0;          // mm/s along the path at full ratio
  double ramp_seconds = 0;   // s, slew of the time base from ratio 0 to 1, at half of each axis's acceleration at most
  // The feed pieces begin at full rate and the time base makes the ramp. Otherwise the pieces begin at rest.
  bool ramped_by_time_base = false;
  // Feed ticks that a stop of the time base from full ratio takes; the value applies to all pieces of the path.
  std::uint32_t stop_distance = 0;
};

// The part of the path from feed tick `from` to feed tick `to`, as a line that begins and ends at the nearest pulses.
driver::LineCommand line_of(const JogPath& path, std::uint64_t from, std::uint64_t to);

// From `here` (pulses) in the direction of `velocity` (mm/s by axis) to the first soft limit, or as far as the counters
// reach. Throws driver::ArgumentError if the distance is zero.
JogPath jog_path(const machine::Machine& machine, const driver::CardTiming& card, const planner::Pulses& here,
                 const gcode::Coordinates& velocity);
// From `here` by `distance` (mm by axis) or to the first soft limit, at `speed` along the path, mm/s.
JogPath jog_path(const machine::Machine& machine, const driver::CardTiming& card, const planner::Pulses& here,
                 const gcode::Coordinates& distance, double speed);

}  // namespace trammel::run
