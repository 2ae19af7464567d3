// Blocks of arcs and helices. The arc generator makes them, if the card has one and a circle is a circle in pulses.
// Else the accumulator makes arcs, if the card has one and they are in its range. All others are made as chords.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "axis_limits.hpp"
#include "chords.hpp"
#include "roots.hpp"
#include "trammel/driver/arc.hpp"
#include "trammel/driver/arc_chord.hpp"
#include "trammel/driver/trigonometry.hpp"
#include "trammel/planner/block_builder.hpp"

namespace trammel::planner {
namespace {

constexpr double kMaxRadius = 0x1p44;             // pulses; the centre in 1/256 pulses fits 64 bits
constexpr double kClocksPerPathTick = 10;         // the accumulator takes 9
constexpr double kClocksPerEightDirections = 18;  // the accumulator takes 17
constexpr std::uint64_t kMaxParts = 1'000'000;

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
  sweep += 2 * driver::kPi * motion.turns;
  return {motion.centre_x, motion.centre_y, hypotenuse(start_x, start_y), hypotenuse(end_x, end_y), angle_start, sweep};
}

std::int64_t centre_units(const kinematics::Kinematics& kinematics, std::size_t joint, const Direction& centre) {
  const double units = kinematics.pulse_rate(joint, centre) * static_cast<double>(driver::kCentreUnitsPerPulse);
  return std::llround(units);
}

// Two unit vectors at right angles that span the arc's plane.
struct PlaneVectors {
  Direction first{};
  Direction second{};
};

PlaneVectors plane_vectors(const Block& block) {
  PlaneVectors plane;
  if (!block.tilted) {
    plane.first[block.axis_x] = 1;
    plane.second[block.axis_y] = 1;
    return plane;
  }
  for (std::size_t i = 0; i < block.space.axes.size(); ++i) {
    plane.first[block.space.axes[i]] = block.space.first[i];
    plane.second[block.space.axes[i]] = block.space.second[i];
  }
  return plane;
}

double largest_radius(const Block& block) { return std::max(block.exact.radius_start, block.exact.radius_end); }

// The block's arc between two points on it. Throws std::invalid_argument if they are too far apart.
driver::ArcGeometry geometry_of(const Block& block, const Pulses& start, const Pulses& end, double sweep) {
  driver::ArcGeometry geometry;
  geometry.centre_x = block.centre_x - start[block.joint_x] * driver::kCentreUnitsPerPulse;
  geometry.centre_y = block.centre_y - start[block.joint_y] * driver::kCentreUnitsPerPulse;
  const std::int64_t end_x = end[block.joint_x] - start[block.joint_x];
  const std::int64_t end_y = end[block.joint_y] - start[block.joint_y];
  geometry.end_x = static_cast<std::int32_t>(end_x);
  geometry.end_y = static_cast<std::int32_t>(end_y);
  if (geometry.end_x != end_x || geometry.end_y != end_y)
    throw std::invalid_argument("arc: its ends are too far apart");
  geometry.clockwise = block.joints_clockwise;
  geometry.sweep = sweep;
  geometry.axis_x = block.joint_x;
  geometry.axis_y = block.joint_y;
  return geometry;
}

bool is_helix(const Block& block) {
  for (std::size_t joint = 0; joint < block.start.size(); ++joint) {
    const bool turns = joint == block.joint_x || joint == block.joint_y;
    if (!turns && block.start[joint] != block.end[joint]) return true;
  }
  return false;
}

// A circle on axes of unequal steps/mm is an ellipse in pulses. Its centre and semi-axes are rounded to whole pulses.
driver::EllipseGeometry ellipse_of(const Block& block, const kinematics::PlaneMap& plane) {
  const driver::ArcGeometry arc = geometry_of(block, block.start, block.end, block.exact.sweep);
  const double radius = (block.exact.radius_start + block.exact.radius_end) / 2;
  const auto whole = [](std::int64_t units) {
    return std::llround(static_cast<double>(units) / static_cast<double>(driver::kCentreUnitsPerPulse));
  };
  driver::EllipseGeometry ellipse;
  ellipse.semi_x = std::llround(radius * plane.scale_x);
  ellipse.semi_y = std::llround(radius * plane.scale_y);
  ellipse.start_x = -whole(arc.centre_x);
  ellipse.start_y = -whole(arc.centre_y);
  ellipse.end_x = arc.end_x;
  ellipse.end_y = arc.end_y;
  ellipse.clockwise = arc.clockwise;
  ellipse.sweep = arc.sweep;
  ellipse.axis_x = arc.axis_x;
  ellipse.axis_y = arc.axis_y;
  return ellipse;
}

// Empty if the accumulator's bounds do not admit the arc.
std::optional<driver::ArcCommand> accumulator_arc(const Block& block, const kinematics::PlaneMap& plane,
                                                  driver::StepRule rule) {
  try {
    if (!plane.circle) return driver::prepare(ellipse_of(block, plane), rule);
    return driver::prepare(geometry_of(block, block.start, block.end, block.exact.sweep), rule);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

}  // namespace

std::uint64_t chord_count(const ExactArc& arc, double max_pulses_per_mm) {
  constexpr double kChordError = 0.25;  // pulses
  const double radius = std::max(arc.radius_start, arc.radius_end) * max_pulses_per_mm;
  // A chord over the angle d deviates by r (1 - cos(d / 2)) from its arc; the arc sine keeps its digits for small d.
  const double turn = radius > kChordError ? 4 * driver::arc_sine(std::sqrt(kChordError / radius / 2)) : driver::kPi;
  return static_cast<std::uint64_t>(std::ceil(arc.sweep / std::min(turn, driver::kPi / 4)));
}

driver::HelixGeometry helix_part(const Block& block, std::uint64_t i, const kinematics::Kinematics& kinematics) {
  const Pulses start = corner(block, i, block.parts, kinematics);
  const Pulses end = corner(block, i + 1, block.parts, kinematics);
  driver::HelixGeometry helix;
  helix.arc = geometry_of(block, start, end, block.exact.sweep / static_cast<double>(block.parts));
  for (std::size_t joint = 0; joint < start.size(); ++joint) {
    if (joint != block.joint_x && joint != block.joint_y) helix.further[joint] = end[joint] - start[joint];
  }
  return helix;
}

// Checks the extremes at whole quarters of a turn. Start and end of the arc are checked as targets.
bool BlockBuilder::check_arc(const Block& block) {
  const ExactArc& arc = block.exact;
  const double scale = std::max(kinematics_.finest(block.axis_x), kinematics_.finest(block.axis_y));
  if (!(largest_radius(block) * scale <= kMaxRadius)) {
    return refuse(gcode::ErrorCode::kArcTooLarge,
                  fmt::format("an arc of radius {:.10g} mm is too large", largest_radius(block)));
  }
  for (int quarter = 0; quarter < 4; ++quarter) {
    double turned = (quarter * (driver::kPi / 2) - arc.angle_start) * (block.clockwise ? -1 : 1);
    while (turned < 0) turned += 2 * driver::kPi;
    while (turned >= 2 * driver::kPi) turned -= 2 * driver::kPi;
    if (turned > arc.sweep) continue;
    // The first and the last time that the arc gets there.
    for (const double at : {turned, turned + 2 * driver::kPi * std::floor((arc.sweep - turned) / (2 * driver::kPi))}) {
      const double radius = arc.radius_start + (arc.radius_end - arc.radius_start) * (at / arc.sweep);
      const double side = quarter < 2 ? radius : -radius;
      const bool fits =
          quarter % 2 == 0 ? check(block.axis_x, arc.centre_x + side) : check(block.axis_y, arc.centre_y + side);
      if (!fits) return false;
    }
  }
  return true;
}

bool BlockBuilder::build_arc(Block& block) {
  block.tilted = motion_.tilted;
  if (motion_.tilted) return build_tilted(block);
  block.clockwise = motion_.clockwise;
  block.axis_x = motion_.axis_x;
  block.axis_y = motion_.axis_y;
  block.exact = exact_arc(motion_, exact_);
  if (!check_arc(block)) return false;
  const std::optional<kinematics::PlaneMap> plane = kinematics_.plane(block.axis_x, block.axis_y);
  if (!plane) return build_chords(block);
  block.joint_x = plane->joint_x;
  block.joint_y = plane->joint_y;
  block.joints_clockwise = block.clockwise != plane->mirrored;
  Direction centre{};
  centre[block.axis_x] = motion_.centre_x;
  centre[block.axis_y] = motion_.centre_y;
  block.centre_x = centre_units(kinematics_, plane->joint_x, centre);
  block.centre_y = centre_units(kinematics_, plane->joint_y, centre);
  // Radius and bounds are checked when the commands are made.
  if (card_.arc_generator && plane->circle && build_generator_arc(block, *plane)) return true;
  // On a card with a generator, a circle on unequal scales becomes chords: they follow it more closely than an ellipse
  // of whole pulses.
  const bool accumulates = card_.accumulator && (plane->circle || !card_.arc_generator);
  const auto rule = card_.eight_directions ? driver::StepRule::kEightDirections : driver::StepRule::kFourDirections;
  if (accumulates && !is_helix(block)) {
    if (const std::optional<driver::ArcCommand> arc = accumulator_arc(block, *plane, rule)) {
      block.arc = *arc;
      return build_accumulator_arc(block, *plane);
    }
  }
  return build_chords(block);
}

// A blend outside the main planes. No engine of the card can make it.
bool BlockBuilder::build_tilted(Block& block) {
  block.clockwise = false;
  block.space = motion_.space;
  block.axis_x = block.space.axes[0];
  block.axis_y = block.space.axes[1];
  block.exact = {};
  block.exact.radius_start = block.exact.radius_end = block.space.radius;
  block.exact.sweep = block.space.sweep;
  return build_chords(block);
}

// Direction in the plane at the arc's beginning (`share` 0) or end (1).
Direction BlockBuilder::tangent(const Block& block, double share) {
  if (block.tilted) {
    const SpaceArc& space = block.space;
    const driver::SineCosine at = driver::sine_cosine(space.sweep * share);
    Direction direction{};
    for (std::size_t i = 0; i < space.axes.size(); ++i) {
      direction[space.axes[i]] = at.cosine * space.second[i] - at.sine * space.first[i];
    }
    return direction;
  }
  const double turn = block.clockwise ? -1 : 1;
  const driver::SineCosine at = driver::sine_cosine(block.exact.angle_start + turn * block.exact.sweep * share);
  Direction direction{};
  direction[block.axis_x] = -turn * at.sine;
  direction[block.axis_y] = turn * at.cosine;
  return direction;
}

// Sets length, scale and directions; returns the length that F counts. The arc is measured as a straight line, whose
// components are the unrolled arc and the axes outside its plane.
double BlockBuilder::measure_arc(Block& block) const {
  const double length = largest_radius(block) * block.exact.sweep;  // in the plane
  gcode::Coordinates way{};
  for (std::size_t i = 0; i < axis_count_; ++i) way[i] = in_plane(block, i) ? 0 : motion_.target[i] - anchor_[i];
  way[block.axis_x] = length;
  const double feed_length = measure_line(block, way);
  block.pulses_per_mm = std::max(block.pulses_per_mm, finest_in_plane(block));
  block.entry = tangent(block, 0);
  block.exit = tangent(block, 1);
  for (Direction* end : {&block.entry, &block.exit}) {
    for (std::size_t i = 0; i < axis_count_; ++i) {
      (*end)[i] = in_plane(block, i) ? (*end)[i] * (length / block.length) : way[i] / block.length;
    }
  }
  return feed_length;
}

// Applies the limits of the axes outside the plane and of the joints that they move.
void BlockBuilder::limit_further(Block& block) const {
  for (std::size_t i = 0; i < axis_count_; ++i) {
    const double share = std::abs(block.entry[i]);
    if (in_plane(block, i) || share == 0) continue;
    limit_speed(block, axes_[i].velocity / share, SpeedLimit::kAxisVelocity);
    block.acceleration = std::min(block.acceleration, axes_[i].acceleration / share);
    block.jerk = std::min(block.jerk, axes_[i].jerk / share);
  }
  for (std::size_t i = 0; i < joint_count(); ++i) {
    const double share = joint_share(block, i);
    if (share == 0) continue;
    limit_speed(block, joints_[i].pulses / kinematics_.joint(i).steps_per_mm / share, SpeedLimit::kPulseShape);
    limit_speed(block, joints_[i].velocity / share, SpeedLimit::kAxisVelocity);
    block.acceleration = std::min(block.acceleration, joints_[i].acceleration / share);
    block.jerk = std::min(block.jerk, joints_[i].jerk / share);
  }
}

// The most pulses that a joint makes per mm in the plane, along one axis or in any direction.
double BlockBuilder::finest_in_plane(const Block& block) const {
  const PlaneVectors plane = plane_vectors(block);
  double finest = 0;
  for (std::size_t i = 0; i < axis_count_; ++i) {
    if (in_plane(block, i)) finest = std::max(finest, kinematics_.finest(i));
  }
  for (std::size_t i = 0; i < joint_count(); ++i) {
    const double most = kinematics_.max_in_plane(i, plane.first, plane.second);
    finest = std::max(finest, most * kinematics_.joint(i).steps_per_mm);
  }
  return finest;
}

// Largest mm of a joint per mm of path, if axes outside the plane move the joint, else 0. These axes move evenly along
// the whole arc. If the plane moves the joint too, the result is the sum of both.
double BlockBuilder::joint_share(const Block& block, std::size_t joint) const {
  Direction further = block.entry;
  for (std::size_t i = 0; i < axis_count_; ++i) further[i] = in_plane(block, i) ? 0 : further[i];
  const double beside = std::abs(kinematics_.joint_rate(joint, further));
  if (beside == 0) return 0;
  const PlaneVectors plane = plane_vectors(block);
  const double slope = largest_radius(block) * block.exact.sweep / block.length;
  return beside + slope * kinematics_.max_in_plane(joint, plane.first, plane.second);
}

// No direction in the plane has a larger component of an axis or joint than the two unit vectors together (root of the
// sum of squares).
BlockBuilder::PlaneLimits BlockBuilder::plane_limits(const Block& block) const {
  PlaneLimits limits{kNoLimit, kNoLimit, kNoLimit, kNoLimit};
  const auto take = [&limits](const auto& of, double share) {
    limits.velocity = std::min(limits.velocity, of.velocity / share);
    limits.acceleration = std::min(limits.acceleration, of.acceleration / share);
    limits.jerk = std::min(limits.jerk, of.jerk / share);
  };
  const PlaneVectors plane = plane_vectors(block);
  for (std::size_t i = 0; i < axis_count_; ++i) {
    const double share = hypotenuse(plane.first[i], plane.second[i]);
    if (share > 0) take(axes_[i], share);
  }
  for (std::size_t i = 0; i < joint_count(); ++i) {
    const double share = kinematics_.max_in_plane(i, plane.first, plane.second);
    if (share == 0) continue;
    take(joints_[i], share);
    limits.pulse_speed = std::min(limits.pulse_speed, joints_[i].pulses / kinematics_.joint(i).steps_per_mm / share);
  }
  return limits;
}

// Applies the limits that hold whatever makes the arc. `unevenness`: largest speed anywhere on it over planned speed.
// `share`: share of the axes' acceleration and jerk that is left beside what the method adds.
void BlockBuilder::limit_arc(Block& block, double unevenness, double share) const {
  const PlaneLimits plane = plane_limits(block);
  const double radius = largest_radius(block);
  const double feed_length = measure_arc(block);
  const double slope = radius * block.exact.sweep / block.length;  // mm in the plane per mm of path
  const double acceleration = plane.acceleration * share;
  const double jerk = plane.jerk * share;
  block.speed = plane.velocity / unevenness / slope;
  block.limit = SpeedLimit::kAxisVelocity;
  limit_speed(block, plane.pulse_speed / unevenness / slope, SpeedLimit::kPulseShape);
  limit_speed(block, std::sqrt(radius * acceleration * kAcross) / slope, SpeedLimit::kAcceleration);
  if (jerk < kNoLimit) {
    limit_speed(block, cube_root(radius * radius * jerk * kTurningJerk) / slope, SpeedLimit::kAcceleration);
  }
  block.acceleration = block.jerk = kNoLimit;
  limit_further(block);
  apply_feed(block, feed_length);
  block.curve = {acceleration / slope, slope / radius, std::min(block.acceleration, acceleration / slope), jerk / slope,
                 std::min(block.jerk, jerk / slope)};
  block.acceleration = std::min(block.acceleration, block.curve.along(block.speed));
  block.jerk = std::min(block.jerk, block.curve.least_jerk(block.speed));
  block.curvature = (block.clockwise ? -1 : 1) * slope * slope / radius;
}

// False if the generator cannot make the arc.
bool BlockBuilder::build_generator_arc(Block& block, const kinematics::PlaneMap& plane) const {
  constexpr double kMaxTurns = 50'000;   // per command: half of what the driver takes
  constexpr double kMaxPulses = 0x1p30;  // along the path of a command: at 64 path ticks per pulse half of 2^37
  const double turns = block.exact.sweep / (2 * driver::kPi);
  const double pulses = largest_radius(block) * block.exact.sweep * plane.scale_x;
  block.geometry = Geometry::kArcChord;
  block.parts = static_cast<std::uint64_t>(std::ceil(std::max(turns / kMaxTurns, pulses / kMaxPulses)));
  block.parts = std::max<std::uint64_t>(block.parts, 1);
  if (block.parts > kMaxParts) return false;
  try {
    std::uint64_t most = 0;
    for (std::uint64_t i = 0; i < block.parts; ++i) {
      most = std::max(most, driver::least_chord_ticks(helix_part(block, i, kinematics_)));
    }
    block.least_ticks = most * block.parts;
  } catch (const std::invalid_argument&) {
    return false;
  }
  limit_arc(block, 1, 1);
  return true;
}

// The accumulator makes V unit steps per second evenly, so the speed along the path varies as V / g. g is the number of
// unit steps per mm, which depends on the direction; sx and sy are the steps/mm of the axes.
// In 4 directions g = |sin| sx + |cos| sy, which is least along the coarser axis; on equal scales the speed is at most
// 4/pi times its mean. The variation adds an acceleration of V^2 sqrt(sx^2 + sy^2) / (r g^3) to that of ramps.
// In 8 directions a diagonal is one step: g = max(|sin| sx, |cos| sy), which is least along the diagonal. The
// acceleration is at most V^2 max(sx, sy) / (r g^3).
bool BlockBuilder::build_accumulator_arc(Block& block, const kinematics::PlaneMap& plane) {
  block.geometry = Geometry::kArc;
  const bool eight = block.arc.eight_directions;
  const double steps = static_cast<double>(block.arc.path_ticks);
  const double radius = largest_radius(block);
  const double scale_x = plane.scale_x;
  const double scale_y = plane.scale_y;
  const double both = hypotenuse(scale_x, scale_y);
  const double least = eight ? scale_x * scale_y / both : std::min(scale_x, scale_y);
  const double mean = std::max(least, steps / (radius * block.exact.sweep));  // steps per mm
  const double unevenness = mean / least;
  const double share = std::sqrt(0.5) * least / (eight ? std::max(scale_x, scale_y) : both);
  // At least two feed ticks per unit step, so that the step is within one tick of its time.
  block.least_ticks = 2 * block.arc.path_ticks;
  limit_arc(block, unevenness, share / (unevenness * unevenness));
  const double unit_steps = steps / block.length;
  const double clocks = eight ? kClocksPerEightDirections : kClocksPerPathTick;
  limit_speed(block, card_.clock_hz / clocks / unit_steps, SpeedLimit::kClock);
  for (Direction* end : {&block.entry, &block.exit}) {
    const double x = std::abs(kinematics_.pulse_rate(plane.joint_x, *end));
    const double y = std::abs(kinematics_.pulse_rate(plane.joint_y, *end));
    const double here = eight ? std::max(x, y) : x + y;
    for (double& part : *end) part *= mean / here;
  }
  return true;
}

// Lines between corners on the arc at equal angles.
bool BlockBuilder::build_chords(Block& block) {
  block.geometry = Geometry::kChords;
  block.chords = chord_count(block.exact, finest_in_plane(block));
  block.chord_lines = 0;
  std::int64_t longest = 0;
  for_each_chord(block, kinematics_, [&](const Pulses& step) {
    ++block.chord_lines;
    for (const std::int64_t pulses : step) longest = std::max(longest, std::abs(pulses));
  });
  if (block.chord_lines == 0) return false;
  block.least_ticks = static_cast<std::uint64_t>(longest + 1) * block.chord_lines;
  limit_arc(block, 1, 1);
  return true;
}

}  // namespace trammel::planner
