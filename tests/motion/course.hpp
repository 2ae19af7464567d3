// What a path's command says of its geometry: directions at its ends, length, curvature, all from its integers.
#pragma once

#include <array>
#include <cstdint>

#include "motion_walk.hpp"
#include "trammel/card_map.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::test {

using Vector = std::array<double, card_map::kMaxAxes>;  // by axis

struct Course {
  // Feed tick, magnitude, the least that the path may have had before its ends were rounded; of an arc's plane its path
  // speed.
  Vector pulses_a_tick{};
  Vector entry{};  // direction at the start and at the end, mm a mm of `length`
  Vector exit{};
  double length = 0;       // mm, along X Y Z, or all axes where none of these moves
  double curvature = 0;    // 1/mm, in the plane of an arc; likewise
  double plane_share = 0;  // of the path's speed in the plane
  std::array<std::size_t, 2> plane{};
  bool spatial = false;  // X, Y or Z moves
  double error = 0;      // how far rounded ends may have turned a direction (radians), and changed the length (share)
};

Course course_of(const Path& path, const machine::Machine& machine);

// X, Y and Z, by whose length feed and corners count.
inline bool is_spatial(const machine::MachineAxis& axis) { return axis.letter >= 'X'; }

// Where an arc's plane axes are, pulses from its start, as the chords' increments say.
class ArcReading {
 public:
  explicit ArcReading(const driver::ArcChordCommand& arc);
  // At so many path ticks, the fraction of a tick counted. Never less than the call before.
  std::array<double, 2> at(double path_ticks);

 private:
  struct Axis {
    double begin = 0;      // path ticks before the increment in force
    double place = 0;      // pulses at `begin`
    double increment = 0;  // pulses a path tick
    double end = 0;        // path ticks
  };
  void turn(unsigned axis);

  const driver::ArcChordCommand& arc_;
  std::array<Axis, 2> axes_;
  std::int64_t x_;
  std::int64_t y_;
};

}  // namespace trammel::test
