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
constexpr double kSameSpeed = 1 - 1e-6;                            // a feed is reached from this share on

}  // namespace

Planner::Planner(BlockBuilder& blocks, const machine::Machine& machine, const CardLimits& card)
    : blocks_(blocks),
      machine_(machine),
      card_(card),
      least_ticks_(driver::gap_free_ticks(std::max(kFewestAxes, card.axes))) {}

bool Planner::next(driver::CommandSink& sink, PlannedBlock& planned) {
  Block& block = planned.block;
  if (!blocks_.next(block)) return false;
  planned.reached = 0;
  planned.limit = SpeedLimit::kNone;
  planned.seconds = 0;
  planned.geometry = 1;
  planned.feed = 1;
  planned.commands = 1;
  if (moves(block)) {
    plan_move(planned);
    for (const driver::FeedCommand& piece : profile_) {
      std::get<driver::FeedCommand>(piece_) = piece;
      sink.put(piece_);
    }
    put_geometry(block, sink);
    return true;
  }
  if (block.geometry == Geometry::kEnd) {
    sink.put(other_ = driver::EndCommand{});
    return true;
  }
  planned.seconds = block.dwell_seconds;
  planned.commands = std::max<std::uint64_t>(1, (block.dwell_clocks + kMaxDwell - 1) / kMaxDwell);
  planned.geometry = planned.feed = planned.commands;
  std::uint64_t left = block.dwell_clocks;
  for (std::uint64_t i = 0; i < planned.commands; ++i) {
    const std::uint64_t part = std::min(left, kMaxDwell);
    sink.put(other_ = driver::DwellCommand{part});
    left -= part;
  }
  return true;
}

// Feed ticks of a path as many as evenness wants and the clock allows; of each line of kChords.
std::uint64_t Planner::ticks_for(const Block& block) const {
  const double clocks = block.length / block.speed * card_.clock_hz;
  const double wanted = std::max(std::min(kTicksPerPulse * block.pulses, kMaxTickRate * clocks), kLeastRate * clocks);
  double ticks = std::clamp(std::round(wanted), static_cast<double>(least_ticks_), kMostTicks);
  if (block.geometry == Geometry::kChords) ticks = std::round(ticks / static_cast<double>(block.chord_lines));
  return std::max({static_cast<std::uint64_t>(ticks), block.least_ticks, least_ticks_});
}

void Planner::plan_move(PlannedBlock& planned) {
  const Block& block = planned.block;
  const std::uint64_t lines = block.geometry == Geometry::kChords ? block.chord_lines : 1;
  ticks_ = ticks_for(block);
  const double clock = card_.clock_hz;
  const double density = static_cast<double>(ticks_ * lines) / block.length;  // ticks a mm
  const ProfileLimits limits{block.speed * density / clock, block.acceleration * density / clock / clock};
  profile_ = trapezoid(ticks_ * lines, limits);
  planned.seconds = duration(profile_) / clock;
  planned.geometry = lines;
  planned.feed = profile_.size();
  planned.commands = lines + profile_.size();
  planned.reached = std::min(profile_.top_rate, limits.rate) / density * clock;
  planned.limit = block.limit;
  if (block.wanted == 0 || planned.reached >= block.speed * kSameSpeed) return;
  planned.limit =
      limits.rate > kMaxTickRate && profile_.top_rate >= kMaxTickRate ? SpeedLimit::kClock : SpeedLimit::kAcceleration;
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
