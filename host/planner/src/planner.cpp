#include "trammel/planner/planner.hpp"

#include <algorithm>
#include <cmath>

#include "chords.hpp"
#include "look_ahead.hpp"
#include "trammel/driver/arc.hpp"
#include "trammel/driver/increment.hpp"

namespace trammel::planner {
namespace {

constexpr std::uint64_t kMaxDwell = (std::uint64_t{1} << 40) - 1;  // clocks per command
constexpr double kReached = 1 - 1e-4;  // share of the program's speed from which on it counts as reached

SpeedLimit limit_of(const PathEntry& entry) {
  const Block& block = entry.block;
  if (block.wanted == 0 || entry.speed >= block.wanted * kReached) return SpeedLimit::kNone;
  if (entry.speed >= block.speed * kReached) return block.limit;
  return entry.short_sight ? SpeedLimit::kWindow : SpeedLimit::kAcceleration;
}

// Divides `ticks` evenly among `count` paths.
class Shares {
 public:
  Shares(std::uint64_t ticks, std::uint64_t count) : share_(ticks / count), more_(ticks % count), count_(count) {}
  std::uint64_t next() {
    rest_ += more_;
    if (rest_ < count_) return share_;
    rest_ -= count_;
    return share_ + 1;
  }

 private:
  std::uint64_t share_;
  std::uint64_t more_;
  std::uint64_t count_;
  std::uint64_t rest_ = 0;
};

}  // namespace

SpeedProfile profile_of(const machine::Machine& machine, const PlannerSettings& settings) {
  if (settings.profile != SpeedProfile::kByMachine) return settings.profile;
  const auto limited = [](const machine::MachineAxis& axis) { return axis.max_jerk > 0; };
  const bool all = std::all_of(machine.axes.begin(), machine.axes.end(), limited);
  return all ? SpeedProfile::kSCurve : SpeedProfile::kTrapezoid;
}

Planner::Planner(BlockBuilder& blocks, const machine::Machine& machine, const CardLimits& card,
                 const PlannerSettings& settings)
    : kinematics_(machine),
      look_ahead_(std::make_unique<LookAhead>(blocks, machine, card, settings)),
      pwm_(card.pwm && machine.outputs.pwm != 0),
      clock_hz_(card.clock_hz),
      most_override_(machine.motion.max_override) {}

Planner::~Planner() = default;

const PathTicks& Planner::ticks() const { return look_ahead_->ticks(); }
const PlanWork& Planner::work() const { return look_ahead_->work(); }

bool Planner::next(driver::CommandSink& sink, PlannedBlock& planned) {
  const PathEntry* entry = look_ahead_->first();
  if (entry == nullptr) return false;
  planned = PlannedBlock{};
  planned.block = entry->block;
  const Block& block = planned.block;
  if (block.geometry == Geometry::kDwell) {
    put_dwell(planned, *entry, sink);
  } else if (block.geometry == Geometry::kEnd) {
    planned.commands = planned.geometry = planned.feed = 1;
    put_outputs(planned, sink);
    put_pulses(planned, *entry, sink);
    sink.put(other_ = driver::EndCommand{});
  } else {
    planned.seconds = entry->seconds;
    planned.speed = entry->speed;
    planned.limit = limit_of(*entry);
    planned.stop = entry->stop;
    planned.velocity_jump = entry->jump * entry->end_speed;
    planned.acceleration_step = entry->bend * entry->end_speed * entry->end_speed;
    planned.feed = look_ahead_->pieces();
    planned.geometry = block.geometry == Geometry::kChords     ? block.chord_lines
                       : block.geometry == Geometry::kArcChord ? block.parts
                                                               : 1;
    planned.commands = planned.feed + planned.geometry;
    put_outputs(planned, sink);
    put_pulses(planned, *entry, sink);
    for (auto& piece = std::get<driver::FeedCommand>(piece_); look_ahead_->piece(piece);) sink.put(piece_);
    put_geometry(block, entry->end_ticks - entry->begin_ticks, sink);
  }
  look_ahead_->pop();
  return true;
}

// Put before the block's other commands, because they take effect at the end of the path before.
void Planner::put_outputs(PlannedBlock& planned, driver::CommandSink& sink) {
  if (!switches(planned.block)) return;
  ++planned.commands;
  ++planned.geometry;
  ++planned.beside;
  sink.put(other_ = planned.block.outputs);
}

// Put if the pulses change. A duty that follows the speed is 0 in a dwell without a command.
void Planner::put_pulses(PlannedBlock& planned, const PathEntry& entry, driver::CommandSink& sink) {
  const Block& block = entry.block;
  if (!pwm_ || (block.power_follows && block.power != 0 && !moves(block))) return;
  const driver::PwmCommand pulses = pulses_of(entry);
  if (pulses_ && pulses_->duty == pulses.duty && pulses_->follows == pulses.follows && pulses_->shift == pulses.shift &&
      pulses_->gain == pulses.gain) {
    return;
  }
  pulses_ = pulses;
  ++planned.commands;
  ++planned.geometry;
  ++planned.beside;
  sink.put(other_ = pulses);
}

// Uses the density of the path's own ticks if rounding has given the path more or fewer ticks than its length has.
driver::PwmCommand Planner::pulses_of(const PathEntry& entry) const {
  constexpr double kFull = 65535;
  constexpr double kSameDensity = 1e-3;
  const Block& block = entry.block;
  const double duty = std::round(block.power * kFull);
  if (!block.power_follows || block.power == 0 || block.wanted == 0)
    return {0, static_cast<std::uint16_t>(duty), false, 0, 0};
  const double own = static_cast<double>(entry.end_ticks - entry.begin_ticks) / block.length;
  const double density = std::abs(own - entry.density) > kSameDensity * entry.density ? own : entry.density;
  const double rate = std::clamp(block.wanted * density / clock_hz_, 0x1p-30, 1.0);
  const double most = std::min(kFull, std::round(duty * most_override_));
  return driver::pwm_for_speed(0, static_cast<std::uint16_t>(duty), rate, static_cast<std::uint16_t>(most));
}

void Planner::put_dwell(PlannedBlock& planned, const PathEntry& entry, driver::CommandSink& sink) {
  std::uint64_t left = planned.block.dwell_clocks;
  planned.seconds = planned.block.dwell_seconds;
  planned.commands = std::max<std::uint64_t>(1, (left + kMaxDwell - 1) / kMaxDwell);
  planned.geometry = planned.feed = planned.commands;
  put_outputs(planned, sink);
  put_pulses(planned, entry, sink);
  for (std::uint64_t i = 0; i < planned.feed; ++i) {
    const std::uint64_t part = std::min(left, kMaxDwell);
    sink.put(other_ = driver::DwellCommand{part});
    left -= part;
  }
}

void Planner::put_geometry(const Block& block, std::uint64_t ticks, driver::CommandSink& sink) {
  if (block.geometry == Geometry::kArc) {
    sink.put(other_ = driver::with_ticks(block.arc, ticks));
  } else if (block.geometry == Geometry::kArcChord) {
    put_arc_chords(block, ticks, sink);
  } else if (block.geometry == Geometry::kChords) {
    put_chords(block, ticks, sink);
  } else {
    put_line(block, ticks, sink);
  }
}

void Planner::put_line(const Block& block, std::uint64_t ticks, driver::CommandSink& sink) {
  auto& line = std::get<driver::LineCommand>(line_);
  line.ticks = ticks;
  unsigned mask = 0;
  for (std::size_t joint = 0; joint < kinematics_.joints(); ++joint) {
    const std::int64_t pulses = block.end[joint] - block.start[joint];
    line.increment[joint] = 0;
    if (pulses == 0) continue;
    mask |= 1U << joint;
    line.increment[joint] = driver::rounded_increment(pulses, ticks);
  }
  line.mask = static_cast<std::uint8_t>(mask);
  sink.put(line_);
}

void Planner::put_arc_chords(const Block& block, std::uint64_t ticks, driver::CommandSink& sink) {
  Shares shares(ticks, block.parts);
  for (std::uint64_t i = 0; i < block.parts; ++i) {
    sink.put(other_ = driver::make_helix(helix_part(block, i, kinematics_), shares.next()));
  }
}

// Chords cover equal angles.
void Planner::put_chords(const Block& block, std::uint64_t ticks, driver::CommandSink& sink) {
  auto& line = std::get<driver::LineCommand>(line_);
  Shares shares(ticks, block.chord_lines);
  for_each_chord(block, kinematics_, [&](const Pulses& step) {
    line.ticks = shares.next();
    unsigned mask = 0;
    for (std::size_t joint = 0; joint < step.size(); ++joint) {
      line.increment[joint] = step[joint] == 0 ? 0 : driver::rounded_increment(step[joint], line.ticks);
      mask |= (step[joint] == 0 ? 0U : 1U) << joint;
    }
    line.mask = static_cast<std::uint8_t>(mask);
    sink.put(line_);
  });
}

}  // namespace trammel::planner
