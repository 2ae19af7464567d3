// Paths in pulses to geometry and feed commands. Internal to the planner.
#pragma once

#include <cstdint>

#include "trammel/planner/planner.hpp"

namespace trammel::planner {

struct PathContext {
  const machine::Machine& machine;
  std::uint32_t clock_hz;
};

// An arc before rounding: machine coordinates in mm.
struct ExactArc {
  double radius_start;
  double radius_end;
  double angle_start;  // radians, from the plane's first axis towards its second
  double sweep;        // radians, > 0
};

ExactArc exact_arc(const gcode::Motion& motion, const gcode::Coordinates& from);

// Each fills in the segment's commands and duration from its start and end. False: there is nothing to step.
bool plan_line(const PathContext& context, const gcode::Motion& motion, PlannedSegment& segment);
bool plan_arc(const PathContext& context, const gcode::Motion& motion, const gcode::Coordinates& from,
              PlannedSegment& segment);

// mm (or degrees) to pulses, half away from zero. Sums of decimal fractions miss a half by some 1e-13: they count as
// it.
std::int64_t to_pulses(double mm, double steps_per_mm);

}  // namespace trammel::planner
