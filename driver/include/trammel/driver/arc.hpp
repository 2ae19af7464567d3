// Arcs of circles and of axis-parallel ellipses for the deviation accumulator: from geometry in pulses to the fields of
// an ARC command.
//
// The card steps along the conic F = A X^2 + B Y^2 - N. With 4 directions the sign of F chooses each step (Goldberg &
// Goldberg, "XY Interpolation Algorithms"); with 8 directions the card takes the step with the least |F|. The arc ends
// on the commanded end point regardless of the rounding of start, end and centre. Positions are never in floating
// point; the sweep only distinguishes a short arc from the same arc with additional full turns.
//
// Pure functions, thread-safe. Every function throws std::invalid_argument, which names the value, for an arc that the
// card cannot make: a radius below 1.5 pulses or a semi-axis below 2 (with 8 directions both 1; the walk may cross the
// centre of a smaller one), a radius above the bounds here, a start or end off the ellipse, no step to make, or more
// turns than the card's counters hold.
#pragma once

#include <cstdint>

#include "trammel/driver/commands.hpp"

namespace trammel::driver {

// Centres have 8 fraction bits: with centres in whole pulses an arc would deviate by up to 2.8 pulses, with 8 bits by
// 1.1.
inline constexpr std::int64_t kCentreUnitsPerPulse = std::int64_t{1} << card_map::constant::kCentreFractionBits;

// Largest distance from the centre, per coordinate: 2^24 pulses. It bounds X^2 <= 2^64, and |F| and |GX| < 2^67 for any
// walk inside the circle's bounding square, far below the card's 80 bits. A full turn has at most 2^27 steps.
inline constexpr std::int64_t kMaxCentreDistance = std::int64_t{1} << 32;  // 1/256 pulses

// Largest semi-axis of an ellipse, pulses: |F| < 4ab max(a, b) <= 2^62 on the curve, CX/2 = b^2 <= 2^40.
inline constexpr std::int64_t kMaxSemiAxis = std::int64_t{1} << 20;

// The steps of an arc. kFourDirections: each step moves one axis, by the rule of the papers. kEightDirections: a step
// may move both axes, and the least deviation chooses it; needs a card with the engine accumulator_8.
enum class StepRule { kFourDirections, kEightDirections };

// An arc of a circle, without its duration. The plane's first axis points right, its second axis up.
struct ArcGeometry {
  std::int64_t centre_x = 0;  // from the integer start point to the centre, 1/256 pulses, rounded
  std::int64_t centre_y = 0;
  std::int32_t end_x = 0;  // from start to end, pulses
  std::int32_t end_y = 0;
  bool clockwise = false;   // G2, seen with the first axis to the right and the second up
  double sweep = 0;         // angle of the unrounded arc without the extra turns, radians, >= 0; a full turn is 2 pi
  std::uint32_t turns = 0;  // full turns beyond `sweep`
  std::uint8_t axis_x = 0;  // index of the first axis, 0..7
  std::uint8_t axis_y = 1;  // index of the second axis, not axis_x
};

// An arc of the ellipse (x/a)^2 + (y/b)^2 = 1 about a centre that lies on a whole pulse.
struct EllipseGeometry {
  std::int64_t semi_x = 0;   // a, pulses, 2 .. 2^20; 1 .. 2^20 with 8 directions
  std::int64_t semi_y = 0;   // b, same range
  std::int64_t start_x = 0;  // from the centre to the start point, pulses; rounded from the curve
  std::int64_t start_y = 0;
  std::int32_t end_x = 0;  // from start to end, pulses
  std::int32_t end_y = 0;
  bool clockwise = false;
  double sweep = 0;         // angle swept by the ray from the centre, radians, without the turns
  std::uint32_t turns = 0;  // full turns beyond `sweep`
  std::uint8_t axis_x = 0;
  std::uint8_t axis_y = 1;
};

// All fields of the command except its duration: `ticks` and `prescale` are 0; `path_ticks` is L, the exact number of
// steps. Cost with 4 directions: a bisection of 36 rounds per quadrant change. With 8 directions: a simulation of the
// walk, in which identical turns are simulated once.
ArcCommand prepare(const ArcGeometry& geometry, StepRule rule = StepRule::kFourDirections);
ArcCommand prepare(const EllipseGeometry& geometry, StepRule rule = StepRule::kFourDirections);

// The arc with a duration of `ticks` feed ticks. Also throws when ticks < path_ticks or ticks >= 2^40.
ArcCommand with_ticks(ArcCommand arc, std::uint64_t ticks);

ArcCommand make_arc(const ArcGeometry& geometry, std::uint64_t ticks, StepRule rule = StepRule::kFourDirections);
ArcCommand make_ellipse(const EllipseGeometry& geometry, std::uint64_t ticks,
                        StepRule rule = StepRule::kFourDirections);

}  // namespace trammel::driver
