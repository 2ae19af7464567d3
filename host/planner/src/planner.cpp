#include "trammel/planner/planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "planner_paths.hpp"

namespace trammel::planner {
namespace {

constexpr std::uint64_t kMaxDwell = (std::uint64_t{1} << 40) - 1;  // clocks of one command
constexpr double kMaxDwellTotal = 0x1p48;                          // clocks of one G4
constexpr double kMaxRadius = 0x1p44;                              // pulses; the centre in 1/256 pulses fits 64 bits

Pulses rounded(const machine::Machine& machine, const gcode::Coordinates& position) {
  Pulses pulses{};
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    pulses[axis] = to_pulses(position[axis], machine.axes[axis].steps_per_mm);
  }
  return pulses;
}

bool in_range(double mm, double steps_per_mm) {
  // One pulse less than the counters hold, for the rounding.
  return std::abs(mm * steps_per_mm) <= static_cast<double>(std::numeric_limits<std::int32_t>::max() - 1);
}

void plan_dwell(double seconds, std::uint32_t clock_hz, PlannedSegment& segment) {
  auto clocks = static_cast<std::uint64_t>(std::llround(seconds * clock_hz));
  segment.seconds = seconds;
  do {
    const std::uint64_t part = std::min(clocks, kMaxDwell);
    segment.commands.emplace_back(driver::DwellCommand{part});
    clocks -= part;
  } while (clocks != 0);
}

}  // namespace

Planner::Planner(const gcode::Program& program, const machine::Machine& machine, std::uint32_t clock_hz)
    : program_(program),
      machine_(machine),
      clock_hz_(clock_hz),
      start_(rounded(machine, program.start)),
      here_(start_),
      exact_(program.start) {
  gcode::Coordinates from = program.start;
  for (const gcode::Motion& motion : program.motions) {
    check(motion, from);
    from = motion.target;
  }
}

void Planner::check(const gcode::Motion& motion, const gcode::Coordinates& from) const {
  if (motion.kind == gcode::MotionKind::kDwell && motion.seconds * clock_hz_ > kMaxDwellTotal) {
    throw gcode::ProgramError(program_.file, motion.line, fmt::format("a dwell of {} s is too long", motion.seconds));
  }
  const auto check_axis = [&](std::size_t axis, double mm) {
    if (!in_range(mm, machine_.axes[axis].steps_per_mm)) {
      throw gcode::ProgramError(program_.file, motion.line,
                                fmt::format("{}{} is beyond the card's 32-bit position counter ({} steps/mm)",
                                            machine_.axes[axis].letter, mm, machine_.axes[axis].steps_per_mm));
    }
  };
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    check_axis(axis, motion.target[axis]);
  }
  if (motion.kind != gcode::MotionKind::kArc) {
    return;
  }
  // The extremes of the arc: its start and end are targets, the others lie at whole quarters of a turn.
  const ExactArc arc = exact_arc(motion, from);
  const double radius = std::max(arc.radius_start, arc.radius_end);
  const double scale = std::max(machine_.axes[motion.axis_x].steps_per_mm, machine_.axes[motion.axis_y].steps_per_mm);
  if (!(radius * scale <= kMaxRadius)) {
    throw gcode::ProgramError(program_.file, motion.line, fmt::format("an arc of radius {} mm is too large", radius));
  }
  const double quarter = std::acos(0.0);
  for (int direction = 0; direction < 4; ++direction) {
    const double turned = (direction * quarter - arc.angle_start) * (motion.clockwise ? -1 : 1);
    if (std::fmod(std::fmod(turned, 4 * quarter) + 4 * quarter, 4 * quarter) <= arc.sweep) {
      check_axis(motion.axis_x, motion.centre_x + radius * std::cos(direction * quarter));
      check_axis(motion.axis_y, motion.centre_y + radius * std::sin(direction * quarter));
    }
  }
}

bool Planner::next(PlannedSegment& segment) {
  const PathContext context{machine_, clock_hz_};
  while (index_ < program_.motions.size()) {
    const gcode::Motion& motion = program_.motions[index_++];
    segment = PlannedSegment{};
    segment.line = motion.line;
    segment.kind = motion.kind;
    segment.start = here_;
    segment.end = rounded(machine_, motion.target);
    bool any = true;
    if (motion.kind == gcode::MotionKind::kDwell) {
      plan_dwell(motion.seconds, clock_hz_, segment);
    } else if (motion.kind == gcode::MotionKind::kEnd) {
      segment.commands.emplace_back(driver::EndCommand{});
    } else if (motion.kind == gcode::MotionKind::kArc) {
      any = plan_arc(context, motion, exact_, segment);
    } else {
      any = plan_line(context, motion, segment);
    }
    exact_ = motion.target;
    here_ = segment.end;
    seconds_ += segment.seconds;
    if (any) {
      return true;
    }
  }
  return false;
}

}  // namespace trammel::planner
