// The distance of a method from its curve. Positions are those after all steps of one time. Unit: pulses.
//
// - perpendicular: the distance to the curve, in the space of its axes (definition for arcs: ideal_curve.hpp).
//   Largest and mean over the positions after each event, without the start.
// - horizontal: the distance along x to the point of the line at the same y. Only for lines of two axes that are not
//   parallel to x. The second paper's bound (Zeng, Zhang & Huang, section 3) is on this distance or on the vertical
//   one; both are larger than the perpendicular distance.
// - axis: per axis, the distance from the point that runs along the curve at constant speed, over all whole time
//   units 0 .. total_time; the mean is over the positions after each event. It shows a method that keeps to the line
//   but runs ahead or behind along it.
// Pure functions: thread-safe.
#pragma once

#include <array>
#include <optional>

#include "trammel/measure/ideal_curve.hpp"
#include "trammel/measure/trace.hpp"

namespace trammel::measure {

struct Spread {
  double largest = 0;
  double mean = 0;
};

struct Distances {
  Spread perpendicular;
  std::optional<Spread> horizontal;
  std::array<Spread, kTraceAxes> axis{};
};

// Precondition: trace.axes() == curve.axes(), trace.total_time() > 0 unless the trace is empty.
Distances measure_distances(const Trace& trace, const IdealCurve& curve);

}  // namespace trammel::measure
