#include "trammel/planner/block_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "axis_limits.hpp"
#include "detours.hpp"
#include "trammel/driver/card_timing.hpp"

namespace trammel::planner {
namespace {

constexpr double kShaperShare = 0.95;  // share of the shaper's fastest rate without a pause
// One pulse less than the counters hold, as room for rounding.
constexpr double kMaxPulses = static_cast<double>(std::numeric_limits<std::int32_t>::max() - 1);
constexpr double kMaxDwellTotal = 0x1p48;  // clocks per G4
constexpr double kSoftLimitSlack = 1e-6;   // mm; far below a pulse, far above the rounding of sums
constexpr double kMinWay = 2;              // pulses: a shorter path of X, Y and Z may have no step
constexpr double kSameSpeed = 1 - 1e-6;    // share of the feed from which on it counts as reached

constexpr std::array<std::string_view, 4> kFeedGroups = {"XYZ", "UVW", "ABC", "E"};

unsigned feed_group(char letter) {
  const auto holds = [letter](std::string_view letters) { return letters.find(letter) != std::string_view::npos; };
  return static_cast<unsigned>(std::find_if(kFeedGroups.begin(), kFeedGroups.end(), holds) - kFeedGroups.begin());
}

}  // namespace

BlockBuilder::BlockBuilder(gcode::Reader& reader, const machine::Machine& machine, const CardLimits& card,
                           const gcode::Coordinates& start)
    : reader_(reader),
      machine_(machine),
      card_(card),
      axis_count_(machine.axes.size()),
      kinematics_(machine),
      blender_(reader, machine, start),
      exact_(start),
      anchor_(start),
      detours_(std::make_unique<Detours>(machine)) {
  for (std::size_t i = 0; i < axis_count_; ++i) {
    const machine::MachineAxis& from = machine.axes[i];
    Axis& axis = axes_[i];
    const AxisLimits limits = limits_of(from, machine.motion);
    axis.velocity = limits.velocity;
    axis.acceleration = limits.acceleration;
    axis.jerk = limits.jerk;
    axis.lowest = from.min;
    axis.highest = from.max;
    axis.feed_group = feed_group(from.letter);
    axis.linear = axis.feed_group == 0;
  }
  for (std::size_t i = 0; i < joint_count(); ++i) {
    const kinematics::Joint& joint = kinematics_.joint(i);
    const driver::AxisSettings settings = settings_of(machine.axes[joint.settings]);
    const auto clocks = [&](std::chrono::nanoseconds time, const char* what) {
      return driver::step_time_clocks(time, card.clock_hz, what);
    };
    const double period = driver::shortest_pulse_period(clocks(settings.step_length, "step length"),
                                                        clocks(settings.step_space, "step space"));
    const double shaper = kShaperShare * card.clock_hz / period;
    const AxisLimits limits = limits_of(joint.limits, machine.motion);
    joints_[i] = {shaper / machine.motion.max_override, limits.velocity, limits.acceleration, limits.jerk};
  }
  start_ = here_ = kinematics_.pulses(start);
}

BlockBuilder::~BlockBuilder() = default;

const gcode::Motion& BlockBuilder::begin_probe() {
  probe_ = Probe::kBegun;
  return motion_;
}

void BlockBuilder::resume_at(const Pulses& here) {
  here_ = here;
  exact_ = kinematics_.coordinates(here);
  anchor_ = exact_;
  blender_.resume_at(exact_);
  probe_ = Probe::kNone;
}

bool BlockBuilder::next_probe(Block& block) {
  if (probe_ != Probe::kBegun) return false;
  probe_ = Probe::kPlanned;
  if (!build(block)) return false;
  block.outputs = std::exchange(outputs_, {});
  return true;
}

bool BlockBuilder::next(Block& block) {
  if (error_) return false;
  if (probe_ != Probe::kNone) return next_probe(block);
  while (blender_.next(motion_)) {
    if (motion_.kind == gcode::MotionKind::kProbe) {
      probe_ = Probe::kReached;
      if (card_.outputs == 0) refuse(gcode::ErrorCode::kNoProbe, "a probe: the card has no path commands");
      return false;
    }
    const bool any = build(block);
    if (error_) return false;
    follow_detour(block, any);
    exact_ = motion_.target;
    here_ = block.end;
    if (moves(block) && any) anchor_ = exact_;
    if (!any) continue;
    block.outputs = std::exchange(outputs_, {});
    return true;
  }
  error_ = reader_.error();
  return false;
}

// False if there is no step, or after an error.
bool BlockBuilder::build(Block& block) {
  block.line = motion_.line;
  block.start = here_;
  block.end = here_;
  block.corner = motion_.corner;
  block.distance = motion_.distance;
  block.power = motion_.power;
  block.power_follows = motion_.power_follows;
  switch (motion_.kind) {
    case gcode::MotionKind::kDwell:
      return build_dwell(block);
    case gcode::MotionKind::kOutput:
      switch_outputs();
      return false;
    case gcode::MotionKind::kEnd:
      block.geometry = Geometry::kEnd;
      return true;
    case gcode::MotionKind::kArc:
      return set_targets(block) && build_arc(block);
    default:
      return set_targets(block) && build_line(block);
  }
}

bool BlockBuilder::refuse(gcode::ErrorCode code, std::string message) {
  error_ = gcode::Error{code, reader_.file(), motion_.line, std::move(message)};
  return false;
}

// Checks a coordinate that an axis reaches: an end point, or an extreme of an arc. If a probe decides the coordinate,
// its soft limits are checked when it is known.
bool BlockBuilder::check(std::size_t axis, double mm) {
  const Axis& limits = axes_[axis];
  const char letter = machine_.axes[axis].letter;
  if (jerk_required_ && limits.jerk == kNoLimit) {
    return refuse(gcode::ErrorCode::kNoJerk,
                  fmt::format("axis {} moves and has no max_jerk in the machine file, which S-curves need", letter));
  }
  // If two axes move a joint, each may use half of the joint's counter.
  const auto share = static_cast<double>(kinematics_.max_terms(axis));
  if (!(std::abs(mm * kinematics_.finest(axis)) * share <= kMaxPulses)) {
    return refuse(gcode::ErrorCode::kPositionRange,
                  fmt::format("{}{:.10g} is beyond the card's 32-bit position counter ({:.10g} steps/mm)", letter, mm,
                              kinematics_.finest(axis)));
  }
  const bool later = (unsigned{motion_.later} >> axis & 1U) != 0;
  if (!later && (mm < limits.lowest - kSoftLimitSlack || mm > limits.highest + kSoftLimitSlack)) {
    const bool low = mm < limits.lowest;
    return refuse(gcode::ErrorCode::kSoftLimit,
                  fmt::format("{}{:.10g} is beyond the axis's {} of {:.10g} (machine coordinates)", letter, mm,
                              low ? "min" : "max", low ? limits.lowest : limits.highest));
  }
  return true;
}

bool BlockBuilder::set_targets(Block& block) {
  unsigned moved = 0;  // bit n: axis n
  for (std::size_t axis = 0; axis < axis_count_; ++axis) {
    const double mm = motion_.target[axis];
    const double programmed = motion_.programmed[axis];
    if (programmed != mm && !check(axis, programmed)) return false;
    if (mm == exact_[axis]) continue;
    if (!check(axis, mm)) return false;
    moved |= 1U << axis;
  }
  for (std::size_t joint = 0; joint < joint_count(); ++joint) {
    if ((kinematics_.axes_of(joint) & moved) != 0) block.end[joint] = kinematics_.pulses(joint, motion_.target);
  }
  return true;
}

// An output that the card cannot switch is always off, so switching it off is not an error.
void BlockBuilder::switch_outputs() {
  unsigned output = 0;
  for (; output < card_.outputs || motion_.set >> output != 0; ++output) {
    if (output < card_.outputs || (unsigned{motion_.set} >> output & 1U) == 0) continue;
    refuse(gcode::ErrorCode::kNoOutput,
           card_.outputs == 0
               ? fmt::format("output {} of the machine file cannot be switched: the card has no path commands", output)
               : fmt::format("output {} of the machine file: the card has {}", output, card_.outputs));
    return;
  }
  outputs_.set = static_cast<std::uint16_t>((outputs_.set & ~motion_.clear) | motion_.set);
  outputs_.clear = static_cast<std::uint16_t>((outputs_.clear & ~motion_.set) | motion_.clear);
  if (card_.outputs == 0) outputs_ = {};
}

bool BlockBuilder::build_dwell(Block& block) {
  const double clocks = motion_.seconds * card_.clock_hz;
  if (!(clocks <= kMaxDwellTotal)) {
    return refuse(gcode::ErrorCode::kDwellTooLong, fmt::format("a dwell of {:.10g} s is too long", motion_.seconds));
  }
  block.geometry = Geometry::kDwell;
  block.dwell_clocks = static_cast<std::uint64_t>(std::llround(clocks));
  block.dwell_seconds = motion_.seconds;
  block.awaits_spindle = motion_.awaits_spindle;
  return true;
}

// A line with steps is measured from the end of the last block, others from the end of the last motion.
bool BlockBuilder::build_line(Block& block) {
  const bool steps = block.end != block.start;
  if (!steps && motion_.target == exact_) return false;
  const gcode::Coordinates& from = steps ? anchor_ : exact_;
  gcode::Coordinates way{};
  for (std::size_t i = 0; i < axis_count_; ++i) way[i] = motion_.target[i] - from[i];
  block.geometry = Geometry::kLine;
  block.curvature = 0;
  block.curve = {};
  const double feed_length = measure_line(block, way);
  for (std::size_t i = 0; i < axis_count_; ++i) block.entry[i] = way[i] / block.length;
  block.exit = block.entry;
  // A joint that two axes move may make more pulses than either axis alone would cause.
  for (std::size_t i = 0; i < joint_count(); ++i) {
    if (kinematics_.joint(i).term_count == 1) continue;
    block.pulses_per_mm = std::max(block.pulses_per_mm, std::abs(kinematics_.pulse_rate(i, block.entry)));
  }
  limit_line(block);
  limit_joints(block);
  limit_pulses(block);
  apply_feed(block, feed_length);
  return steps;
}

// The heading of the motion as programmed, from the end of the motion before.
Heading BlockBuilder::heading_of(const Block& block) const {
  if (block.geometry != Geometry::kLine) return {block.entry, block.length, block.speed, block.linear};
  gcode::Coordinates way{};
  for (std::size_t i = 0; i < axis_count_; ++i) way[i] = motion_.target[i] - exact_[i];
  Block alone;
  measure_line(alone, way);
  Heading heading{{}, alone.length, block.speed, alone.linear};
  for (std::size_t i = 0; i < axis_count_; ++i) heading.entry[i] = way[i] / alone.length;
  return heading;
}

// Call before exact_ advances. An arc without a pulse has no known heading: its corners count as a stop.
void BlockBuilder::follow_detour(Block& block, bool any) {
  if (motion_.kind == gcode::MotionKind::kOutput) return;
  if (any) {
    block.detour.speed = 0;
    if (!detours_->open()) return;
    if (moves(block)) block.detour = detours_->to(heading_of(block));
    detours_->close();
  } else if (motion_.kind == gcode::MotionKind::kArc) {
    detours_->stop();
  } else if (motion_.target != exact_) {
    detours_->pass(block);
  }
}

// Sets length and scale; returns the length that F counts.
double BlockBuilder::measure_line(Block& block, const gcode::Coordinates& way) const {
  double squares = 0;
  std::array<double, kFeedGroups.size() + 1> feed_squares{};
  double scale = 0;
  double finest = 0;        // of all axes that move
  double other_pulses = 0;  // the most of one axis that the length does not count
  for (std::size_t i = 0; i < axis_count_; ++i) {
    const Axis& axis = axes_[i];
    if (way[i] == 0) continue;
    const double square = way[i] * way[i];
    squares += square;
    feed_squares[axis.feed_group] += square;
    finest = std::max(finest, kinematics_.finest(i));
    if (axis.linear) scale = std::max(scale, kinematics_.finest(i));
    if (!axis.linear) other_pulses = std::max(other_pulses, std::abs(way[i]) * kinematics_.finest(i));
  }
  block.linear = feed_squares[0] > 0;
  block.length = std::sqrt(block.linear ? feed_squares[0] : squares);
  block.pulses_per_mm = finest;
  if (block.linear) {
    if (block.length * scale < kMinWay) block.length = std::max(block.length, other_pulses / scale);
    block.pulses_per_mm = std::max(scale, other_pulses / block.length);
  }
  const auto counts = std::find_if(feed_squares.begin(), feed_squares.end(), [](double sum) { return sum > 0; });
  return std::sqrt(*counts);
}

void BlockBuilder::limit_speed(Block& block, double speed, SpeedLimit limit) {
  if (speed >= block.speed) return;
  block.speed = speed;
  block.limit = limit;
}

// Applies the limits of the axes on a straight path.
void BlockBuilder::limit_line(Block& block) const {
  block.speed = kNoLimit;
  block.acceleration = kNoLimit;
  block.jerk = kNoLimit;
  for (std::size_t i = 0; i < axis_count_; ++i) {
    const double share = std::abs(block.entry[i]);
    if (share == 0) continue;
    limit_speed(block, axes_[i].velocity / share, SpeedLimit::kAxisVelocity);
    block.acceleration = std::min(block.acceleration, axes_[i].acceleration / share);
    block.jerk = std::min(block.jerk, axes_[i].jerk / share);
  }
}

// Applies the joints' own limits on a straight path.
void BlockBuilder::limit_joints(Block& block) const {
  if (!kinematics_.has_joint_limits()) return;
  for (std::size_t i = 0; i < joint_count(); ++i) {
    const double share = std::abs(kinematics_.joint_rate(i, block.entry));
    if (share == 0) continue;
    limit_speed(block, joints_[i].velocity / share, SpeedLimit::kAxisVelocity);
    block.acceleration = std::min(block.acceleration, joints_[i].acceleration / share);
    block.jerk = std::min(block.jerk, joints_[i].jerk / share);
  }
}

// Rounding adds up to one pulse. It is not counted: it may come a little late.
void BlockBuilder::limit_pulses(Block& block) const {
  std::int64_t most = 0;
  for (std::size_t i = 0; i < joint_count(); ++i) {
    const std::int64_t pulses = std::abs(block.end[i] - block.start[i]);
    most = std::max(most, pulses);
    if (pulses < 2) continue;
    limit_speed(block, joints_[i].pulses * block.length / static_cast<double>(pulses - 1), SpeedLimit::kPulseShape);
  }
  block.least_ticks = static_cast<std::uint64_t>(most);  // at most one pulse per tick
}

// Applies the program's feed to the limits so far.
void BlockBuilder::apply_feed(Block& block, double feed_length) const {
  const SpeedLimit limit = block.limit;
  block.limit = SpeedLimit::kNone;
  block.wanted = 0;
  block.rapid = motion_.rapid;
  block.path_control = motion_.path_control;
  if (block.rapid) return;
  const double seconds = motion_.seconds > 0 ? motion_.seconds : feed_length / motion_.feed;
  block.wanted = block.length / seconds;
  block.feed = feed_length / seconds;
  if (block.speed < block.wanted * kSameSpeed) block.limit = limit;
  block.speed = std::min(block.speed, block.wanted);
}

}  // namespace trammel::planner
