#include "planner_paths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "trammel/card_map.hpp"
#include "trammel/driver/arc.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/planner/profile.hpp"

namespace trammel::planner {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kTicksPerPulse = 128;     // steps even to 1/64
constexpr double kLeastTicks = 22;         // clocks that the card needs to decode the next line
constexpr double kMostTicks = 0x1p39;      // half of the command's 40 bits
constexpr double kLeastRate = 0x1p-30;     // ticks a clock; four times the finest floor
constexpr double kClocksPerPathTick = 10;  // the accumulator takes 9
constexpr double kShaperShare = 0.95;      // of the rate at which the shaper makes pulses without a pause
constexpr double kChordError = 0.25;       // pulses
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// What holds along a path; distances in pulses of path length.
struct PathLimits {
  double length = 0;           // pulses
  double velocity = kNoLimit;  // pulses/s
  double acceleration = 0;     // pulses/s^2
};

// Pulses/s that an axis may make: its own limit, and what its pulse shape allows.
double axis_velocity(const PathContext& context, std::size_t axis) {
  const machine::MachineAxis& settings = context.machine.axes[axis];
  const double clocks =
      driver::shortest_pulse_period(machine::clocks_from_ns(settings.step_length_ns, context.clock_hz),
                                    machine::clocks_from_ns(settings.step_space_ns, context.clock_hz));
  return std::min(settings.max_velocity * settings.steps_per_mm, kShaperShare * context.clock_hz / clocks);
}

double axis_acceleration(const PathContext& context, std::size_t axis) {
  const machine::MachineAxis& settings = context.machine.axes[axis];
  return settings.max_acceleration * settings.steps_per_mm;
}

// Feed ticks of a path: T a pulse, as large as the clock allows.
double ticks_for(const PathContext& context, const PathLimits& limits) {
  double per_pulse = std::min(kTicksPerPulse, kMaxTickRate * context.clock_hz / limits.velocity);
  per_pulse = std::max(per_pulse, kLeastRate * context.clock_hz / limits.velocity);
  return std::clamp(std::round(per_pulse * limits.length), kLeastTicks, kMostTicks);
}

// Sends the profile of `ticks` feed ticks over a path; the duration goes into the segment.
void append_profile(const PathContext& context, const PathLimits& limits, std::uint64_t ticks,
                    PlannedSegment& segment) {
  const long double per_pulse = static_cast<long double>(ticks) / limits.length;
  const long double clock = context.clock_hz;
  const ProfileLimits profile{limits.velocity * per_pulse / clock, limits.acceleration * per_pulse / clock / clock};
  const std::vector<driver::FeedCommand> pieces = trapezoid(ticks, profile);
  segment.seconds = static_cast<double>(duration(pieces) / clock);
  segment.commands.insert(segment.commands.end(), pieces.begin(), pieces.end());
}

std::int64_t increment(std::int64_t pulses, std::uint64_t ticks) {
  const driver::int128 magnitude = pulses < 0 ? -static_cast<driver::int128>(pulses) : pulses;
  const auto wide_ticks = static_cast<driver::int128>(ticks);
  const auto rounded = static_cast<std::int64_t>(((magnitude << 41) + wide_ticks) / (2 * wide_ticks));
  return pulses < 0 ? -rounded : rounded;
}

driver::LineCommand line_command(const Pulses& from, const Pulses& to, std::uint64_t ticks) {
  driver::LineCommand line;
  line.ticks = ticks;
  for (std::size_t axis = 0; axis < card_map::kMaxAxes; ++axis) {
    if (to[axis] != from[axis]) {
      line.mask = static_cast<std::uint8_t>(line.mask | (1U << axis));
      line.increment[axis] = increment(to[axis] - from[axis], ticks);
    }
  }
  return line;
}

// Displacement in mm of the axes named by `letters`.
double displacement(const PathContext& context, const PlannedSegment& segment, std::string_view letters) {
  double sum = 0;
  for (std::size_t axis = 0; axis < context.machine.axes.size(); ++axis) {
    const machine::MachineAxis& settings = context.machine.axes[axis];
    if (letters.find(settings.letter) != std::string_view::npos) {
      const double mm = static_cast<double>(segment.end[axis] - segment.start[axis]) / settings.steps_per_mm;
      sum += mm * mm;
    }
  }
  return std::sqrt(sum);
}

// The length along which the feed holds.
double feed_length(const PathContext& context, const PlannedSegment& segment) {
  for (const std::string_view letters : {"XYZ", "UVW", "ABC"}) {
    if (const double length = displacement(context, segment, letters); length > 0) {
      return length;
    }
  }
  return displacement(context, segment, "E");
}

// Seconds that the program gives a motion, 0 for as fast as may be.
double programmed_seconds(const gcode::Motion& motion, double length_mm) {
  if (motion.kind == gcode::MotionKind::kTraverse) {
    return 0;
  }
  return motion.seconds > 0 ? motion.seconds : length_mm / motion.feed;
}

void limit_to_program(double seconds, PathLimits& limits) {
  if (seconds > 0) {
    limits.velocity = std::min(limits.velocity, limits.length / seconds);
  }
}

// Limits of an arc: the speed changes along it in direction, and on the accumulator in size too (uniform in unit steps,
// as x'' = V^2 / (r (|sin| + |cos|)^3) at most V^2 / r), so that on either axis the two accelerations may add up; each
// gets half of the axis's.
void limit_curve(double radius, double axis_limit, PathLimits& limits) {
  limits.acceleration = axis_limit / 2;
  limits.velocity = std::min(limits.velocity, std::sqrt(radius * axis_limit / 2));
}

std::int64_t centre_units(double mm, double steps_per_mm) {
  return std::llround(mm * steps_per_mm * static_cast<double>(driver::kCentreUnitsPerPulse));
}

// The arc on the accumulator but for its time; none when it lies beyond what that takes.
std::optional<driver::ArcCommand> accumulator_arc(const PlannedSegment& segment) {
  const std::int64_t start_x = segment.start[segment.axis_x];
  const std::int64_t start_y = segment.start[segment.axis_y];
  const std::int64_t end_x = segment.end[segment.axis_x] - start_x;
  const std::int64_t end_y = segment.end[segment.axis_y] - start_y;
  if (end_x != static_cast<std::int32_t>(end_x) || end_y != static_cast<std::int32_t>(end_y)) {
    return std::nullopt;
  }
  driver::ArcGeometry geometry;
  geometry.centre_x = segment.centre_x - start_x * driver::kCentreUnitsPerPulse;
  geometry.centre_y = segment.centre_y - start_y * driver::kCentreUnitsPerPulse;
  geometry.end_x = static_cast<std::int32_t>(end_x);
  geometry.end_y = static_cast<std::int32_t>(end_y);
  geometry.clockwise = segment.clockwise;
  geometry.sweep = segment.sweep;
  geometry.axis_x = segment.axis_x;
  geometry.axis_y = segment.axis_y;
  try {
    return driver::prepare(geometry);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

void plan_accumulator(const PathContext& context, const gcode::Motion& motion, const ExactArc& exact,
                      const driver::ArcCommand& arc, PlannedSegment& segment) {
  const double steps_per_mm = context.machine.axes[motion.axis_x].steps_per_mm;
  const double radius = std::max(exact.radius_start, exact.radius_end);
  PathLimits limits;
  // In unit steps: the speed that the faster axis has where the arc runs along it.
  limits.length = static_cast<double>(arc.path_ticks);
  limits.velocity = std::min({axis_velocity(context, motion.axis_x), axis_velocity(context, motion.axis_y),
                              context.clock_hz / kClocksPerPathTick});
  limit_curve(radius * steps_per_mm,
              std::min(axis_acceleration(context, motion.axis_x), axis_acceleration(context, motion.axis_y)), limits);
  limit_to_program(programmed_seconds(motion, radius * exact.sweep), limits);
  // Two feed ticks a unit step at least: the step is then within a tick of its time.
  const double ticks = std::max(ticks_for(context, limits), 2 * limits.length);
  const auto whole = static_cast<std::uint64_t>(ticks);
  append_profile(context, limits, whole, segment);
  segment.commands.emplace_back(driver::with_ticks(arc, whole));
}

// Corners of the chords, the end included; whole pulses, next to points of the ellipse.
std::vector<Pulses> chord_ends(const PathContext& context, const gcode::Motion& motion, const ExactArc& exact,
                               const PlannedSegment& segment) {
  const double scale_x = context.machine.axes[motion.axis_x].steps_per_mm;
  const double scale_y = context.machine.axes[motion.axis_y].steps_per_mm;
  const double largest = std::max(exact.radius_start, exact.radius_end) * std::max(scale_x, scale_y);
  // A chord over the angle d strays r (1 - cos(d / 2)) from its arc; asin keeps its digits where d is small.
  const double turn = largest > kChordError ? 4 * std::asin(std::sqrt(kChordError / largest / 2)) : kPi;
  const double count = std::ceil(exact.sweep / std::min(turn, kPi / 4));
  std::vector<Pulses> ends;
  for (double i = 1; i < count; ++i) {
    const double share = i / count;
    const double angle = exact.angle_start + (motion.clockwise ? -1 : 1) * exact.sweep * share;
    const double radius = exact.radius_start + (exact.radius_end - exact.radius_start) * share;
    Pulses point = segment.start;
    point[motion.axis_x] = to_pulses(motion.centre_x + radius * std::cos(angle), scale_x);
    point[motion.axis_y] = to_pulses(motion.centre_y + radius * std::sin(angle), scale_y);
    ends.push_back(point);
  }
  ends.push_back(segment.end);
  return ends;
}

// One profile over all chords, each the same number of ticks: they cover equal angles.
bool plan_chords(const PathContext& context, const gcode::Motion& motion, const ExactArc& exact,
                 PlannedSegment& segment) {
  std::vector<Pulses> corners = chord_ends(context, motion, exact, segment);
  corners.insert(corners.begin(), segment.start);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  const double count = static_cast<double>(corners.size() - 1);
  if (count == 0) {
    return false;
  }
  const double radius = std::max(exact.radius_start, exact.radius_end);
  const double scale =
      std::max(context.machine.axes[motion.axis_x].steps_per_mm, context.machine.axes[motion.axis_y].steps_per_mm);
  PathLimits limits;
  limits.length = radius * exact.sweep * scale;
  double longest = 1;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    for (const std::size_t axis : {motion.axis_x, motion.axis_y}) {
      const double pulses = static_cast<double>(std::abs(corners[i][axis] - corners[i - 1][axis]));
      longest = std::max(longest, pulses);
      if (pulses > 0) {
        limits.velocity = std::min(limits.velocity, axis_velocity(context, axis) * limits.length / count / pulses);
      }
    }
  }
  limit_curve(radius * scale,
              scale * std::min(context.machine.axes[motion.axis_x].max_acceleration,
                               context.machine.axes[motion.axis_y].max_acceleration),
              limits);
  limit_to_program(programmed_seconds(motion, radius * exact.sweep), limits);
  const double each = std::max({std::round(ticks_for(context, limits) / count), longest, kLeastTicks});
  const auto ticks = static_cast<std::uint64_t>(each);
  append_profile(context, limits, ticks * (corners.size() - 1), segment);
  for (std::size_t i = 1; i < corners.size(); ++i) {
    segment.commands.emplace_back(line_command(corners[i - 1], corners[i], ticks));
  }
  return true;
}

}  // namespace

std::int64_t to_pulses(double mm, double steps_per_mm) {
  const double pulses = mm * steps_per_mm;
  return std::llround(pulses + std::copysign(1e-9 + 1e-15 * std::abs(pulses), pulses));
}

ExactArc exact_arc(const gcode::Motion& motion, const gcode::Coordinates& from) {
  const double start_x = from[motion.axis_x] - motion.centre_x;
  const double start_y = from[motion.axis_y] - motion.centre_y;
  const double end_x = motion.target[motion.axis_x] - motion.centre_x;
  const double end_y = motion.target[motion.axis_y] - motion.centre_y;
  const double angle_start = std::atan2(start_y, start_x);
  double sweep = 2 * kPi;
  if (!motion.full_circle) {
    sweep = (std::atan2(end_y, end_x) - angle_start) * (motion.clockwise ? -1 : 1);
    sweep += sweep <= 0 ? 2 * kPi : 0;
  }
  return {std::hypot(start_x, start_y), std::hypot(end_x, end_y), angle_start, sweep};
}

bool plan_line(const PathContext& context, const gcode::Motion& motion, PlannedSegment& segment) {
  double squares = 0;
  double scale = 0;
  double most = 0;
  double velocity_share = kNoLimit;      // paths a second
  double acceleration_share = kNoLimit;  // paths a second^2
  for (std::size_t axis = 0; axis < context.machine.axes.size(); ++axis) {
    const double pulses = std::abs(static_cast<double>(segment.end[axis] - segment.start[axis]));
    if (pulses == 0) {
      continue;
    }
    const double steps_per_mm = context.machine.axes[axis].steps_per_mm;
    scale = std::max(scale, steps_per_mm);
    most = std::max(most, pulses);
    squares += (pulses / steps_per_mm) * (pulses / steps_per_mm);
    velocity_share = std::min(velocity_share, axis_velocity(context, axis) / pulses);
    acceleration_share = std::min(acceleration_share, axis_acceleration(context, axis) / pulses);
  }
  if (squares == 0) {
    return false;
  }
  PathLimits limits;
  limits.length = std::sqrt(squares) * scale;
  limits.velocity = velocity_share * limits.length;
  limits.acceleration = acceleration_share * limits.length;
  limit_to_program(programmed_seconds(motion, feed_length(context, segment)), limits);
  // At most one pulse a tick.
  const double ticks = std::max(ticks_for(context, limits), most);
  const auto whole = static_cast<std::uint64_t>(ticks);
  append_profile(context, limits, whole, segment);
  segment.commands.emplace_back(line_command(segment.start, segment.end, whole));
  return true;
}

bool plan_arc(const PathContext& context, const gcode::Motion& motion, const gcode::Coordinates& from,
              PlannedSegment& segment) {
  const ExactArc exact = exact_arc(motion, from);
  const double scale_x = context.machine.axes[motion.axis_x].steps_per_mm;
  const double scale_y = context.machine.axes[motion.axis_y].steps_per_mm;
  segment.clockwise = motion.clockwise;
  segment.axis_x = motion.axis_x;
  segment.axis_y = motion.axis_y;
  segment.centre_x = centre_units(motion.centre_x, scale_x);
  segment.centre_y = centre_units(motion.centre_y, scale_y);
  segment.sweep = exact.sweep;
  // Radius and bounds of the accumulator are checked there.
  const bool equal = scale_x == scale_y;
  const std::optional<driver::ArcCommand> arc = equal ? accumulator_arc(segment) : std::nullopt;
  if (arc) {
    plan_accumulator(context, motion, exact, *arc, segment);
    return true;
  }
  segment.chords = true;
  return plan_chords(context, motion, exact, segment);
}

}  // namespace trammel::planner
