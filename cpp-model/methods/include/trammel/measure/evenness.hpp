// The evenness of a method's steps. All times are relative to the curve's total time.
//
// - interval deviation: for two successive pulses of an axis in the same direction, the distance that the point
//   running along the curve at constant speed travels on that axis between them, minus the one pulse that the axis
//   made. On a line this is the interval's deviation from the mean interval (total time / pulses of the axis), in
//   mean intervals: 0 is perfectly even, 1 is a gap twice as long as the mean. On a curve the intervals change with
//   the slope, and this definition removes that effect. Intervals across a change of direction do not count.
// - interval spectrum: the amplitudes of the sequence of interval deviations at its discrete frequencies k / n, k = 1
//   .. n/2, in cycles per pulse. It shows the period of the unevenness; a high line can excite a resonance.
// - speed ripple: the speed of an axis between two of its pulses is one pulse over the interval (0 across a change of
//   direction). The speed along the path is the component of the axes' speeds along the ideal direction. Ripple is
//   its deviation from the mean speed, relative to the mean: rms over time, and largest. It is measured from the time
//   when all moving axes have made their first pulse until one has made its last. An axis of fewer than two pulses
//   counts with its mean speed.
// Pure functions: thread-safe.
#pragma once

#include <cstddef>
#include <vector>

#include "trammel/measure/ideal_curve.hpp"
#include "trammel/measure/trace.hpp"

namespace trammel::measure {

struct Evenness {
  double largest = 0;  // largest absolute interval deviation
  double rms = 0;
  std::size_t intervals = 0;  // 0: the axis has too few pulses for a result
};

// The interval deviations of one axis in order of time.
std::vector<double> interval_deviations(const Trace& trace, const IdealCurve& curve, std::size_t axis);

Evenness measure_evenness(const Trace& trace, const IdealCurve& curve, std::size_t axis);

struct SpectrumLine {
  double frequency = 0;  // cycles per pulse, 0 < frequency <= 1/2
  double amplitude = 0;  // in mean intervals
};

// Amplitude 2/n |sum d_i e^(-2 pi i k i / n)| at k = 1 .. n/2 (half of it at k = n/2, which has no mirror frequency).
// Uses at most the first `limit` deviations, in limit^2 / 2 operations (Goertzel).
std::vector<SpectrumLine> interval_spectrum(const std::vector<double>& deviations, std::size_t limit = 4096);

// The highest line; amplitude 0 if there is none.
SpectrumLine highest_line(const std::vector<SpectrumLine>& spectrum);

struct Ripple {
  double rms = 0;
  double largest = 0;
};

Ripple measure_speed_ripple(const Trace& trace, const IdealCurve& curve);

}  // namespace trammel::measure
