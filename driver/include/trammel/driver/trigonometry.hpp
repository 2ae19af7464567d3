// Sine, cosine and arc tangent from + - * / alone, in a fixed order, so that every host with IEEE 754 rounding computes
// the same bits. Those of the mathematics library differ between hosts, and with a fused multiply-add. Compile without
// contraction (-ffp-contract=off). Pure functions, thread-safe.
#pragma once

namespace trammel::driver {

inline constexpr double kPi = 3.141592653589793;

struct SineCosine {
  double sine;
  double cosine;
};

// `angle` in radians, |angle| <= 10^6. Each is off by 2^-52 at most.
SineCosine sine_cosine(double angle);

// The angle of (x, y), both finite, from the x axis towards y, -pi .. pi; 0 for (0, 0). Off by 2^-50 at most. The sign
// of a zero counts for nothing: on the negative x axis it is pi.
double arc_tangent(double y, double x);

// For 0 <= x <= 1; off by 2^-50 at most for x <= 1/2.
double arc_sine(double x);

}  // namespace trammel::driver
