// The motions of a program, one at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "trammel/card_map.hpp"

namespace trammel::gcode {

// By axis index of the machine; machine coordinates in mm (degrees for A, B and C).
using Coordinates = std::array<double, card_map::kMaxAxes>;

enum class MotionKind { kTraverse, kLine, kArc, kDwell, kEnd, kOutput, kProbe };

// How the corner at the motion's end is passed.
enum class PathControl : std::uint8_t {
  kContinuous,  // G64: passed at speed
  kExactPath,   // G61: passed at speed where the path has no corner, else a stop
  kExactStop,   // G61.1
};

struct Motion {
  MotionKind kind = MotionKind::kLine;
  std::size_t line = 0;  // of the source, from 1
  Coordinates target{};  // where it ends, kProbe: at the latest; kDwell, kEnd and kOutput: where the one before ended
  // Axes whose target depends on a probe that has not run, bit n: axis n. It is what it would be if the probe tripped
  // at its target.
  std::uint8_t later = 0;
  double feed = 0;     // mm/s along the path; 0 for kTraverse and where `seconds` counts
  double seconds = 0;  // kDwell, or the duration of a motion under G93
  PathControl path_control = PathControl::kContinuous;
  double tolerance = 0;    // mm, G64 P: how far the path may be left in corners
  bool clockwise = false;  // the rest: kArc; seen with the plane's first axis to the right and the second up
  bool full_circle = false;
  std::uint8_t axis_x = 0;  // of the plane: X Y, Z X or Y Z
  std::uint8_t axis_y = 0;
  double centre_x = 0;  // machine coordinates
  double centre_y = 0;
  std::uint32_t turns = 0;  // full turns beyond the first way to the end; axes outside the plane move evenly: a helix
  std::uint16_t set = 0;    // kOutput: outputs that are switched on, before the motion behind it; bit n: output n
  std::uint16_t clear = 0;  // and off
  // What S asks for in it, 0 .. 1 of max_s: the spindle's pulses, 0 where it is off and where a laser is dark.
  double power = 0;
  bool power_follows = false;    // the speed on the path: at the motion's feed it is `power`
  bool awaits_spindle = false;   // kDwell: what comes behind it waits until the spindle is at speed
  bool probe_away = false;       // kProbe: until the probe is free, else until it is touched
  bool probe_must_trip = false;  // a way to the target without that is an error
};

}  // namespace trammel::gcode
