// G5 and G5.1: curves cut into lines. Internal to the reader; pure functions from + - * / and square roots.
#pragma once

#include <array>
#include <cstdint>

#include "arc.hpp"

namespace trammel::gcode {

// The largest deviation of the lines from the curve, mm.
inline constexpr double kSplineTolerance = 0.002;
inline constexpr std::uint32_t kMaxSplineLines = 10'000;

// A cubic Bezier curve: start, two control points, end.
using Cubic = std::array<PlanePoint, 4>;

// The cubic form of a curve with a single control point.
Cubic cubic_of(const PlanePoint& start, const PlanePoint& control, const PlanePoint& end);

// Number of lines, at equal steps of the parameter, that keep to the tolerance; above kMaxSplineLines: too many.
std::uint32_t lines_of(const Cubic& curve);
// The point at the parameter i / count.
PlanePoint point_of(const Cubic& curve, std::uint32_t i, std::uint32_t count);

}  // namespace trammel::gcode
