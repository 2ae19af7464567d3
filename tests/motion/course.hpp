// Geometry of the command of a path: directions at its ends, length, curvature, all computed from its integers.
#pragma once

#include <array>
#include <cstdint>

#include "motion_walk.hpp"
#include "trammel/card_map.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::test {

using Vector = std::array<double, card_map::kMaxAxes>;  // indexed by axis

struct Course {
  // Pulses per feed tick (magnitude), the least value that the path may have had before its ends were rounded. For the
  // plane axes of an arc it is the speed of the path.
  Vector pulses_a_tick{};
  Vector entry{};  // directions at the start and at the end, mm per mm of `length`
  Vector exit{};
  double length = 0;       // mm, along X Y Z, or along all axes if X Y Z do not move
  double curvature = 0;    // 1/mm, in the plane of an arc; the least value before its ends were rounded
  double plane_share = 0;  // share of the path's speed in the plane of an arc
  std::array<std::size_t, 2> plane{};
  bool spatial = false;  // X, Y or Z moves
  double error = 0;      // by rounded ends: change of direction (radians) and of length (share), at most
};

Course course_of(const Path& path, const machine::Machine& machine);

// X, Y and Z: their length counts for feeds and corners.
inline bool is_spatial(const machine::MachineAxis& axis) { return axis.letter >= 'X'; }

// Positions of the plane axes of an arc in pulses from its start, from the increments of the chords.
class ArcReading {
 public:
  explicit ArcReading(const driver::ArcChordCommand& arc);
  // Positions after `path_ticks`, which may be fractional and must not decrease from call to call.
  std::array<double, 2> at(double path_ticks);

 private:
  struct Axis {
    double begin = 0;      // path ticks before the present increment
    double place = 0;      // pulses at `begin`
    double increment = 0;  // pulses per path tick
    double end = 0;        // path ticks
  };
  void turn(unsigned axis);

  const driver::ArcChordCommand& arc_;
  std::array<Axis, 2> axes_;
  std::int64_t x_;
  std::int64_t y_;
};

}  // namespace trammel::test
