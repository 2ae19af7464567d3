// Arcs of circles and helices for the arc generator: from geometry in pulses to the fields of an ARC_CHORD command.
//
// Once per chord the card rotates the circle's radius by 2 asin(2^-(k+1)), without multipliers. Each axis's pulse
// generator makes the chord's steps (docs/developer/architecture.md, arc_generator). The host computes the rest: a
// circle about the given centre, whose radius is the mean of start and end radius; a preset of the phase that moves the
// start onto this circle; and a constant closing increment that cancels the remaining error at the end. The arc
// therefore ends exactly on its commanded end point, and stays within 0.8 pulses of the ring between its start radius
// and its end radius (both points are rounded).
//
// The functions compute in doubles with + - * / and square roots only, so every host gets the same fields.
//
// Pure functions, thread-safe. They throw std::invalid_argument, which names the value, for an arc that the generator
// cannot make: both axes of the plane equal, a radius below 1/8 pulse or above kMaxChordRadius, radii or a sweep that
// contradict the points, an end behind the start, more turns than kMaxChordTurns, too few ticks.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/driver/arc.hpp"
#include "trammel/driver/commands.hpp"

namespace trammel::driver {

// Largest distance from the centre, pulses: the range of the position counters.
inline constexpr double kMaxChordRadius = 2147483647.0;

// Bound on the turns: up to this number, this driver's sines keep their accuracy.
inline constexpr std::uint32_t kMaxChordTurns = 100'000;

// An arc in the plane, with straight motion of further axes over the same time.
struct HelixGeometry {
  ArcGeometry arc;
  std::array<std::int64_t, card_map::kMaxAxes> further{};  // by axis, from start to end, pulses; 0 in the plane
};

// The smallest `ticks` that make_helix() accepts.
std::uint64_t least_chord_ticks(const HelixGeometry& geometry);

// The arc with a duration of `ticks` feed ticks, less than 2^40. It has as many path ticks as fit: between half of
// `ticks` and all of them, and less than 2^37.
ArcChordCommand make_helix(const HelixGeometry& geometry, std::uint64_t ticks);

}  // namespace trammel::driver
