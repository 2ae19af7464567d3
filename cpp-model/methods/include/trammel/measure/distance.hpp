// How far a method strays from the curve. Positions are those after all steps of one time. Unit: pulses.
//
// - perpendicular: the distance to the curve, in the space of its axes (what kind for arcs: ideal_curve.hpp). Largest
//   and mean over the positions after each event; the start does not count.
// - horizontal: the distance along x to the point of the line at the same y. Only for lines of two axes, not parallel
//   to x: the second paper's bound (Zeng, Zhang & Huang, section 3) is on this one or on the likewise vertical one,
//   and both are larger than the perpendicular.
// - axis: of each axis, the distance from the point that runs along the curve at constant speed, over all whole time
//   units 0 .. total_time; the mean is over the positions after each event. A method that keeps to the line but
//   hurries or dawdles along it shows here.
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
