#include "arc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "words.hpp"

namespace trammel::gcode {
namespace {

constexpr double kSamePoint = 1e-6;     // mm; far below a pulse, far above the rounding of sums
constexpr double kRadiusSlack = 0.005;  // mm
constexpr double kRadiusSlackRelative = 0.001;
constexpr double kRadiusSlackMost = 0.5;  // mm

bool same_point(PlanePoint a, PlanePoint b) { return std::hypot(a.x - b.x, a.y - b.y) < kSamePoint; }

PlanePoint centre_from_radius(const ArcWords& words) {
  const double radius = *words.radius;
  if (std::abs(radius) < kSamePoint) {
    throw WordError{"arc of radius 0"};
  }
  if (same_point(words.start, words.end)) {
    throw WordError{"an arc with R needs an end point other than its start; a full circle takes I, J or K"};
  }
  const double dx = words.end.x - words.start.x;
  const double dy = words.end.y - words.start.y;
  const double chord = std::hypot(dx, dy);
  if (chord / 2 - std::abs(radius) > kRadiusSlack) {
    throw WordError{fmt::format("R is too small: the end point is {:.4f} mm away", chord)};
  }
  const double height = std::sqrt(std::max(0.0, radius * radius - chord * chord / 4));
  // Counter-clockwise arcs up to half a turn have their centre on the left of the chord.
  const double left = words.clockwise == (radius > 0) ? -height : height;
  return {words.start.x + dx / 2 - left * dy / chord, words.start.y + dy / 2 + left * dx / chord};
}

PlanePoint centre_from_offsets(const ArcWords& words) {
  if (!words.centre_x && !words.centre_y) {
    throw WordError{"an arc needs its centre or radius: I, J, K or R"};
  }
  if (!words.centre_absolute) {
    return {words.start.x + words.centre_x.value_or(0), words.start.y + words.centre_y.value_or(0)};
  }
  if (!words.centre_x || !words.centre_y) {
    throw WordError{"under G90.1 an arc needs both words of its centre"};
  }
  return {*words.centre_x, *words.centre_y};
}

void check_radii(double start, double end) {
  if (start < kSamePoint || end < kSamePoint) {
    throw WordError{"arc of radius 0"};
  }
  const double difference = std::abs(start - end);
  const bool off = difference > kRadiusSlack && difference > kRadiusSlackRelative * start;
  if (off || difference > kRadiusSlackMost) {
    throw WordError{fmt::format(
        "the arc's end is not on its circle: radius {:.3f} mm at the start, {:.3f} mm at the end", start, end)};
  }
}

}  // namespace

ArcCentre arc_centre(const ArcWords& words) {
  if (words.radius && (words.centre_x || words.centre_y)) {
    throw WordError{"an arc takes R or its centre, not both"};
  }
  const PlanePoint centre = words.radius ? centre_from_radius(words) : centre_from_offsets(words);
  check_radii(std::hypot(words.start.x - centre.x, words.start.y - centre.y),
              std::hypot(words.end.x - centre.x, words.end.y - centre.y));
  return {centre, same_point(words.start, words.end)};
}

}  // namespace trammel::gcode
