// Arcs of circles and of axis-parallel ellipses for the deviation accumulator: from pulses to the fields of an Arc.
//
// The card walks the conic F = A X^2 + B Y^2 - N from the sign of F (Goldberg & Goldberg, "XY Interpolation
// Algorithms"), or, in 8 directions, to where |F| is least, and ends on the commanded end point whatever the rounding
// of start, end and centre. Position is never in floating point; the sweep only tells a short way from the same way and
// a full turn. Pure functions, thread-safe. Every function throws std::invalid_argument, naming the value, for what the
// card cannot do: a radius below 1.5 pulses or a semi-axis below 2 (in 8 directions 1; smaller ones may pass over the
// centre), a radius above the bounds here, an ellipse's start or end off the curve, no step to make, or more turns than
// its counters hold.
#pragma once

#include <cstdint>

#include "trammel/driver/commands.hpp"

namespace trammel::driver {

// Centres carry 8 fraction bits: with whole pulses an arc would stray 2.8 pulses, with 8 bits 1.1.
inline constexpr std::int64_t kCentreUnitsPerPulse = std::int64_t{1} << card_map::constant::kCentreFractionBits;

// Largest distance from the centre, each coordinate: 2^24 pulses. Then X^2 <= 2^64, |F| and |GX| < 2^67 on any walk
// inside the circle's bounding square, far from the card's 80 bits, and a turn has at most 2^27 steps.
inline constexpr std::int64_t kMaxCentreDistance = std::int64_t{1} << 32;  // 1/256 pulses

// Largest semi-axis of an ellipse, pulses: |F| < 4ab max(a, b) <= 2^62 on the curve, CX/2 = b^2 <= 2^40.
inline constexpr std::int64_t kMaxSemiAxis = std::int64_t{1} << 20;

// Steps of an arc: along one axis each, by the papers' rule, or along both at once too, with the least deviation. The
// second needs a card with accumulator_8.
enum class StepRule { kFourDirections, kEightDirections };

// An arc of a circle, all but its time. "Right" and "up" are the plane's first and second axis.
struct ArcGeometry {
  std::int64_t centre_x = 0;  // from the integer start point to the centre, 1/256 pulses, rounded
  std::int64_t centre_y = 0;
  std::int32_t end_x = 0;  // from start to end, pulses
  std::int32_t end_y = 0;
  bool clockwise = false;   // G2, seen with the first axis to the right and the second up
  double sweep = 0;         // angle of the unrounded arc without the extra turns, radians, >= 0; a full turn is 2 pi
  std::uint32_t turns = 0;  // full turns beyond `sweep`
  std::uint8_t axis_x = 0;  // index of the first axis, 0..7
  std::uint8_t axis_y = 1;  // index of the second, another one
};

// An arc of the ellipse (x/a)^2 + (y/b)^2 = 1 about a centre that lies on a whole pulse.
struct EllipseGeometry {
  std::int64_t semi_x = 0;   // a, pulses, 2 .. 2^20; in 8 directions from 1 on
  std::int64_t semi_y = 0;   // b
  std::int64_t start_x = 0;  // from the centre to the start point, pulses; rounded from the curve
  std::int64_t start_y = 0;
  std::int32_t end_x = 0;  // from start to end, pulses
  std::int32_t end_y = 0;
  bool clockwise = false;
  double sweep = 0;         // angle that the ray from the centre sweeps, radians, without the extra turns
  std::uint32_t turns = 0;  // full turns beyond `sweep`
  std::uint8_t axis_x = 0;
  std::uint8_t axis_y = 1;
};

// Everything of the command but its time: `ticks` and `prescale` are 0, `path_ticks` is L, the exact number of steps.
// In 4 directions a bisection of 36 rounds for each quadrant change; in 8 the walk itself, but for turns that repeat.
ArcCommand prepare(const ArcGeometry& geometry, StepRule rule = StepRule::kFourDirections);
ArcCommand prepare(const EllipseGeometry& geometry, StepRule rule = StepRule::kFourDirections);

// The arc over `ticks` feed ticks; also throws when ticks < path_ticks or ticks >= 2^40.
ArcCommand with_ticks(ArcCommand arc, std::uint64_t ticks);

ArcCommand make_arc(const ArcGeometry& geometry, std::uint64_t ticks, StepRule rule = StepRule::kFourDirections);
ArcCommand make_ellipse(const EllipseGeometry& geometry, std::uint64_t ticks,
                        StepRule rule = StepRule::kFourDirections);

}  // namespace trammel::driver
