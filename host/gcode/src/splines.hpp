// G5 and G5.1: curves cut into lines. Internal to the reader; pure functions in + - * / and square roots.
#pragma once

#include <array>
#include <cstdint>

#include "arc.hpp"

namespace trammel::gcode {

// The lines leave the curve by this much at most, mm.
inline constexpr double kSplineTolerance = 0.002;
inline constexpr std::uint32_t kMaxSplineLines = 10'000;

// A cubic Bezier curve: start, two control points, end.
using Cubic = std::array<PlanePoint, 4>;

// The same curve as one with a single control point.
Cubic cubic_of(const PlanePoint& start, const PlanePoint& control, const PlanePoint& end);

// Lines of equal steps of the parameter that keep to the tolerance; more than kMaxSplineLines: too many.
std::uint32_t lines_of(const Cubic& curve);
// Where the parameter is i / count.
PlanePoint point_of(const Cubic& curve, std::uint32_t i, std::uint32_t count);

}  // namespace trammel::gcode
