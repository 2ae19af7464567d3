#include "trammel/run/deviation_meter.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "centre_scale.hpp"
#include "trammel/card_map.hpp"

namespace trammel::run {
namespace {

// Pulses of a line on an axis: its increment times its ticks, rounded to the nearest integer.
double displacement(const driver::LineCommand& line, unsigned axis) {
  constexpr unsigned kBits = card_map::constant::kFractionBits;
  const std::int64_t increment = line.increment[axis];
  const auto magnitude = static_cast<std::uint64_t>(increment < 0 ? -increment : increment);
  const driver::Uint128 half(std::uint64_t{1} << (kBits - 1));
  const double pulses = static_cast<double>(((driver::Uint128::product(magnitude, line.ticks) + half) >> kBits).low());
  return increment < 0 ? -pulses : pulses;
}

double to_double(driver::Int128 value) {
  return static_cast<double>(value.high()) * 0x1p64 + static_cast<double>(value.low());
}

}  // namespace

void DeviationMeter::sending(const planner::Block& block) {
  if (!machine_) machine_ = block.start;
  block_ = block;
}

double DeviationMeter::Path::level(double x, double y) const {
  if (semi_x == 0) return std::hypot(x, y);
  const double slope = std::hypot(x / (semi_x * semi_x), y / (semi_y * semi_y));
  return slope > 0 ? (std::pow(x / semi_x, 2) + std::pow(y / semi_y, 2) - 1) / (2 * slope) : -std::min(semi_x, semi_y);
}

DeviationMeter::Path DeviationMeter::arc_in_chords() const {
  Path path;
  path.arc = path.of_machine = true;
  path.axis_count = 2;
  path.axes[0] = block_.joint_x;
  path.axes[1] = block_.joint_y;
  path.target[0] = static_cast<double>(block_.centre_x) / kCentreScale;
  path.target[1] = static_cast<double>(block_.centre_y) / kCentreScale;
  const auto radius = [&](const planner::Pulses& at) {
    return std::hypot(static_cast<double>(at[path.axes[0]]) - path.target[0],
                      static_cast<double>(at[path.axes[1]]) - path.target[1]);
  };
  path.inner = std::min(radius(block_.start), radius(block_.end));
  path.outer = std::max(radius(block_.start), radius(block_.end));
  return path;
}

void DeviationMeter::command(std::uint64_t number, const driver::Command& command) {
  Path path;
  path.number = number;
  if (const auto* line = std::get_if<driver::LineCommand>(&command)) {
    for (unsigned axis = 0; axis < card_map::kMaxAxes; ++axis) {
      if ((line->mask >> axis & 1U) == 0) continue;
      path.axes[path.axis_count] = axis;
      path.target[path.axis_count++] = displacement(*line, axis);
    }
    double square = 0;
    for (unsigned i = 0; i < path.axis_count; ++i) square += path.target[i] * path.target[i];
    path.length = std::sqrt(square);
  } else if (const auto* arc = std::get_if<driver::ArcCommand>(&command)) {
    path.arc = true;
    path.axis_count = 2;
    path.axes[0] = arc->axis_x;
    path.axes[1] = arc->axis_y;
    // The gradient of F = A X^2 + B Y^2 - N at the start, with X in pulses, is CX X.
    const auto half_x = static_cast<double>(arc->half_x);
    const auto half_y = static_cast<double>(arc->half_y);
    path.target[0] = -to_double(arc->gradient_x) / (2 * half_x);
    path.target[1] = -to_double(arc->gradient_y) / (2 * half_y);
    if (arc->half_x != arc->half_y) {
      path.semi_x = std::sqrt(half_y);
      path.semi_y = std::sqrt(half_x);
    }
    const double start = path.level(-path.target[0], -path.target[1]);
    const double end = path.level(arc->end_x - path.target[0], arc->end_y - path.target[1]);
    path.inner = std::min(start, end);
    path.outer = std::max(start, end);
  } else if (std::holds_alternative<driver::ArcChordCommand>(command)) {
    path = arc_in_chords();
    path.number = number;
  } else {
    return;
  }
  path.line = block_.line;
  paths_.push_back(path);
}

void DeviationMeter::enter(std::uint64_t command) {
  while (!paths_.empty() && paths_.front().number < command) {
    paths_.pop_front();
    position_.fill(0);
  }
  if (paths_.empty() || paths_.front().number != command) {
    throw std::logic_error("a step of a command that was never sent");
  }
}

void DeviationMeter::step(std::uint64_t command, std::uint64_t tick, unsigned axis, int direction) {
  const bool same_path = !paths_.empty() && paths_.front().number == command;
  if (tick_ && !(same_path && *tick_ == tick)) measure();
  if (!same_path) enter(command);
  if (Path& path = paths_.front(); path.of_machine) {
    path.of_machine = false;
    for (unsigned i = 0; i < path.axis_count; ++i) path.target[i] -= static_cast<double>((*machine_)[path.axes[i]]);
  }
  tick_ = tick;
  position_[axis] += direction;
  if (machine_) (*machine_)[axis] += direction;
}

void DeviationMeter::finish() {
  if (tick_) measure();
  tick_.reset();
}

void DeviationMeter::look(double deviation, double& largest, Place& place) const {
  if (deviation <= largest) return;
  largest = deviation;
  place = {paths_.front().line, machine_.value_or(planner::Pulses{})};
}

void DeviationMeter::measure() {
  const Path& path = paths_.front();
  if (path.arc) {
    const double x = static_cast<double>(position_[path.axes[0]]) - path.target[0];
    const double y = static_cast<double>(position_[path.axes[1]]) - path.target[1];
    const double level = path.level(x, y);
    look(std::max(level - path.outer, path.inner - level), largest_arc_, arc_place_);
    return;
  }
  // |d|^2 - (d.u)^2 loses digits on long lines; the rejection d - (d.u) u does not.
  double along = 0;
  for (unsigned i = 0; i < path.axis_count; ++i) {
    along += static_cast<double>(position_[path.axes[i]]) * path.target[i];
  }
  along /= path.length * path.length;
  double square = 0;
  for (unsigned i = 0; i < path.axis_count; ++i) {
    const double off = static_cast<double>(position_[path.axes[i]]) - along * path.target[i];
    square += off * off;
  }
  look(std::sqrt(square), largest_line_, line_place_);
}

}  // namespace trammel::run
