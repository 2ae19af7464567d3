#include "look_ahead.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trammel/driver/card_timing.hpp"
#include "trammel/planner/s_curve_plan.hpp"
#include "trapezoid_plan.hpp"

namespace trammel::planner {
namespace {

constexpr double kTicksPerPulse = 128;    // makes steps even to 1/64
constexpr double kMaxTicks = 0x1p38;      // of a block; a command has 40 bits, and a piece can span blocks
constexpr double kMinTickRate = 0x1p-30;  // ticks per clock; four times the finest floor
// Ticks per clock. Above this, the shapers have no slack for jitter, and holds are uneven.
constexpr double kMaxTickRate = 0.9;
// Cards with fewer axes decode lines faster; they use the rule for four axes.
constexpr unsigned kMinAxes = 4;
// Room for blocks that are planned, but whose stop distances depend on later blocks.
constexpr std::size_t kSpare = 4096;
static_assert(kSpare >= 3 * Quantiser::kMaxBlocks + 2);  // plus one read after the window, and one that ends at rest

// Size of a command in the card's queue, with all axes.
std::uint64_t halfwords_of(card_map::Opcode opcode, unsigned axes) {
  const auto mask = static_cast<std::uint8_t>((1U << axes) - 1);
  return card_map::queue_halfwords(*card_map::find_command(static_cast<std::uint8_t>(opcode)), mask);
}

QueueLimits queues_of(const CardLimits& card) {
  return {card.geometry_depth,
          std::max<std::uint64_t>(1, card.feed_depth / halfwords_of(card_map::Opcode::Feed, card.axes))};
}

std::unique_ptr<SpeedPlan> plan_for(const machine::Machine& machine, const PlannerSettings& settings) {
  const auto window = static_cast<std::size_t>(machine.motion.window);
  if (profile_of(machine, settings) == SpeedProfile::kSCurve) {
    return std::make_unique<SCurvePlan>(window, settings.meanwhile);
  }
  return std::make_unique<TrapezoidPlan>(window);
}

}  // namespace

Planner::LookAhead::LookAhead(BlockBuilder& blocks, const machine::Machine& machine, const CardLimits& card,
                              const PlannerSettings& settings)
    : blocks_(blocks),
      settings_(settings),
      clock_hz_(card.clock_hz / machine.motion.max_override),
      axes_(card.axes),
      pwm_(card.pwm && machine.outputs.pwm != 0),
      line_halfwords_(halfwords_of(card_map::Opcode::Line, card.axes)),
      gap_free_ticks_(static_cast<double>(driver::gap_free_ticks(std::max(kMinAxes, card.axes)))),
      junctions_(machine),
      path_(static_cast<std::size_t>(machine.motion.window) + kSpare),
      quantiser_(path_, clock_hz_, hold_clocks(machine, card.clock_hz) / 2, queues_of(card),
                 profile_of(machine, settings) == SpeedProfile::kSCurve, card),
      plan_(plan_for(machine, settings)),
      ticks_(settings.ticks) {
  const double seconds = hold_clocks(machine, card.clock_hz) / card.clock_hz;
  for (const machine::MachineAxis& axis : machine.axes)
    hold_speeds_.push_back(hold_share(machine) * axis.max_acceleration * seconds);
}

PathEntry* Planner::LookAhead::first() {
  while (path_.begin() == path_.end() || (moves(path_[path_.begin()].block) && !quantiser_.ready())) {
    if (ended_ && !draining_) return nullptr;
    go_on();
  }
  return &path_[path_.begin()];
}

void Planner::LookAhead::go_on() {
  Phase phase;
  if (plan_->next(phase)) {
    quantiser_.add(phase);
    return;
  }
  if (draining_) {
    draining_ = false;
    if (ended_) quantiser_.finish();
    return;
  }
  if (path_.full()) {
    quantiser_.force();
    return;
  }
  read_block();
}

void Planner::LookAhead::read_block() {
  if (settings_.meanwhile) settings_.meanwhile();
  PathEntry& entry = path_.push();
  entry.timed = false;
  entry.queued = queued_;
  if (!blocks_.next(entry.block)) {
    path_.unpush();
    ended_ = true;
    if (tail_ != nullptr) {
      end_run(*tail_);
    } else {
      quantiser_.finish();
    }
    return;
  }
  entry.halfwords = halfwords(entry.block);
  queued_ += entry.halfwords;
  entry.begin_ticks = entry.end_ticks = ticks_.end_tick;
  if (moves(entry.block)) {
    add_motion(entry);
  } else if (tail_ != nullptr) {
    end_run(*tail_);
  }
}

// Halfwords of the block's commands in the geometry queue.
std::uint64_t Planner::LookAhead::halfwords(const Block& block) const {
  // Any block may change the pulses.
  const std::uint64_t outputs = (switches(block) ? halfwords_of(card_map::Opcode::Output, axes_) : 0) +
                                (pwm_ ? halfwords_of(card_map::Opcode::Pwm, axes_) : 0);
  switch (block.geometry) {
    case Geometry::kLine:
      return outputs + line_halfwords_;
    case Geometry::kArc:
      return outputs + halfwords_of(card_map::Opcode::Arc, axes_);
    case Geometry::kArcChord:
      return outputs + block.parts * halfwords_of(card_map::Opcode::ArcChord, axes_);
    case Geometry::kChords:
      return outputs + block.chord_lines * line_halfwords_;
    default:
      return outputs + halfwords_of(card_map::Opcode::Dwell, axes_);
  }
}

void Planner::LookAhead::add_motion(PathEntry& entry) {
  entry.cut = entry.stop = false;
  entry.jump = entry.bend = 0;
  const Junction junction =
      tail_ != nullptr && !settings_.single_block ? junctions_.between(tail_->block, entry.block) : Junction{};
  if (tail_ != nullptr && junction.speed == 0) end_run(*tail_);
  const bool same_class = ticks_.rapid == entry.block.rapid;
  const double density =
      same_class && suits(ticks_.density, entry.block) ? ticks_.density : wanted_density(entry.block);
  if (tail_ != nullptr) {
    tail_->jump = junction.bend == 0 ? junction.jump : 0;
    tail_->bend = junction.bend;
    tail_->cut = !same_class || density != ticks_.density;
    push_span(*tail_, junction.speed);
  }
  place(entry, density);
  entry.hold_speed = hold_speed(entry.block);
  ticks_.rapid = entry.block.rapid;
  tail_ = &entry;
}

void Planner::LookAhead::end_run(PathEntry& last) {
  last.cut = last.stop = true;
  push_span(last, 0);
  plan_->finish();
  tail_ = nullptr;
  draining_ = true;
}

void Planner::LookAhead::push_span(const PathEntry& entry, double exit_speed) {
  const Block& block = entry.block;
  plan_->push({block.length, block.speed, block.acceleration, block.jerk, exit_speed, block.curve});
}

// An arc may go through every direction of its plane.
double Planner::LookAhead::hold_speed(const Block& block) const {
  double speed = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < hold_speeds_.size(); ++axis) {
    const bool turns = block.curvature != 0 && in_plane(block, axis);
    const double share = turns ? 1 : std::max(std::abs(block.entry[axis]), std::abs(block.exit[axis]));
    if (share > 0) speed = std::min(speed, hold_speeds_[axis] / share);
  }
  return speed;
}

// Length and ticks continue across stops, so that the ticks of a path do not depend on where the program stops.
void Planner::LookAhead::place(PathEntry& entry, double density) {
  if (density != ticks_.density) {
    ticks_.density = density;
    ticks_.base_mm = ticks_.end_mm;
    ticks_.base_tick = ticks_.end_tick;
  }
  entry.density = density;
  entry.begin = ticks_.end_mm;
  entry.begin_ticks = ticks_.end_tick;
  entry.end = ticks_.end_mm += entry.block.length;
  const auto ticks = static_cast<std::uint64_t>((entry.end - ticks_.base_mm) * density + 0.5);
  const std::uint64_t least = ticks_.end_tick + std::max<std::uint64_t>(1, entry.block.least_ticks);
  entry.end_ticks = ticks_.end_tick = std::max(ticks_.base_tick + ticks, least);
}

// Ticks per mm: as many as even steps need and the clock allows.
double Planner::LookAhead::wanted_density(const Block& block) const {
  const double density = std::min(even_density(block), kMaxTickRate * clock_hz_ / block.speed);
  return std::min(std::max(density, least_density(block)), kMaxTicks / block.length);
}

// Makes steps even to 1/64, and makes a line last until the next one is decoded.
double Planner::LookAhead::even_density(const Block& block) const {
  return std::max(kTicksPerPulse * block.pulses_per_mm, gap_free_ticks_ / block.length);
}

// The density that the pulses and the finest rate need.
double Planner::LookAhead::least_density(const Block& block) const {
  return std::max(kMinTickRate * clock_hz_ / block.speed, static_cast<double>(block.least_ticks) / block.length);
}

// Whether the block may keep this density. Each change of density costs a piece, so half of the density that the clock
// allows is enough if the clock is the limit.
bool Planner::LookAhead::suits(double density, const Block& block) const {
  const double most = std::min(kMaxTickRate * clock_hz_ / block.speed, kMaxTicks / block.length);
  const double least = std::max(std::min(even_density(block), most / 2), least_density(block));
  return density >= least * (1 - 1e-9) && density <= most * (1 + 1e-9);
}

}  // namespace trammel::planner
