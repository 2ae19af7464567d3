// How evenly a method steps. All times are taken relative to the curve's total time.
//
// - interval deviation: for two successive pulses of an axis in the same direction, what the point that runs along the
//   curve at constant speed travels on that axis between them, less the one pulse that the axis made. On a line this
//   is the interval's deviation from the mean interval (total time / pulses of the axis), in mean intervals: 0 is
//   perfectly even, 1 a gap twice as long as it should be. On a curve the intervals change with the slope, and the
//   definition takes that out. Intervals across a change of direction do not count.
// - interval spectrum: the amplitudes of the sequence of interval deviations over its discrete frequencies k / n,
//   k = 1 .. n/2, in cycles a pulse: what period the unevenness has. A large line is what excites a resonance.
// - speed ripple: an axis's speed between two of its pulses is one pulse over the interval (0 across a change of
//   direction); the speed along the path is the component of the axes' speeds along the ideal direction. Ripple is its
//   deviation from the mean speed, relative to it; rms over time and largest, from when all moving axes have made
//   their first pulse until one has made its last. An axis of fewer than two pulses counts with its mean speed.
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
  std::size_t intervals = 0;  // 0: the axis has too few pulses to say anything
};

// The interval deviations of one axis in order of time.
std::vector<double> interval_deviations(const Trace& trace, const IdealCurve& curve, std::size_t axis);

Evenness measure_evenness(const Trace& trace, const IdealCurve& curve, std::size_t axis);

struct SpectrumLine {
  double frequency = 0;  // cycles a pulse, 0 < frequency <= 1/2
  double amplitude = 0;  // in mean intervals
};

// Amplitude 2/n |sum d_i e^(-2 pi i k i / n)| at k = 1 .. n/2 (half of it at k = n/2, which has no twin). Takes the
// first `limit` deviations at most, in limit^2 / 2 operations (Goertzel).
std::vector<SpectrumLine> interval_spectrum(const std::vector<double>& deviations, std::size_t limit = 4096);

// The highest line; amplitude 0 if there is none.
SpectrumLine highest_line(const std::vector<SpectrumLine>& spectrum);

struct Ripple {
  double rms = 0;
  double largest = 0;
};

Ripple measure_speed_ripple(const Trace& trace, const IdealCurve& curve);

}  // namespace trammel::measure
