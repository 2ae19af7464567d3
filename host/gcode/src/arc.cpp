#include "arc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace trammel::gcode {
namespace {

constexpr double kSamePoint = 1e-6;     // mm; far below a pulse, far above the rounding of sums
constexpr double kRadiusSlack = 0.005;  // mm
constexpr double kRadiusSlackRelative = 0.001;
constexpr double kMaxRadiusSlack = 0.5;  // mm

// std::hypot differs in its last digit between libraries. Numbers of words are at most 1e12, so no square overflows.
double distance(PlanePoint a, PlanePoint b) {
  const double x = a.x - b.x;
  const double y = a.y - b.y;
  return std::sqrt(x * x + y * y);
}

bool same_point(PlanePoint a, PlanePoint b) { return distance(a, b) < kSamePoint; }

bool centre_from_radius(const ArcWords& words, PlanePoint& centre, Problem& problem) {
  const double radius = *words.radius;
  if (std::abs(radius) < kSamePoint) {
    return problem.set(ErrorCode::kArcRadiusZero, "arc of radius 0");
  }
  if (same_point(words.start, words.end)) {
    return problem.set(ErrorCode::kArcRadiusFullCircle,
                       "an arc with R needs an end point other than its start; a full circle takes I, J or K");
  }
  const double dx = words.end.x - words.start.x;
  const double dy = words.end.y - words.start.y;
  const double chord = distance(words.start, words.end);
  if (chord / 2 - std::abs(radius) > kRadiusSlack) {
    return problem.set(ErrorCode::kArcRadiusTooSmall,
                       fmt::format("R is too small: the end point is {:.4f} mm away", chord));
  }
  const double height = std::sqrt(std::max(0.0, radius * radius - chord * chord / 4));
  // A counter-clockwise arc up to half a turn has its centre on the left of the chord.
  const double left = words.clockwise == (radius > 0) ? -height : height;
  centre = {words.start.x + dx / 2 - left * dy / chord, words.start.y + dy / 2 + left * dx / chord};
  return true;
}

bool centre_from_offsets(const ArcWords& words, PlanePoint& centre, Problem& problem) {
  if (!words.centre_x && !words.centre_y) {
    return problem.set(ErrorCode::kArcNoCentre, "an arc needs its centre or radius: I, J, K or R");
  }
  if (!words.centre_absolute) {
    centre = {words.start.x + words.centre_x.value_or(0), words.start.y + words.centre_y.value_or(0)};
    return true;
  }
  if (!words.centre_x || !words.centre_y) {
    return problem.set(ErrorCode::kArcNoCentre, "under G90.1 an arc needs both words of its centre");
  }
  centre = {*words.centre_x, *words.centre_y};
  return true;
}

bool check_radii(double start, double end, Problem& problem) {
  if (start < kSamePoint || end < kSamePoint) {
    return problem.set(ErrorCode::kArcRadiusZero, "arc of radius 0");
  }
  const double difference = std::abs(start - end);
  const bool off = difference > kRadiusSlack && difference > kRadiusSlackRelative * start;
  if (off || difference > kMaxRadiusSlack) {
    return problem.set(
        ErrorCode::kArcOffCircle,
        fmt::format("the arc's end is not on its circle: radius {:.3f} mm at the start, {:.3f} mm at the end", start,
                    end));
  }
  return true;
}

}  // namespace

bool find_centre(const ArcWords& words, ArcCentre& found, Problem& problem) {
  if (words.radius && (words.centre_x || words.centre_y)) {
    return problem.set(ErrorCode::kArcRadiusAndCentre, "an arc takes R or its centre, not both");
  }
  PlanePoint& centre = found.centre;
  found.full_circle = same_point(words.start, words.end);
  return (words.radius ? centre_from_radius(words, centre, problem) : centre_from_offsets(words, centre, problem)) &&
         check_radii(distance(words.start, centre), distance(words.end, centre), problem);
}

}  // namespace trammel::gcode
