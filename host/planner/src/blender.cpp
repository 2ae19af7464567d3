#include "trammel/planner/blender.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "corner_time.hpp"
#include "fillet.hpp"
#include "junction.hpp"
#include "trammel/driver/trigonometry.hpp"

namespace trammel::planner {
namespace {

constexpr double kFullTurn = 2 * driver::kPi;
constexpr double kMinShare = 1e-9;  // a smaller share of a motion is dropped
constexpr double kInPlane = 1e-12;  // a component of a unit vector up to this counts as 0
constexpr double kInvisiblePulses = 0.25;
constexpr double kMinRadius = 3;     // pulses: rounding of the ends distorts smaller arcs
constexpr double kSameAngle = 1e-6;  // radians: more than the error of an arc's ends

double length_of(double x, double y) { return std::sqrt(x * x + y * y); }
double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double feed_of(const gcode::Motion& motion, double length) {
  return motion.seconds > 0 ? length / motion.seconds : motion.feed;
}

}  // namespace

Blender::Blender(gcode::Reader& reader, const machine::Machine& machine, const gcode::Coordinates& start)
    : reader_(reader),
      axes_(machine.axes.size()),
      junction_deviation_(machine.motion.junction_deviation),
      time_(std::make_unique<CornerTime>(machine)),
      here_(start) {
  const kinematics::Kinematics kinematics(machine);
  for (std::size_t letter = 0; letter < space_.size(); ++letter) {
    const auto axis = machine.axis(static_cast<char>('X' + letter));
    if (!axis) continue;
    space_[letter] = *axis;
    finest_ = std::max(finest_, kinematics.finest(*axis));
  }
}

Blender::~Blender() = default;

bool Blender::next(PathMotion& motion) {
  while (given_first_ == given_count_) {
    given_first_ = given_count_ = 0;
    Way& from = ways_[first_];
    if (!held_) {
      held_ = pull(from);
      if (!held_) return false;
    }
    Way& to = ways_[1 - first_];
    held_ = pull(to);
    std::size_t outputs = 0;
    for (; held_ && to.motion.kind == gcode::MotionKind::kOutput && outputs < kMaxOutputs; held_ = pull(to)) {
      outputs_[outputs++] = to.motion;
    }
    PathMotion made;
    if (held_) {
      const Corner corner = blend(from, to, made);
      if (corner != Corner::kBlended) from.motion.corner = corner;
    }
    first_ = 1 - first_;
    if (from.taken_before + from.taken_behind < 1 - kMinShare) {
      trim(from);
      given_[given_count_++] = from.motion;
    }
    for (std::size_t i = 0; i < outputs; ++i) {
      PathMotion& output = given_[given_count_++] = outputs_[i];
      if (from.taken_behind > 0) output.target = output.programmed = point(from, 1 - from.taken_behind);
    }
    if (made.corner == Corner::kBlended) given_[given_count_++] = made;
  }
  motion = given_[given_first_++];
  return true;
}

// Gets the next motion; skips lines and traverses of length 0.
bool Blender::pull(Way& way) {
  gcode::Motion& motion = way.motion;
  while (reader_.next(motion)) {
    const bool path = motion.kind == gcode::MotionKind::kTraverse || motion.kind == gcode::MotionKind::kLine ||
                      motion.kind == gcode::MotionKind::kArc;
    const bool still = path && motion.kind != gcode::MotionKind::kArc && motion.target == here_;
    if (still) continue;
    way.start = here_;
    way.motion.programmed = here_ = motion.target;
    way.motion.rapid = motion.kind == gcode::MotionKind::kTraverse;
    way.motion.tilted = false;
    way.motion.distance = 0;
    way.motion.corner = Corner::kNone;
    way.length = way.taken_before = way.taken_behind = 0;
    if (path && motion.tolerance > 0 && !keep_corners_) measure(way);
    return true;
  }
  return false;
}

void Blender::measure(Way& way) const {
  if (way.motion.kind == gcode::MotionKind::kArc) return measure_arc(way);
  double squares = 0;
  for (std::size_t letter = 0; letter < space_.size(); ++letter) {
    const double part = at(way.motion.target, letter) - at(way.start, letter);
    squares += part * part;
  }
  way.length = std::sqrt(squares);
}

void Blender::measure_arc(Way& way) const {
  const gcode::Motion& motion = way.motion;
  const double start_x = way.start[motion.axis_x] - motion.centre_x;
  const double start_y = way.start[motion.axis_y] - motion.centre_y;
  const double end_x = motion.target[motion.axis_x] - motion.centre_x;
  const double end_y = motion.target[motion.axis_y] - motion.centre_y;
  way.radius_start = length_of(start_x, start_y);
  way.radius_end = length_of(end_x, end_y);
  way.angle_start = driver::arc_tangent(start_y, start_x);
  way.sweep = kFullTurn;
  if (!motion.full_circle) {
    way.sweep = (driver::arc_tangent(end_y, end_x) - way.angle_start) * (motion.clockwise ? -1 : 1);
    way.sweep += way.sweep <= 0 ? kFullTurn : 0;
  }
  way.sweep += kFullTurn * motion.turns;
  way.length = std::max(way.radius_start, way.radius_end) * way.sweep;
  way.flat = true;
  for (const std::size_t axis : space_) {
    const bool of_plane = axis == motion.axis_x || axis == motion.axis_y;
    if (axis != kNone && !of_plane && motion.target[axis] != way.start[axis]) way.flat = false;
  }
}

// The point after a share of the motion.
gcode::Coordinates Blender::point(const Way& way, double share) {
  gcode::Coordinates found = way.motion.programmed;
  for (std::size_t axis = 0; axis < found.size(); ++axis) {
    const double length = found[axis] - way.start[axis];
    if (length != 0) found[axis] = share < 0.5 ? way.start[axis] + length * share : found[axis] - length * (1 - share);
  }
  if (way.motion.kind != gcode::MotionKind::kArc) return found;
  const double turned = (way.motion.clockwise ? -way.sweep : way.sweep) * share;
  const double radius = way.radius_start + (way.radius_end - way.radius_start) * share;
  const driver::SineCosine to = driver::sine_cosine(way.angle_start + turned);
  found[way.motion.axis_x] = way.motion.centre_x + radius * to.cosine;
  found[way.motion.axis_y] = way.motion.centre_y + radius * to.sine;
  return found;
}

// Shortens the motion to the part that the blends leave.
void Blender::trim(Way& way) {
  const double taken = way.taken_before + way.taken_behind;
  if (taken == 0) return;
  PathMotion& motion = way.motion;
  motion.seconds *= 1 - taken;
  if (way.taken_behind > 0) motion.target = point(way, 1 - way.taken_behind);
  if (motion.kind != gcode::MotionKind::kArc) return;
  motion.full_circle = false;
  motion.turns = static_cast<std::uint32_t>(std::ceil(way.sweep * (1 - taken) / kFullTurn)) - 1;
}

// Whether the motion may lose this share. The sweep that an arc has left must not be close to a whole number of turns,
// because its ends could not tell a full turn from none.
bool Blender::can_lose(const Way& way, double share) {
  if (way.motion.kind != gcode::MotionKind::kArc || share >= 1 - kMinShare) return true;
  const double turns = way.sweep * (1 - share) / kFullTurn;
  return std::abs(turns - std::floor(turns + 0.5)) * kFullTurn > kSameAngle;
}

Blender::Vector Blender::direction(const Way& way, bool at_end) const {
  Vector found{};
  if (way.motion.kind != gcode::MotionKind::kArc) {
    for (std::size_t letter = 0; letter < found.size(); ++letter) {
      found[letter] = (at(way.motion.programmed, letter) - at(way.start, letter)) / way.length;
    }
    return found;
  }
  const gcode::Coordinates& place = at_end ? way.motion.programmed : way.start;
  const double radius = at_end ? way.radius_end : way.radius_start;
  const double turn = way.motion.clockwise ? -1 : 1;
  for (std::size_t letter = 0; letter < found.size(); ++letter) {
    if (space_[letter] == way.motion.axis_x) {
      found[letter] = -turn * (place[way.motion.axis_y] - way.motion.centre_y) / radius;
    } else if (space_[letter] == way.motion.axis_y) {
      found[letter] = turn * (place[way.motion.axis_x] - way.motion.centre_x) / radius;
    }
  }
  return found;
}

// Positive to the left, in the frame.
double Blender::curvature(const Way& way, bool at_end) {
  if (way.motion.kind != gcode::MotionKind::kArc) return 0;
  return (way.motion.clockwise ? -1 : 1) / (at_end ? way.radius_end : way.radius_start);
}

// The difference of an arc's radii, which a rounded centre causes.
double Blender::slack(const Way& way) {
  return way.motion.kind == gcode::MotionKind::kArc ? std::abs(way.radius_end - way.radius_start) : 0;
}

// Finds the main plane that contains both motions, or the plane through two lines.
bool Blender::find_frame(const Way& from, const Way& to, const Turn& turn, Frame& frame) const {
  // X Y, Z X, Y Z in the order of Motion::axis_x and axis_y, each with its normal.
  constexpr std::size_t kPlanes[3][3] = {{0, 1, 2}, {2, 0, 1}, {1, 2, 0}};
  const bool lines = from.motion.kind != gcode::MotionKind::kArc && to.motion.kind != gcode::MotionKind::kArc;
  const auto lies_in = [&](const Way& way, const std::size_t* plane) {
    if (way.motion.kind != gcode::MotionKind::kArc) return true;
    return way.flat && space_[plane[0]] == way.motion.axis_x && space_[plane[1]] == way.motion.axis_y;
  };
  for (const auto& plane : kPlanes) {
    const std::size_t normal = plane[2];
    if (std::abs(turn.from[normal]) > kInPlane || std::abs(turn.to[normal]) > kInPlane) continue;
    if (!lies_in(from, plane) || !lies_in(to, plane)) continue;
    frame.first = frame.second = Vector{};
    frame.first[plane[0]] = frame.second[plane[1]] = 1;
    frame.letters = {plane[0], plane[1]};
    frame.main = true;
    return true;
  }
  if (!lines) return false;
  const double along = dot(turn.from, turn.to);
  frame.first = turn.from;
  for (std::size_t i = 0; i < 3; ++i) frame.second[i] = turn.to[i] - along * turn.from[i];
  const double size = std::sqrt(dot(frame.second, frame.second));
  for (double& part : frame.second) part /= size;
  frame.main = false;
  return true;
}

CornerSide Blender::corner_side(const Way& way, const Vector& going, bool at_end) const {
  CornerSide side;
  for (std::size_t axis = 0; axis < axes_; ++axis) {
    side.direction[axis] = (way.motion.programmed[axis] - way.start[axis]) / way.length;
  }
  for (std::size_t letter = 0; letter < going.size(); ++letter) {
    if (space_[letter] != kNone) side.direction[space_[letter]] = going[letter];
  }
  side.length = way.length;
  if (way.motion.kind == gcode::MotionKind::kArc) side.curvature = 1 / (at_end ? way.radius_end : way.radius_start);
  side.speed = way.motion.rapid ? std::numeric_limits<double>::infinity() : feed_of(way.motion, way.length);
  return side;
}

Corner Blender::blend(Way& from, Way& to, PathMotion& made) const {
  if (from.length == 0 || to.length == 0) return Corner::kNone;
  Turn turn{direction(from, true), direction(to, false), 0};
  Vector change{};
  for (std::size_t i = 0; i < 3; ++i) change[i] = turn.to[i] - turn.from[i];
  turn.sine = std::sqrt(dot(change, change)) / 2;
  if (4 * turn.sine * turn.sine <= Junctions::kTangentSquare) return Corner::kNone;
  if (1 - 2 * turn.sine * turn.sine < Junctions::kReversal) return Corner::kReversal;
  Frame frame;
  if (!find_frame(from, to, turn, frame)) return Corner::kNoCurve;
  const auto side = [&](const Way& way, const Vector& going, bool at_end) {
    const double bend = curvature(way, at_end);
    const double most = bend == 0 ? way.length / 2 : way.sweep / 2 / std::abs(bend);
    return Side{dot(going, frame.first), dot(going, frame.second), bend, most};
  };
  const double tolerance = std::min(from.motion.tolerance, to.motion.tolerance) - slack(from) - slack(to);
  if (!(tolerance > 0)) return Corner::kNoCurve;
  const std::optional<Fillet> curve =
      fillet(side(from, turn.from, true), side(to, turn.to, false), turn.sine, tolerance);
  if (!curve) return Corner::kNoCurve;
  const bool same_path = curve->distance * finest_ < kInvisiblePulses && curve->distance <= junction_deviation_;
  if (same_path || curve->radius * finest_ < kMinRadius) return Corner::kInvisible;
  if (time_->is_less_without(*curve, corner_side(from, turn.from, true), corner_side(to, turn.to, false), turn.sine)) {
    return Corner::kFaster;
  }
  const auto share = [](const Way& way, double taken, bool at_end) {
    if (way.motion.kind != gcode::MotionKind::kArc) return taken / way.length;
    return taken / (at_end ? way.radius_end : way.radius_start) / way.sweep;
  };
  const double behind = share(from, curve->before, true);
  const double before = share(to, curve->behind, false);
  if (!can_lose(from, from.taken_before + behind) || !can_lose(to, before)) return Corner::kNoCurve;
  from.taken_behind = behind;
  to.taken_before = before;
  made.distance = curve->distance + slack(from) + slack(to);
  make(from, to, frame, turn, *curve, made);
  return Corner::kBlended;
}

void Blender::make(const Way& from, const Way& to, const Frame& frame, const Turn& turn, const Fillet& curve,
                   PathMotion& made) const {
  made.kind = gcode::MotionKind::kArc;
  made.line = from.motion.line;
  made.later = static_cast<std::uint8_t>(from.motion.later | to.motion.later);
  made.path_control = from.motion.path_control;
  made.corner = Corner::kBlended;
  made.rapid = from.motion.rapid && to.motion.rapid;
  made.power = std::min(from.motion.power, to.motion.power);
  made.power_follows = from.motion.power_follows;
  if (!made.rapid) {
    const double before = feed_of(from.motion, from.length);
    const double behind = feed_of(to.motion, to.length);
    made.feed = from.motion.rapid ? behind : to.motion.rapid ? before : std::min(before, behind);
  }
  made.target = made.programmed = point(to, to.taken_before);
  Vector centre{};
  for (std::size_t i = 0; i < 3; ++i) {
    centre[i] = at(from.motion.programmed, i) + curve.centre_x * frame.first[i] + curve.centre_y * frame.second[i];
  }
  made.clockwise = curve.clockwise;
  made.full_circle = false;
  made.tilted = !frame.main;
  if (frame.main) {
    made.axis_x = static_cast<std::uint8_t>(space_[frame.letters[0]]);
    made.axis_y = static_cast<std::uint8_t>(space_[frame.letters[1]]);
    made.centre_x = centre[frame.letters[0]];
    made.centre_y = centre[frame.letters[1]];
    return;
  }
  // The path turns left in this frame: the second vector points to the inside of the turn.
  for (std::size_t i = 0; i < 3; ++i) {
    made.space.axes[i] = static_cast<std::uint8_t>(space_[i]);
    made.space.first[i] = -frame.second[i];
    made.space.second[i] = turn.from[i];
  }
  made.space.centre = centre;
  made.space.radius = curve.radius;
  made.space.sweep = curve.sweep;
}

}  // namespace trammel::planner
