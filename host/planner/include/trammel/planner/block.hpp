// A motion in the planner's form: geometry in pulses, length and limits along the path. Plain data.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/gcode/motion.hpp"
#include "trammel/kinematics/kinematics.hpp"
#include "trammel/planner/blender.hpp"
#include "trammel/planner/speed_plan.hpp"

namespace trammel::planner {

// One value per joint (an axis of the card), in pulses. Targets fit the 32-bit position counters.
using kinematics::Pulses;

// Why a motion is slower than its programmed feed.
enum class SpeedLimit : std::uint8_t {
  kNone,          // the feed is reached
  kAxisVelocity,  // max_velocity of an axis
  kPulseShape,    // step length and space of an axis
  kAcceleration,  // too short to reach the feed, too tight a curve, or a corner
  kClock,         // the card's clock
  kWindow,        // the look-ahead window ends before a stop is possible
};
inline constexpr std::size_t kSpeedLimits = 6;

// By axis of the machine: mm of the axis per mm of path.
using kinematics::Direction;

// The commands of a block in the card's geometry queue.
enum class Geometry : std::uint8_t {
  kLine,
  kArc,       // on the deviation accumulator
  kArcChord,  // on the arc generator; axes outside the plane may move too (a helix)
  kChords,    // as short lines; axes outside the plane may move too
  kDwell,
  kEnd,
};

// An arc before rounding: machine coordinates in mm.
struct ExactArc {
  double centre_x = 0;
  double centre_y = 0;
  double radius_start = 0;
  double radius_end = 0;
  double angle_start = 0;  // radians, from the plane's first axis towards its second
  double sweep = 0;        // radians, > 0, with all turns
};

// How a programmed motion begins, before rounding to pulses.
struct Heading {
  Direction entry{};
  double length = 0;    // mm
  double speed = 0;     // mm/s, the most that its limits allow
  bool linear = false;  // X, Y or Z moves
};

// Programmed motions without a pulse that precede a block; the block covers their path too.
struct Detour {
  // mm/s, the most at which the corners from the first such motion to the block may be passed; 0: there are no such
  // motions, or they need a stop.
  double speed = 0;
  Heading first;
};

// Lengths, directions and limits are those of the path before rounding, in mm and seconds along it (degrees if only
// rotary axes move). The length counts X, Y and Z if any of them moves, else all axes. If X, Y and Z cover less than
// two pulses and another axis covers more, the length counts the pulses of that axis instead. Fields that the kind of
// geometry does not use are undefined.
struct Block {
  std::size_t line = 0;  // of the program
  Geometry geometry = Geometry::kEnd;
  Pulses start{};
  Pulses end{};
  driver::OutputCommand outputs;  // switched where the block begins
  double power = 0;               // 0 .. 1: duty of the spindle's pulses
  bool power_follows = false;     // the duty follows the speed and is `power` at `wanted`

  // Motions: kLine, kArc, kArcChord, kChords.
  bool rapid = false;
  bool linear = false;  // X, Y or Z moves
  gcode::PathControl path_control = gcode::PathControl::kContinuous;
  // kBlended: the block is a blend; else the treatment of the corner at its end.
  Corner corner = Corner::kNone;
  double distance = 0;                   // mm, of a blend: its distance from the corner
  Direction entry{};                     // direction at its beginning
  Direction exit{};                      // direction at its end
  Detour detour;                         // before this block
  double length = 0;                     // mm
  double curvature = 0;                  // 1/mm, of an arc; negative: clockwise
  double pulses_per_mm = 0;              // pulses per mm of path, of the joint with the most
  std::uint64_t least_ticks = 0;         // feed ticks that the geometry needs at least
  double speed = 0;                      // mm/s, the most that axes, card and program allow
  double acceleration = 0;               // mm/s^2, the most at any speed up to `speed`
  Curve curve{};                         // of an arc: acceleration and jerk left at lower speeds
  double jerk = 0;                       // mm/s^3, infinite: no limit
  double wanted = 0;                     // mm/s, the program's speed; 0: as fast as possible
  double feed = 0;                       // `wanted` as the program gives it: mm/s along the axes that F counts
  SpeedLimit limit = SpeedLimit::kNone;  // why `speed` is below `wanted`

  // Arcs: kArc, kArcChord, kChords.
  bool clockwise = false;
  std::uint8_t axis_x = 0;
  std::uint8_t axis_y = 0;
  // kArc, kArcChord: the two joints that make the arc, their sense of rotation, and the centre in their pulses.
  std::uint8_t joint_x = 0;
  std::uint8_t joint_y = 0;
  bool joints_clockwise = false;
  std::int64_t centre_x = 0;  // 1/256 pulses
  std::int64_t centre_y = 0;
  ExactArc exact;
  // kChords: a blend outside the main planes. `exact` gives its radii and sweep, `space` the rest.
  bool tilted = false;
  SpaceArc space;
  driver::ArcCommand arc;         // kArc: complete but for its ticks
  std::uint64_t parts = 0;        // kArcChord: number of commands, of equal angles
  std::uint64_t chords = 0;       // kChords: number of chords, of equal angles; some may have no step
  std::uint64_t chord_lines = 0;  // number of chords with steps

  // kDwell
  std::uint64_t dwell_clocks = 0;
  double dwell_seconds = 0;
  bool awaits_spindle = false;  // the motion after it waits until the spindle is at speed
};

// Whether the axis belongs to the plane of a block that is an arc.
inline bool in_plane(const Block& block, std::size_t axis) {
  if (!block.tilted) return axis == block.axis_x || axis == block.axis_y;
  return axis == block.space.axes[0] || axis == block.space.axes[1] || axis == block.space.axes[2];
}

inline bool switches(const Block& block) { return (block.outputs.set | block.outputs.clear) != 0; }
inline bool moves(const Block& block) { return block.geometry != Geometry::kDwell && block.geometry != Geometry::kEnd; }

}  // namespace trammel::planner
