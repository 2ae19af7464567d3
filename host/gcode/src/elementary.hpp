// Exponential, logarithm and power from + - * / only, so that every host gets the same bits (see
// driver/trigonometry.hpp). Internal to the reader; pure functions.
#pragma once

namespace trammel::gcode {

// Error at most 2^-50 of the result; 0 below -745, infinite above 709.
double exponential(double x);
// x > 0. Error at most 2^-51 near 1, 2^-51 of the result elsewhere.
double natural_logarithm(double x);
// Whole exponents up to 1024 by multiplication, exact if each product is exact. Other exponents need a base above 0;
// their error is at most 1e-13 of a result below 1e12. A base of 0 with an exponent above 0 gives 0. NaN if there is no
// such number.
double power(double base, double exponent);
// Degrees; |angle| up to 1e6 radians. 0, 90, 180 and so on give 0, 1 and -1 exactly.
double sine_of_degrees(double angle);
double cosine_of_degrees(double angle);
// Angle of the point (x, y), in degrees.
double degrees_of(double y, double x);

}  // namespace trammel::gcode
