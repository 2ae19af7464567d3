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

// Number of chords of equal angles such that none deviates by more than a quarter of a pulse from its arc.
std::uint64_t chord_count(const ExactArc& arc, double max_pulses_per_mm);

// Sets the coordinates of the arc's plane at a share, 0 to 1, of the arc; returns these axes, bit n: axis n.
inline unsigned place_on_arc(const Block& block, double share, gcode::Coordinates& at) {
  if (block.tilted) {
    const SpaceArc& space = block.space;
    const driver::SineCosine to = driver::sine_cosine(space.sweep * share);
    unsigned axes = 0;
    for (std::size_t part = 0; part < space.axes.size(); ++part) {
      const double way = to.cosine * space.first[part] + to.sine * space.second[part];
      at[space.axes[part]] = space.centre[part] + space.radius * way;
      axes |= 1U << space.axes[part];
    }
    return axes;
  }
  const ExactArc& arc = block.exact;
  const driver::SineCosine to = driver::sine_cosine(arc.angle_start + (block.clockwise ? -1 : 1) * arc.sweep * share);
  const double radius = arc.radius_start + (arc.radius_end - arc.radius_start) * share;
  at[block.axis_x] = arc.centre_x + radius * to.cosine;
  at[block.axis_y] = arc.centre_y + radius * to.sine;
  return 1U << block.axis_x | 1U << block.axis_y;
}

// The joints at corner `i` of `count` parts of equal angles; 0 is the block's start, `count` its end. Joints that no
// axis of the plane moves advance evenly. An axis outside the plane that shares a joint with it has the coordinate that
// evenly moving joints would give it.
inline Pulses corner(const Block& block, std::uint64_t i, std::uint64_t count,
                     const kinematics::Kinematics& kinematics) {
  if (i == 0) return block.start;
  if (i == count) return block.end;
  const double share = static_cast<double>(i) / static_cast<double>(count);
  Pulses at = block.start;
  for (std::size_t joint = 0; joint < at.size(); ++joint) {
    const std::int64_t way = block.end[joint] - block.start[joint];
    if (way != 0) at[joint] += std::llround(static_cast<double>(way) * share);
  }
  gcode::Coordinates place = kinematics.coordinates(at);
  const unsigned axes = place_on_arc(block, share, place);
  for (std::size_t joint = 0; joint < kinematics.joints(); ++joint) {
    if ((kinematics.axes_of(joint) & axes) != 0) at[joint] = kinematics.pulses(joint, place);
  }
  return at;
}

// Calls take(step) with the displacement of each chord that has steps, in order.
template <class Take>
void for_each_chord(const Block& block, const kinematics::Kinematics& kinematics, Take take) {
  Pulses here = block.start;
  for (std::uint64_t i = 1; i <= block.chords; ++i) {
    const Pulses next = corner(block, i, block.chords, kinematics);
    if (next == here) continue;
    Pulses step{};
    for (std::size_t joint = 0; joint < step.size(); ++joint) step[joint] = next[joint] - here[joint];
    take(step);
    here = next;
  }
}

// Part `i` of the block's parts for the arc generator. Throws std::invalid_argument if the command cannot hold it.
driver::HelixGeometry helix_part(const Block& block, std::uint64_t i, const kinematics::Kinematics& kinematics);

}  // namespace trammel::planner
