// Sine, cosine and arc tangent from + - * / alone, in a fixed order, so that every host with IEEE 754 rounding computes
// the same bits. The results of the mathematics library differ between hosts, and with fused multiply-add. Compile
// without contraction (-ffp-contract=off). Pure functions, thread-safe.
#pragma once

namespace trammel::driver {

inline constexpr double kPi = 3.141592653589793;

struct SineCosine {
  double sine;
  double cosine;
};

// `angle` in radians, |angle| <= 10^6. The error of each result is at most 2^-52.
SineCosine sine_cosine(double angle);

// The angle of (x, y), both finite, from the x axis towards y, -pi .. pi; 0 for (0, 0). The error is at most 2^-50. The
// sign of a zero is ignored: on the negative x axis the result is pi.
double arc_tangent(double y, double x);

// For 0 <= x <= 1; the error is at most 2^-50 for x <= 1/2.
double arc_sine(double x);

}  // namespace trammel::driver
