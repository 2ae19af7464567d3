#include "course.hpp"

#include <algorithm>
#include <cmath>

namespace trammel::test {
namespace {

double magnitude(const Vector& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

// The length of the path for feeds and corners, from the mm that each axis moves.
double counted_length(const Vector& mm, const machine::Machine& machine, bool& spatial) {
  Vector in_space{};
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    if (is_spatial(machine.axes[a])) in_space[a] = mm[a];
  }
  spatial = magnitude(in_space) > 0;
  return spatial ? magnitude(in_space) : magnitude(mm);
}

Course line_course(const Path& path, const machine::Machine& machine) {
  Course course;
  Vector mm{};
  double coarsest = 0;
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const double per_tick = static_cast<double>(path.line->increment[a]) * 0x1p-40;
    // Limits apply to the path before its ends were rounded, each by up to half a pulse.
    course.pulses_a_tick[a] = std::max(0.0, std::abs(per_tick) - 1 / static_cast<double>(path.ticks));
    mm[a] = std::round(per_tick * static_cast<double>(path.ticks)) / machine.axes[a].steps_per_mm;
    if (mm[a] != 0 || is_spatial(machine.axes[a])) coarsest = std::max(coarsest, 1 / machine.axes[a].steps_per_mm);
  }
  course.length = counted_length(mm, machine, course.spatial);
  for (std::size_t a = 0; a < mm.size(); ++a) course.entry[a] = course.exit[a] = mm[a] / course.length;
  // Each end is off by up to half a pulse per axis, which is half of sqrt(3) pulses across the path.
  course.error = std::sqrt(3) * coarsest / course.length;
  return course;
}

Course arc_course(const Path& path, const machine::Machine& machine) {
  const driver::ArcChordCommand& arc = *path.arc;
  Course course;
  course.plane = {arc.axis_x, arc.axis_y};
  const double scale = machine.axes[arc.axis_x].steps_per_mm;
  const double unit = std::exp2(arc.m - 40);  // pulses
  const double turn = arc.clockwise ? -1 : 1;
  const double chord = 2 * std::asin(std::exp2(-(arc.k + 1)));
  // The state of Y is half a chord late; this computes Y at the start.
  const double x = static_cast<double>(arc.x) * unit;
  const double y = (static_cast<double>(arc.y) * unit + turn * std::sin(chord / 2) * x) / std::cos(chord / 2);
  const double radius = std::hypot(x, y);
  const double sweep = chord * static_cast<double>(arc.path_ticks) * std::exp2(-arc.m);
  const double path_ticks = static_cast<double>(arc.prescale) * 0x1p-40;  // per feed tick
  const double speed = radius * chord * std::exp2(-arc.m) * path_ticks;   // pulses per feed tick
  Vector mm{};
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const double per_tick = static_cast<double>(arc.increment[a]) * 0x1p-40;
    mm[a] = per_tick * static_cast<double>(arc.path_ticks) / machine.axes[a].steps_per_mm;
    course.pulses_a_tick[a] = std::abs(per_tick) * path_ticks;
  }
  // As for a line: rounding may have moved each end along the arc by half the diagonal of a pulse, and off its circle.
  const double least = std::max(0.0, 1 - 2 * std::sqrt(0.5) / (radius * sweep));
  course.pulses_a_tick[arc.axis_x] = course.pulses_a_tick[arc.axis_y] = speed * least;
  const double in_plane = radius * sweep / scale;
  mm[arc.axis_x] = in_plane;  // the length is the same for any direction in the plane
  course.length = counted_length(mm, machine, course.spatial);
  course.plane_share = in_plane / course.length;
  course.curvature = scale / (radius + std::sqrt(0.5));
  for (std::size_t a = 0; a < mm.size(); ++a) course.entry[a] = course.exit[a] = mm[a] / course.length;
  const double begin = std::atan2(y, x);
  const auto tangent = [&](Vector& direction, double angle) {
    direction[arc.axis_x] = -turn * std::sin(angle) * course.plane_share;
    direction[arc.axis_y] = turn * std::cos(angle) * course.plane_share;
  };
  tangent(course.entry, begin);
  tangent(course.exit, begin + turn * sweep);
  course.error = std::sqrt(3) / std::min(radius, radius * sweep);
  return course;
}

}  // namespace

Course course_of(const Path& path, const machine::Machine& machine) {
  return path.line != nullptr ? line_course(path, machine) : arc_course(path, machine);
}

ArcReading::ArcReading(const driver::ArcChordCommand& arc) : arc_(arc), x_(arc.x), y_(arc.y) {
  axes_[0].increment = static_cast<double>(arc.first_x) * 0x1p-40;
  axes_[1].increment = static_cast<double>(arc.first_y) * 0x1p-40;
  axes_[0].end = axes_[1].end = 1;
}

// The next increment of the axis. The one after the first tick lasts to the end of a chord, for Y of half a chord; the
// following ones last a whole chord.
void ArcReading::turn(unsigned axis) {
  Axis& one = axes_[axis];
  one.place += one.increment * (one.end - one.begin);
  const bool first = one.begin == 0;
  one.begin = one.end;
  const double chord = std::exp2(arc_.m);
  one.end = first ? (axis == 0 ? chord : chord / 2) : one.begin + chord;
  const std::int64_t from = axis == 0 ? y_ : x_;
  const std::int64_t half = std::int64_t{1} << arc_.k >> 1;
  std::int64_t change = (from + half) >> arc_.k;
  if ((axis == 0) != arc_.clockwise) change = -change;
  (axis == 0 ? x_ : y_) += change;
  one.increment = static_cast<double>(change + (axis == 0 ? arc_.closing_x : arc_.closing_y)) * 0x1p-40;
}

std::array<double, 2> ArcReading::at(double path_ticks) {
  // Both axes in the order of time, because each half chord starts from the state of the other axis.
  for (;;) {
    // Y goes first after the first tick, where both increments end, and at half chords; X goes first at whole chords.
    const unsigned next = axes_[1].end <= axes_[0].end ? 1 : 0;
    if (axes_[next].end > path_ticks) break;
    turn(next);
  }
  const auto place = [&](const Axis& axis) { return axis.place + axis.increment * (path_ticks - axis.begin); };
  return {place(axes_[0]), place(axes_[1])};
}

}  // namespace trammel::test
