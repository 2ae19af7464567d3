// All measures of one method on one curve, and of a method over many random lines.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "trammel/interpolation/any_interpolator.hpp"
#include "trammel/interpolation/curve.hpp"
#include "trammel/interpolation/method.hpp"
#include "trammel/measure/cost.hpp"
#include "trammel/measure/distance.hpp"
#include "trammel/measure/evenness.hpp"
#include "trammel/measure/ideal_curve.hpp"
#include "trammel/measure/trace.hpp"

namespace trammel::measure {

// A trace takes 16 bytes per step. Callers should refuse longer curves.
inline constexpr std::uint64_t kMaxPulses = 4'000'000;

// Estimate of the pulses of all axes: exact for lines. For round curves it is that of a full turn (the perimeter of
// the circumscribed rectangle); for circles it may be low by a factor of up to 1.42.
std::uint64_t pulses_along(const interpolation::Curve& curve);

IdealCurve ideal_of(const interpolation::Curve& curve);

// Records the whole walk. Throws what make_interpolator throws (std::invalid_argument).
void record(interpolation::Method method, const interpolation::Curve& curve, const interpolation::Options& options,
            Trace& trace);

// A method that the card runs itself costs one computation and its block: the direct-mode registers for a line
// (FREQUENCY_LO[3] .. START), ARC for a conic by STEER's rule or by least deviation (the deviation accumulator in 4
// or 8 directions), ARC_CHORD for an arc by rotation (the arc generator). All other methods count as run by the host,
// step by step.
HostCost cost_of(interpolation::Method method, const Trace& trace, bool line);

struct MethodMeasures {
  interpolation::Method method = interpolation::Method::kSteer;
  std::uint64_t steps = 0;   // times at which at least one axis steps
  std::uint64_t pulses = 0;  // pulses of all axes
  std::uint64_t total_time = 0;
  HostCost cost;
  Distances distances;
  std::array<Evenness, kTraceAxes> evenness{};
  std::array<std::vector<SpectrumLine>, kTraceAxes> spectrum;
  Ripple ripple;
};

// All measures except the motor. Thread-safe.
MethodMeasures measure_method(interpolation::Method method, const Trace& trace, const IdealCurve& curve);

// The methods that support this curve, in the order of the enumeration.
std::vector<interpolation::Method> methods_for(const interpolation::Curve& curve);

// One method over many lines.
struct RandomMeasures {
  interpolation::Method method = interpolation::Method::kSteer;
  double largest_perpendicular = 0;
  interpolation::Line worst_line;  // the line with largest_perpendicular
  double mean_perpendicular = 0;   // this and the following means: mean over the lines
  double largest_horizontal = 0;
  double largest_axis = 0;
  double largest_interval_deviation = 0;
  double mean_interval_deviation = 0;  // mean over the lines of each line's largest
  double mean_rms_interval = 0;
  double largest_ripple = 0;
  double mean_rms_ripple = 0;
  double mean_steps = 0;
  double mean_operations = 0;
  std::uint64_t wrong_ends = 0;  // lines that did not end at their end point; not 0 means that the method is broken
};

struct RandomLines {
  std::uint64_t count = 0;
  std::uint64_t seed = 1;
  std::int64_t largest = 1000;  // displacements of each axis are uniform in -largest .. largest, not both 0
  interpolation::Options options;
  unsigned threads = 2;
};

// Line number `index`; it depends only on `index` and the seed.
interpolation::Line random_line(const RandomLines& lines, std::uint64_t index);

// Every method on every line. The result does not depend on the number of threads. `progress` is called from time to
// time by the calling thread, with the fraction done. Throws std::invalid_argument if a method cannot do the largest
// line (a velocity of more than one pulse per clock).
std::vector<RandomMeasures> measure_random_lines(const RandomLines& lines,
                                                 const std::function<void(double)>& progress = {});

}  // namespace trammel::measure
