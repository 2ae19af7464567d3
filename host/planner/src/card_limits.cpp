#include "trammel/planner/card_limits.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace trammel::planner {
namespace {

std::chrono::nanoseconds rounded_up(double nanoseconds) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(std::ceil(nanoseconds)));
}

}  // namespace

CardLimits limits_of(const driver::Identification& card) {
  const auto has = [&](unsigned engine) { return card_map::has_engine(card.engines, engine); };
  return {card.clock_hz,
          card.axes,
          has(card_map::engine::kAccumulator),
          has(card_map::engine::kClasses),
          has(card_map::engine::kArcGenerator),
          card.geometry_depth,
          card.feed_depth,
          has(card_map::engine::kAccumulator8),
          has(card_map::engine::kPathCommands) ? machine::kMaxOutputs : 0,
          has(card_map::engine::kPwm),
          driver::has_slew_shift(card)};
}

CardLimits with_arcs_by(CardLimits card, ArcsBy arcs) {
  if (arcs != ArcsBy::kGenerator) card.arc_generator = false;
  // Other choices use the papers' own 4 directions, as a card without the 8.
  if (arcs != ArcsBy::kEightDirections) card.eight_directions = false;
  if (arcs == ArcsBy::kChords) card.accumulator = false;
  return card;
}

// Rounded as by Card::set_slew_time().
double hold_clocks(const machine::Machine& machine, double clock_hz) {
  constexpr auto kSlowest = static_cast<double>(driver::kSlowestSlew);
  const double clocks = std::clamp(std::ceil(hold_seconds(machine) * clock_hz), 1.0, kSlowest);
  return kSlowest / std::floor(kSlowest / clocks);
}

driver::AxisSettings settings_of(const machine::MachineAxis& axis) {
  driver::AxisSettings settings;
  settings.step_length = rounded_up(axis.step_length_ns);
  settings.step_space = rounded_up(axis.step_space_ns);
  settings.direction_setup = rounded_up(axis.direction_setup_ns);
  settings.direction_hold = rounded_up(axis.direction_hold_ns);
  settings.invert_second = axis.inverted;
  return settings;
}

}  // namespace trammel::planner
