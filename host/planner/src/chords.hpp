// An arc as straight lines between whole pulses, corner by corner. Internal to the planner.
#pragma once

#include <cstdint>

#include "trammel/driver/trigonometry.hpp"
#include "trammel/planner/block.hpp"
#include "trammel/planner/block_builder.hpp"

namespace trammel::planner {

// Where a chord ends, in the axes of the plane.
struct Corner {
  std::int64_t x;
  std::int64_t y;
};

// Chords of equal angles so many that none strays more than a quarter of a pulse from its arc.
std::uint64_t chord_count(const ExactArc& arc, double largest_steps_per_mm);

// Corner `i` of a block's `chords`; the last is the block's end.
inline Corner corner(const Block& block, std::uint64_t i, double scale_x, double scale_y) {
  if (i == block.chords) return {block.end[block.axis_x], block.end[block.axis_y]};
  const ExactArc& arc = block.exact;
  const double share = static_cast<double>(i) / static_cast<double>(block.chords);
  const driver::SineCosine at = driver::sine_cosine(arc.angle_start + (block.clockwise ? -1 : 1) * arc.sweep * share);
  const double radius = arc.radius_start + (arc.radius_end - arc.radius_start) * share;
  return {to_pulses(arc.centre_x + radius * at.cosine, scale_x), to_pulses(arc.centre_y + radius * at.sine, scale_y)};
}

// Calls take(step) with the displacement of each chord that has steps, in order.
template <class Take>
void for_each_chord(const Block& block, double scale_x, double scale_y, Take take) {
  Corner here{block.start[block.axis_x], block.start[block.axis_y]};
  for (std::uint64_t i = 1; i <= block.chords; ++i) {
    const Corner next = corner(block, i, scale_x, scale_y);
    if (next.x == here.x && next.y == here.y) continue;
    take(Corner{next.x - here.x, next.y - here.y});
    here = next;
  }
}

}  // namespace trammel::planner
