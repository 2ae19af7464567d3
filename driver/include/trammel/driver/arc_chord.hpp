// Arcs of circles and helices for the arc generator: from pulses to the fields of an ArcChord.
//
// The card turns the circle's radius once per chord, without multipliers, by 2 asin(2^-(k+1)), and each axis's pulse
// generator makes the chord's steps (docs/developer/architecture.md, arc_generator). The host computes the rest: a
// circle of the mean of start and end radius about the given centre; a phase that puts the start onto it; and a
// constant increment that takes up the remainder at the end. So an arc ends on its commanded end point exactly, and
// stays within 0.8 pulses of the ring between the radii of its start and its end (both are rounded).
//
// Computed in doubles by + - * / and square roots alone: every host comes to the same fields.
// Pure functions, thread-safe. They throw std::invalid_argument, naming the value, for what the generator cannot do: a
// plane of one axis, a radius below 1/8 pulse or beyond kMaxChordRadius, radii or a sweep that contradict the points,
// an end behind the start, more turns than kMaxChordTurns, too few ticks.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/driver/arc.hpp"
#include "trammel/driver/commands.hpp"

namespace trammel::driver {

// Largest distance from the centre, pulses: as far as the position counters reach.
inline constexpr double kMaxChordRadius = 2147483647.0;

// As far as this driver's sines keep their digits.
inline constexpr std::uint32_t kMaxChordTurns = 100'000;

// An arc, and what further axes make on straight lines over the same time.
struct HelixGeometry {
  ArcGeometry arc;
  std::array<std::int64_t, card_map::kMaxAxes> further{};  // by axis, start to end, pulses; 0 for those of the plane
};

// The fewest feed ticks that make_helix() takes.
std::uint64_t least_chord_ticks(const HelixGeometry& geometry);

// The arc over `ticks` feed ticks, less than 2^40, on as many path ticks as fit: half to all of them, less than 2^37.
ArcChordCommand make_helix(const HelixGeometry& geometry, std::uint64_t ticks);

}  // namespace trammel::driver
