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
  // End of the motion. kProbe: the farthest possible end. kDwell, kEnd, kOutput: the position, which does not change.
  Coordinates target{};
  // Axes whose target depends on a probe that has not run, bit n: axis n. Until then `target` assumes that the probe
  // trips at its own target.
  std::uint8_t later = 0;
  double feed = 0;     // mm/s along the path; 0 for kTraverse and if `seconds` counts
  double seconds = 0;  // of a kDwell, or of a motion under G93
  PathControl path_control = PathControl::kContinuous;
  double tolerance = 0;  // mm, P of G64: the largest deviation from the path in corners
  // The fields from here to `turns` are of a kArc. Clockwise as seen with the plane's first axis to the right, its
  // second up.
  bool clockwise = false;
  bool full_circle = false;
  std::uint8_t axis_x = 0;  // axes of the plane: X Y, Z X or Y Z
  std::uint8_t axis_y = 0;
  double centre_x = 0;  // machine coordinates
  double centre_y = 0;
  // Full turns after the arc first reaches its end. Axes outside the plane move evenly: a helix.
  std::uint32_t turns = 0;
  std::uint16_t set = 0;    // kOutput: outputs switched on before the next motion; bit n: output n
  std::uint16_t clear = 0;  // kOutput: outputs switched off
  // Duty of the spindle's pulses in this motion: S / max_s, 0 .. 1; 0 while the spindle is off or the laser is dark.
  double power = 0;
  bool power_follows = false;    // the duty follows the speed and is `power` at the feed
  bool awaits_spindle = false;   // kDwell: the next motion waits until the spindle is at speed
  bool probe_away = false;       // kProbe: moves until the probe is free, else until it touches
  bool probe_must_trip = false;  // kProbe: an error if the target is reached without that
};

}  // namespace trammel::gcode
