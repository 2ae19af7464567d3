// An arc, or a helix, in parts: straight lines between whole pulses, or shorter arcs. Internal to the planner.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "trammel/driver/arc_chord.hpp"
#include "trammel/driver/trigonometry.hpp"
#include "trammel/planner/block.hpp"
#include "trammel/planner/block_builder.hpp"

namespace trammel::planner {

// Steps/mm, by axis.
using Scales = std::array<double, card_map::kMaxAxes>;

// Chords of equal angles so many that none strays more than a quarter of a pulse from its arc.
std::uint64_t chord_count(const ExactArc& arc, double largest_steps_per_mm);

// Where part `i` of `count`, of equal angles, ends; the last one at the block's end. Axes outside the plane go evenly.
inline Pulses corner(const Block& block, std::uint64_t i, std::uint64_t count, const Scales& scales) {
  if (i == 0) return block.start;
  if (i == count) return block.end;
  const ExactArc& arc = block.exact;
  const double share = static_cast<double>(i) / static_cast<double>(count);
  Pulses at = block.start;
  for (std::size_t axis = 0; axis < at.size(); ++axis) {
    const std::int64_t way = block.end[axis] - block.start[axis];
    if (way != 0) at[axis] += std::llround(static_cast<double>(way) * share);
  }
  if (block.tilted) {
    const SpaceArc& space = block.space;
    const driver::SineCosine to = driver::sine_cosine(space.sweep * share);
    for (std::size_t part = 0; part < space.axes.size(); ++part) {
      const double way = to.cosine * space.first[part] + to.sine * space.second[part];
      const std::uint8_t axis = space.axes[part];
      at[axis] = to_pulses(space.centre[part] + space.radius * way, scales[axis]);
    }
    return at;
  }
  const driver::SineCosine to = driver::sine_cosine(arc.angle_start + (block.clockwise ? -1 : 1) * arc.sweep * share);
  const double radius = arc.radius_start + (arc.radius_end - arc.radius_start) * share;
  at[block.axis_x] = to_pulses(arc.centre_x + radius * to.cosine, scales[block.axis_x]);
  at[block.axis_y] = to_pulses(arc.centre_y + radius * to.sine, scales[block.axis_y]);
  return at;
}

// Calls take(step) with the displacement of each chord that has steps, in order.
template <class Take>
void for_each_chord(const Block& block, const Scales& scales, Take take) {
  Pulses here = block.start;
  for (std::uint64_t i = 1; i <= block.chords; ++i) {
    const Pulses next = corner(block, i, block.chords, scales);
    if (next == here) continue;
    Pulses step{};
    for (std::size_t axis = 0; axis < step.size(); ++axis) step[axis] = next[axis] - here[axis];
    take(step);
    here = next;
  }
}

// Part `i` of the block's parts for the arc generator. Throws std::invalid_argument where the command has no room for
// it.
driver::HelixGeometry helix_part(const Block& block, std::uint64_t i, const Scales& scales);

}  // namespace trammel::planner
