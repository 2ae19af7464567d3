// Blocks of arcs: on the accumulator where the scales are equal and it reaches, else as chords.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "chords.hpp"
#include "roots.hpp"
#include "trammel/driver/arc.hpp"
#include "trammel/driver/trigonometry.hpp"
#include "trammel/planner/block_builder.hpp"

namespace trammel::planner {
namespace {

constexpr double kMaxRadius = 0x1p44;      // pulses; the centre in 1/256 pulses fits 64 bits
constexpr double kClocksPerPathTick = 10;  // the accumulator takes 9

double hypotenuse(double x, double y) { return std::sqrt(x * x + y * y); }

ExactArc exact_arc(const gcode::Motion& motion, const gcode::Coordinates& from) {
  const double start_x = from[motion.axis_x] - motion.centre_x;
  const double start_y = from[motion.axis_y] - motion.centre_y;
  const double end_x = motion.target[motion.axis_x] - motion.centre_x;
  const double end_y = motion.target[motion.axis_y] - motion.centre_y;
  const double angle_start = driver::arc_tangent(start_y, start_x);
  double sweep = 2 * driver::kPi;
  if (!motion.full_circle) {
    sweep = (driver::arc_tangent(end_y, end_x) - angle_start) * (motion.clockwise ? -1 : 1);
    sweep += sweep <= 0 ? 2 * driver::kPi : 0;
  }
  return {motion.centre_x, motion.centre_y, hypotenuse(start_x, start_y), hypotenuse(end_x, end_y), angle_start, sweep};
}

std::int64_t centre_units(double mm, double steps_per_mm) {
  return std::llround(mm * steps_per_mm * static_cast<double>(driver::kCentreUnitsPerPulse));
}

double largest_radius(const Block& block) { return std::max(block.exact.radius_start, block.exact.radius_end); }

// None where the accumulator's bounds do not admit the arc.
std::optional<driver::ArcCommand> accumulator_arc(const Block& block) {
  const std::int64_t start_x = block.start[block.axis_x];
  const std::int64_t start_y = block.start[block.axis_y];
  driver::ArcGeometry geometry;
  geometry.centre_x = block.centre_x - start_x * driver::kCentreUnitsPerPulse;
  geometry.centre_y = block.centre_y - start_y * driver::kCentreUnitsPerPulse;
  const std::int64_t end_x = block.end[block.axis_x] - start_x;
  const std::int64_t end_y = block.end[block.axis_y] - start_y;
  if (end_x != static_cast<std::int32_t>(end_x) || end_y != static_cast<std::int32_t>(end_y)) return std::nullopt;
  geometry.end_x = static_cast<std::int32_t>(end_x);
  geometry.end_y = static_cast<std::int32_t>(end_y);
  geometry.clockwise = block.clockwise;
  geometry.sweep = block.exact.sweep;
  geometry.axis_x = block.axis_x;
  geometry.axis_y = block.axis_y;
  try {
    return driver::prepare(geometry);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

}  // namespace

std::uint64_t chord_count(const ExactArc& arc, double largest_steps_per_mm) {
  constexpr double kChordError = 0.25;  // pulses
  const double radius = std::max(arc.radius_start, arc.radius_end) * largest_steps_per_mm;
  // A chord over the angle d strays r (1 - cos(d / 2)) from its arc; the arc sine keeps its digits where d is small.
  const double turn = radius > kChordError ? 4 * driver::arc_sine(std::sqrt(kChordError / radius / 2)) : driver::kPi;
  return static_cast<std::uint64_t>(std::ceil(arc.sweep / std::min(turn, driver::kPi / 4)));
}

// The arc's extremes: its start and end are targets, the others lie at whole quarters of a turn.
bool BlockBuilder::check_arc(const Block& block) {
  const ExactArc& arc = block.exact;
  const double scale = std::max(axes_[block.axis_x].steps_per_mm, axes_[block.axis_y].steps_per_mm);
  if (!(largest_radius(block) * scale <= kMaxRadius)) {
    return refuse(gcode::ErrorCode::kArcTooLarge,
                  fmt::format("an arc of radius {:.10g} mm is too large", largest_radius(block)));
  }
  for (int quarter = 0; quarter < 4; ++quarter) {
    double turned = (quarter * (driver::kPi / 2) - arc.angle_start) * (block.clockwise ? -1 : 1);
    while (turned < 0) turned += 2 * driver::kPi;
    while (turned >= 2 * driver::kPi) turned -= 2 * driver::kPi;
    if (turned > arc.sweep) continue;
    const double radius = arc.radius_start + (arc.radius_end - arc.radius_start) * (turned / arc.sweep);
    const double side = quarter < 2 ? radius : -radius;
    const bool fits =
        quarter % 2 == 0 ? check(block.axis_x, arc.centre_x + side) : check(block.axis_y, arc.centre_y + side);
    if (!fits) return false;
  }
  return true;
}

bool BlockBuilder::build_arc(Block& block) {
  block.clockwise = motion_.clockwise;
  block.axis_x = motion_.axis_x;
  block.axis_y = motion_.axis_y;
  block.exact = exact_arc(motion_, exact_);
  if (!check_arc(block)) return false;
  const double scale_x = axes_[block.axis_x].steps_per_mm;
  const double scale_y = axes_[block.axis_y].steps_per_mm;
  block.centre_x = centre_units(motion_.centre_x, scale_x);
  block.centre_y = centre_units(motion_.centre_y, scale_y);
  // Radius and bounds of the accumulator are checked where the command is made.
  if (card_.accumulator && scale_x == scale_y) {
    if (const std::optional<driver::ArcCommand> arc = accumulator_arc(block)) {
      block.arc = *arc;
      return build_accumulator_arc(block);
    }
  }
  return build_chords(block);
}

// The tangent at a share, 0 or 1, of the arc.
Direction BlockBuilder::tangent(const Block& block, double share) {
  const double turn = block.clockwise ? -1 : 1;
  const driver::SineCosine at = driver::sine_cosine(block.exact.angle_start + turn * block.exact.sweep * share);
  Direction direction{};
  direction[block.axis_x] = -turn * at.sine;
  direction[block.axis_y] = turn * at.cosine;
  return direction;
}

// What holds for all ways to make an arc. `unevenness`: largest over planned speed, anywhere in it; `share`: of the
// axes' acceleration and jerk, for what the way to make it adds.
void BlockBuilder::limit_arc(Block& block, double unevenness, double share) const {
  const Axis& x = axes_[block.axis_x];
  const Axis& y = axes_[block.axis_y];
  const double radius = largest_radius(block);
  const double acceleration = std::min(x.acceleration, y.acceleration) * share;
  const double jerk = std::min(x.jerk, y.jerk) * share;
  // Of acceleration and jerk so much goes across the path at the most; what is left serves along it.
  constexpr double kAcross = 0.9;
  constexpr double kAlong = 0.43588989435406736;  // sqrt(1 - kAcross^2)
  block.linear = true;
  block.length = radius * block.exact.sweep;
  block.steps_per_mm = std::max(x.steps_per_mm, y.steps_per_mm);
  block.entry = tangent(block, 0);
  block.exit = tangent(block, 1);
  block.speed = std::min(x.velocity, y.velocity) / unevenness;
  block.limit = SpeedLimit::kAxisVelocity;
  limit_speed(block, std::min(x.pulse_rate / x.steps_per_mm, y.pulse_rate / y.steps_per_mm) / unevenness,
              SpeedLimit::kPulseShape);
  limit_speed(block, std::sqrt(radius * acceleration * kAcross), SpeedLimit::kAcceleration);
  if (jerk < std::numeric_limits<double>::infinity()) {
    limit_speed(block, cube_root(radius * radius * jerk * kAcross), SpeedLimit::kAcceleration);
  }
  apply_feed(block, block.length);
  const double across = block.speed * block.speed / radius;
  block.acceleration =
      std::max(kAlong * acceleration, std::sqrt(std::max(0.0, acceleration * acceleration - across * across)));
  block.jerk = jerk * kAlong;
  block.curvature = (block.clockwise ? -1 : 1) / radius;
}

// Unit steps come evenly: the path's speed changes along it as 1 / (|sin| + |cos|), by 4/pi at the most above its mean,
// and x'' = V^2 / (r (|sin| + |cos|)^3) adds to what a ramp does.
bool BlockBuilder::build_accumulator_arc(Block& block) {
  block.geometry = Geometry::kArc;
  const double steps = static_cast<double>(block.arc.path_ticks);
  const double radius = largest_radius(block);
  const double scale = axes_[block.axis_x].steps_per_mm;
  const double unevenness = std::max(1.0, steps / (radius * scale * block.exact.sweep));
  // Two feed ticks a unit step at least: the step is then within a tick of its time.
  block.least_ticks = 2 * block.arc.path_ticks;
  limit_arc(block, unevenness, 0.5 / (unevenness * unevenness));
  const double unit_steps = steps / block.length;
  limit_speed(block, card_.clock_hz / kClocksPerPathTick / unit_steps, SpeedLimit::kClock);
  for (Direction* end : {&block.entry, &block.exit}) {
    double sum = 0;
    for (const double part : *end) sum += std::abs(part);
    for (double& part : *end) part *= unevenness / sum;
  }
  return true;
}

// Lines between corners on the arc at equal angles.
bool BlockBuilder::build_chords(Block& block) {
  const Axis& x = axes_[block.axis_x];
  const Axis& y = axes_[block.axis_y];
  block.geometry = Geometry::kChords;
  block.chords = chord_count(block.exact, std::max(x.steps_per_mm, y.steps_per_mm));
  block.chord_lines = 0;
  std::int64_t longest = 0;
  for_each_chord(block, x.steps_per_mm, y.steps_per_mm, [&](Corner step) {
    ++block.chord_lines;
    longest = std::max({longest, std::abs(step.x), std::abs(step.y)});
  });
  if (block.chord_lines == 0) return false;
  block.least_ticks = static_cast<std::uint64_t>(longest + 1) * block.chord_lines;
  limit_arc(block, 1, 1);
  return true;
}

}  // namespace trammel::planner
