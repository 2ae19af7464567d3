// Planner: from the motions of a program to the card's stream commands, exact stop at the end of every motion.
//
// A path has N feed ticks: T ticks for each pulse of path length (length in mm times the largest steps/mm of the moving
// axes), T up to 128 for even steps, less where the clock or the speed does not allow it. The profile keeps every axis
// within its velocity and acceleration (a feed override above 100 % is not planned for). Targets become pulses by
// rounding the absolute target, half away from zero: nothing drifts. Feeds hold along X Y Z; without those along U V W,
// then A B C, then E (as LinuxCNC).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/gcode/reader.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::planner {

// By axis index, machine coordinates in pulses; within the 32-bit position counters where it is a target.
using Pulses = std::array<std::int64_t, card_map::kMaxAxes>;

struct PlannedSegment {
  std::size_t line = 0;  // of the program
  gcode::MotionKind kind = gcode::MotionKind::kLine;
  Pulses start{};
  Pulses end{};
  bool clockwise = false;  // the rest: kArc
  std::uint8_t axis_x = 0;
  std::uint8_t axis_y = 0;
  bool chords = false;        // the arc goes out as lines: unequal scales, or beyond the accumulator's range
  std::int64_t centre_x = 0;  // 1/256 pulses, absolute
  std::int64_t centre_y = 0;
  double sweep = 0;    // angle of the arc, radians, 0 .. 2 pi
  double seconds = 0;  // estimated duration
  // In the order to send: the feed pieces of a path come before its geometry, so that neither queue can fill up with
  // what waits for the other.
  std::vector<driver::Command> commands;
};

// Generates the segments one by one. Both references must outlive the planner. Not thread-safe.
class Planner {
 public:
  // `clock_hz` of the card that will run it. Throws gcode::ProgramError for any target beyond the position counters
  // (+-2^31 pulses) or dwell beyond 2^48 clocks: the whole program is checked here.
  Planner(const gcode::Program& program, const machine::Machine& machine, std::uint32_t clock_hz);

  // The next segment, false after the last one (kEnd). Motions of less than a pulse give none.
  bool next(PlannedSegment& segment);

  // Where the program starts.
  const Pulses& start() const { return start_; }
  // Estimated duration of the segments so far.
  double seconds() const { return seconds_; }

 private:
  void check(const gcode::Motion& motion, const gcode::Coordinates& from) const;

  const gcode::Program& program_;
  const machine::Machine& machine_;
  std::uint32_t clock_hz_;
  Pulses start_{};
  Pulses here_{};
  gcode::Coordinates exact_{};  // unrounded
  std::size_t index_ = 0;
  double seconds_ = 0;
};

}  // namespace trammel::planner
