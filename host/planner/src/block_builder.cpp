#include "trammel/planner/block_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "trammel/driver/card_timing.hpp"

namespace trammel::planner {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr double kShaperShare = 0.95;  // of the rate at which the shaper makes pulses without a pause
// One pulse less than the counters hold, for the rounding.
constexpr double kMostPulses = static_cast<double>(std::numeric_limits<std::int32_t>::max() - 1);
constexpr double kMaxDwellTotal = 0x1p48;  // clocks of one G4
constexpr double kSoftLimitSlack = 1e-6;   // mm; far below a pulse, far above the rounding of sums
constexpr double kSameSpeed = 1 - 1e-6;    // a feed is reached from this share on

constexpr std::array<std::string_view, 4> kFeedGroups = {"XYZ", "UVW", "ABC", "E"};

unsigned feed_group(char letter) {
  const auto holds = [letter](std::string_view letters) { return letters.find(letter) != std::string_view::npos; };
  return static_cast<unsigned>(std::find_if(kFeedGroups.begin(), kFeedGroups.end(), holds) - kFeedGroups.begin());
}

}  // namespace

std::int64_t to_pulses(double mm, double steps_per_mm) {
  const double pulses = mm * steps_per_mm;
  const double away = 0.5 + 1e-9 + 1e-15 * std::abs(pulses);
  return static_cast<std::int64_t>(pulses < 0 ? pulses - away : pulses + away);
}

BlockBuilder::BlockBuilder(gcode::Reader& reader, const machine::Machine& machine, const CardLimits& card,
                           const gcode::Coordinates& start)
    : reader_(reader), machine_(machine), card_(card), axis_count_(machine.axes.size()), exact_(start) {
  for (std::size_t i = 0; i < axis_count_; ++i) {
    const machine::MachineAxis& from = machine.axes[i];
    const driver::AxisSettings settings = settings_of(from);
    const auto clocks = [&](std::chrono::nanoseconds time, const char* what) {
      return driver::step_time_clocks(time, card.clock_hz, what);
    };
    const double period = driver::shortest_pulse_period(clocks(settings.step_length, "step length"),
                                                        clocks(settings.step_space, "step space"));
    const double shaper = kShaperShare * card.clock_hz / period;
    Axis& axis = axes_[i];
    axis.steps_per_mm = from.steps_per_mm;
    axis.velocity = std::min(from.max_velocity * from.steps_per_mm, shaper);
    axis.acceleration = from.max_acceleration * from.steps_per_mm;
    axis.jerk = from.max_jerk > 0 ? from.max_jerk * from.steps_per_mm : kNoLimit;
    axis.lowest = from.min;
    axis.highest = from.max;
    axis.limit = axis.velocity < shaper ? SpeedLimit::kAxisVelocity : SpeedLimit::kPulseShape;
    axis.feed_group = feed_group(from.letter);
    start_[i] = to_pulses(start[i], from.steps_per_mm);
  }
  here_ = start_;
}

bool BlockBuilder::next(Block& block) {
  if (error_) return false;
  while (reader_.next(motion_)) {
    const bool any = build(block);
    if (error_) return false;
    exact_ = motion_.target;
    here_ = block.end;
    if (any) return true;
  }
  error_ = reader_.error();
  return false;
}

// False: nothing to step, or an error.
bool BlockBuilder::build(Block& block) {
  block.line = motion_.line;
  block.start = here_;
  block.end = here_;
  switch (motion_.kind) {
    case gcode::MotionKind::kDwell:
      return build_dwell(block);
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

bool BlockBuilder::check(std::size_t axis, double mm) {
  const Axis& limits = axes_[axis];
  const char letter = machine_.axes[axis].letter;
  if (!(std::abs(mm * limits.steps_per_mm) <= kMostPulses)) {
    return refuse(gcode::ErrorCode::kPositionRange,
                  fmt::format("{}{:.10g} is beyond the card's 32-bit position counter ({:.10g} steps/mm)", letter, mm,
                              limits.steps_per_mm));
  }
  if (mm < limits.lowest - kSoftLimitSlack || mm > limits.highest + kSoftLimitSlack) {
    const bool low = mm < limits.lowest;
    return refuse(gcode::ErrorCode::kSoftLimit,
                  fmt::format("{}{:.10g} is beyond the axis's {} of {:.10g} (machine coordinates)", letter, mm,
                              low ? "min" : "max", low ? limits.lowest : limits.highest));
  }
  return true;
}

bool BlockBuilder::set_targets(Block& block) {
  for (std::size_t axis = 0; axis < axis_count_; ++axis) {
    const double mm = motion_.target[axis];
    if (mm == exact_[axis]) continue;
    if (!check(axis, mm)) return false;
    block.end[axis] = to_pulses(mm, axes_[axis].steps_per_mm);
  }
  return true;
}

bool BlockBuilder::build_dwell(Block& block) {
  const double clocks = motion_.seconds * card_.clock_hz;
  if (!(clocks <= kMaxDwellTotal)) {
    return refuse(gcode::ErrorCode::kDwellTooLong, fmt::format("a dwell of {:.10g} s is too long", motion_.seconds));
  }
  block.geometry = Geometry::kDwell;
  block.dwell_clocks = static_cast<std::uint64_t>(std::llround(clocks));
  block.dwell_seconds = motion_.seconds;
  return true;
}

bool BlockBuilder::build_line(Block& block) {
  double squares = 0;
  std::array<double, kFeedGroups.size() + 1> feed_squares{};
  double scale = 0;
  std::int64_t most = 0;
  double velocity = kNoLimit;      // paths a second
  double acceleration = kNoLimit;  // paths a second^2
  double jerk = kNoLimit;          // paths a second^3
  SpeedLimit limit = SpeedLimit::kAxisVelocity;
  for (std::size_t i = 0; i < axis_count_; ++i) {
    const std::int64_t whole = std::abs(block.end[i] - block.start[i]);
    if (whole == 0) continue;
    const Axis& axis = axes_[i];
    const double pulses = static_cast<double>(whole);
    const double mm = pulses / axis.steps_per_mm;
    squares += mm * mm;
    feed_squares[axis.feed_group] += mm * mm;
    scale = std::max(scale, axis.steps_per_mm);
    most = std::max(most, whole);
    const double share = axis.velocity / pulses;
    if (share < velocity) {
      velocity = share;
      limit = axis.limit;
    }
    acceleration = std::min(acceleration, axis.acceleration / pulses);
    jerk = std::min(jerk, axis.jerk / pulses);
  }
  if (most == 0) return false;
  block.geometry = Geometry::kLine;
  block.length = std::sqrt(squares);
  block.pulses = block.length * scale;
  block.least_ticks = static_cast<std::uint64_t>(most);  // at most one pulse a tick
  block.acceleration = acceleration * block.pulses;
  block.jerk = jerk * block.pulses;
  block.speed = velocity * block.pulses;
  block.limit = limit;
  const auto counts = std::find_if(feed_squares.begin(), feed_squares.end(), [](double sum) { return sum > 0; });
  apply_feed(block, std::sqrt(*counts));
  return true;
}

// What the program asks for, against the limits so far.
void BlockBuilder::apply_feed(Block& block, double feed_length) {
  const SpeedLimit limit = block.limit;
  block.limit = SpeedLimit::kNone;
  block.wanted = 0;
  if (motion_.kind == gcode::MotionKind::kTraverse) return;
  const double seconds = motion_.seconds > 0 ? motion_.seconds : feed_length / motion_.feed;
  block.wanted = block.pulses / seconds;
  block.feed = feed_length / seconds;
  if (block.speed < block.wanted * kSameSpeed) block.limit = limit;
  block.speed = std::min(block.speed, block.wanted);
}

}  // namespace trammel::planner
