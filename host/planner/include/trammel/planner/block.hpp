// A motion as the planner takes it: geometry in pulses, length and limits along the path. Plain data.
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

// By joint, an axis of the card, in pulses; within the 32-bit position counters where it is a target.
using kinematics::Pulses;

// What keeps a motion below its programmed feed.
enum class SpeedLimit : std::uint8_t {
  kNone,          // it is reached
  kAxisVelocity,  // max_velocity of an axis
  kPulseShape,    // step length and space of an axis
  kAcceleration,  // too short to reach it, too strong a curve, a corner
  kClock,         // the card's clock
  kWindow,        // look-ahead ends before a stop could
};
inline constexpr std::size_t kSpeedLimits = 6;

// By axis of the machine, mm a mm of path.
using kinematics::Direction;

// What goes to the card's geometry queue.
enum class Geometry : std::uint8_t {
  kLine,
  kArc,       // on the deviation accumulator
  kArcChord,  // on the arc generator; axes outside the plane may go along
  kChords,    // as lines; likewise
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

// How a motion sets out, as the program has it.
struct Heading {
  Direction entry{};
  double length = 0;    // mm
  double speed = 0;     // a second, the most in it
  bool linear = false;  // X, Y or Z moves
};

// The programmed motions without a pulse before a block, whose way the block has too.
struct Detour {
  double speed =
      0;  // a second, the most past the corners from the first one to the block; 0: no such motions, or a stop
  Heading first;
};

// Lengths, directions and limits are those of the path before rounding, along it, in mm and seconds; for moves of
// rotary axes alone read degrees. A path with X, Y or Z has their length, one without that of all axes; where X, Y and
// Z have less than two pulses, those of an axis beside them count if they are more. Of the fields that a kind of
// geometry does not name, the content means nothing.
struct Block {
  std::size_t line = 0;  // of the program
  Geometry geometry = Geometry::kEnd;
  Pulses start{};
  Pulses end{};
  driver::OutputCommand outputs;  // what is switched where it begins
  double power = 0;               // 0 .. 1: the spindle's pulses in it
  bool power_follows = false;     // the speed; at `wanted` it is `power`

  // Motions: kLine, kArc, kArcChord, kChords.
  bool rapid = false;
  bool linear = false;  // X, Y or Z moves
  gcode::PathControl path_control = gcode::PathControl::kContinuous;
  Corner corner = Corner::kNone;         // kBlended: the block is a blend. Else what became of the corner at its end
  double distance = 0;                   // mm, a blend's from the corner
  Direction entry{};                     // where it begins
  Direction exit{};                      // where it ends
  Detour detour;                         // before it
  double length = 0;                     // mm
  double curvature = 0;                  // 1/mm, of an arc; below 0 where it runs clockwise
  double pulses_per_mm = 0;              // of path, of the joint that has most
  std::uint64_t least_ticks = 0;         // feed ticks that the geometry needs
  double speed = 0;                      // a second, the most that axes, card and program allow
  double acceleration = 0;               // a second^2, at any speed up to it
  Curve curve{};                         // of an arc: what lower speeds leave
  double jerk = 0;                       // a second^3, infinite where no axis has one
  double wanted = 0;                     // a second, the speed that the program asks for; 0: as fast as may be
  double feed = 0;                       // the same as the program has it, mm/s along the axes that F counts for
  SpeedLimit limit = SpeedLimit::kNone;  // what puts `speed` below `wanted`

  // Arcs: kArc, kArcChord, kChords.
  bool clockwise = false;
  std::uint8_t axis_x = 0;
  std::uint8_t axis_y = 0;
  // kArc, kArcChord: the joints that make it, the direction in which they turn, its centre on them.
  std::uint8_t joint_x = 0;
  std::uint8_t joint_y = 0;
  bool joints_clockwise = false;
  std::int64_t centre_x = 0;  // 1/256 pulses
  std::int64_t centre_y = 0;
  ExactArc exact;
  bool tilted =
      false;  // kChords: a blend outside the main planes; of `exact` its radii and sweep, the rest from `space`
  SpaceArc space;
  driver::ArcCommand arc;         // kArc: all but its ticks
  std::uint64_t parts = 0;        // kArcChord: commands, of equal angles
  std::uint64_t chords = 0;       // kChords: of equal angles; some may have no step
  std::uint64_t chord_lines = 0;  // those with steps

  // kDwell
  std::uint64_t dwell_clocks = 0;
  double dwell_seconds = 0;
  bool awaits_spindle = false;  // what comes behind it waits until the spindle is at speed
};

// Of a block that is an arc.
inline bool in_plane(const Block& block, std::size_t axis) {
  if (!block.tilted) return axis == block.axis_x || axis == block.axis_y;
  return axis == block.space.axes[0] || axis == block.space.axes[1] || axis == block.space.axes[2];
}

inline bool switches(const Block& block) { return (block.outputs.set | block.outputs.clear) != 0; }
inline bool moves(const Block& block) { return block.geometry != Geometry::kDwell && block.geometry != Geometry::kEnd; }

}  // namespace trammel::planner
