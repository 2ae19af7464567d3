#include "trammel/planner/planner.hpp"

#include <algorithm>
#include <cmath>

#include "chords.hpp"
#include "trammel/driver/arc.hpp"
#include "trammel/driver/card_timing.hpp"
#include "trammel/driver/increment.hpp"

namespace trammel::planner {
namespace {

constexpr double kTicksPerPulse = 128;  // steps even to 1/64
constexpr double kMostTicks = 0x1p39;   // half of the command's 40 bits
constexpr double kLeastRate = 0x1p-30;  // ticks a clock; four times the finest floor
constexpr unsigned kFewestAxes = 4;  // shorter lines than a card of four axes decodes are not worth a rule of their own
constexpr std::uint64_t kMaxDwell = (std::uint64_t{1} << 40) - 1;  // clocks of one command

}  // namespace

Planner::Planner(BlockBuilder& blocks, const machine::Machine& machine, const CardLimits& card)
    : blocks_(blocks),
      machine_(machine),
      card_(card),
      least_ticks_(driver::gap_free_ticks(std::max(kFewestAxes, card.axes))) {}

bool Planner::next(driver::CommandSink& sink, PlannedBlock& planned) {
  Block& block = planned.block;
  if (!blocks_.next(block)) return false;
  planned.speed = 0;
  planned.limit = SpeedLimit::kNone;
  if (block.geometry == Geometry::kDwell) {
    put_dwell(planned, sink);
    return true;
  }
  if (block.geometry == Geometry::kEnd) {
    planned.seconds = 0;
    planned.commands = planned.geometry = planned.feed = 1;
    sink.put(other_ = driver::EndCommand{});
    return true;
  }
  plan_move(planned);
  for (const driver::FeedCommand& piece : profile_) {
    std::get<driver::FeedCommand>(piece_) = piece;
    sink.put(piece_);
  }
  put_geometry(block, sink);
  return true;
}

void Planner::put_dwell(PlannedBlock& planned, driver::CommandSink& sink) {
  std::uint64_t left = planned.block.dwell_clocks;
  planned.seconds = planned.block.dwell_seconds;
  planned.commands = std::max<std::uint64_t>(1, (left + kMaxDwell - 1) / kMaxDwell);
  planned.geometry = planned.feed = planned.commands;
  for (std::uint64_t i = 0; i < planned.commands; ++i) {
    const std::uint64_t part = std::min(left, kMaxDwell);
    sink.put(other_ = driver::DwellCommand{part});
    left -= part;
  }
}

// Feed ticks of a path: T a pulse, as large as evenness wants and the clock allows; kChords: of each line.
std::uint64_t Planner::ticks_for(const Block& block) const {
  double per_pulse = std::min(kTicksPerPulse, kMaxTickRate * card_.clock_hz / block.speed);
  per_pulse = std::max(per_pulse, kLeastRate * card_.clock_hz / block.speed);
  double ticks = std::clamp(std::round(per_pulse * block.pulses), static_cast<double>(least_ticks_), kMostTicks);
  if (block.geometry == Geometry::kChords) ticks = std::round(ticks / static_cast<double>(block.chord_lines));
  return std::max({static_cast<std::uint64_t>(ticks), block.least_ticks, least_ticks_});
}

void Planner::plan_move(PlannedBlock& planned) {
  const Block& block = planned.block;
  const std::uint64_t lines = block.geometry == Geometry::kChords ? block.chord_lines : 1;
  ticks_ = ticks_for(block);
  profile_ = trapezoid(ticks_ * lines, {block.pulses, block.speed, block.acceleration}, card_.clock_hz);
  planned.seconds = duration(profile_) / card_.clock_hz;
  planned.geometry = lines;
  planned.feed = profile_.size();
  planned.commands = lines + profile_.size();
  const double mm_a_tick = block.length / static_cast<double>(ticks_ * lines);
  planned.speed = profile_.top_rate * card_.clock_hz * mm_a_tick;
  planned.limit = block.limit;
  if (block.wanted == 0 || profile_.reaches_limit) return;
  planned.limit = profile_.top_rate >= kMaxTickRate ? SpeedLimit::kClock : SpeedLimit::kAcceleration;
}

void Planner::put_geometry(const Block& block, driver::CommandSink& sink) {
  if (block.geometry == Geometry::kArc) {
    sink.put(other_ = driver::with_ticks(block.arc, ticks_));
    return;
  }
  if (block.geometry == Geometry::kChords) {
    put_chords(block, sink);
    return;
  }
  auto& line = std::get<driver::LineCommand>(line_);
  line.ticks = ticks_;
  unsigned mask = 0;
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    const std::int64_t pulses = block.end[axis] - block.start[axis];
    line.increment[axis] = 0;
    if (pulses == 0) continue;
    mask |= 1U << axis;
    line.increment[axis] = driver::rounded_increment(pulses, ticks_);
  }
  line.mask = static_cast<std::uint8_t>(mask);
  sink.put(line_);
}

void Planner::put_chords(const Block& block, driver::CommandSink& sink) {
  const auto scale = [&](std::size_t axis) { return machine_.axes[axis].steps_per_mm; };
  auto& line = std::get<driver::LineCommand>(line_);
  line.increment.fill(0);
  line.ticks = ticks_;
  const auto set = [&](std::size_t axis, std::int64_t pulses) {
    line.increment[axis] = pulses == 0 ? 0 : driver::rounded_increment(pulses, ticks_);
    return pulses == 0 ? 0U : 1U << axis;
  };
  for_each_chord(block, scale(block.axis_x), scale(block.axis_y), [&](Corner step) {
    line.mask = static_cast<std::uint8_t>(set(block.axis_x, step.x) | set(block.axis_y, step.y));
    sink.put(line_);
  });
}

}  // namespace trammel::planner
