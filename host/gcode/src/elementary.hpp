// Exponential, logarithm and power from + - * / alone, so that every host comes to the same bits (see
// driver/trigonometry.hpp). Internal to the reader; pure functions.
#pragma once

namespace trammel::gcode {

// Off by 2^-50 of the result at most; 0 below -745, infinite above 709.
double exponential(double x);
// x > 0. Off by 2^-51 at most near 1, by 2^-51 of the result elsewhere.
double natural_logarithm(double x);
// Whole exponents up to 1024 by multiplication, exact where each product is; others need a base above 0 and are off by
// 1e-13 of the result at most where it is below 1e12. NaN where there is no such number.
double power(double base, double exponent);
// Degrees; |angle| up to 1e6 radians. 0, 90, 180 and so on give 0, 1 and -1 exactly.
double sine_of_degrees(double angle);
double cosine_of_degrees(double angle);
// Degrees of the angle of (x, y).
double degrees_of(double y, double x);

}  // namespace trammel::gcode
