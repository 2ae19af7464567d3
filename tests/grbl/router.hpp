// The machine of these tests: a router with three axes and no card.
#pragma once

#include "trammel/machine/machine.hpp"
#include "trammel/planner/card_limits.hpp"

namespace trammel::grbl {

inline constexpr std::uint32_t kRouterClock = 100'000'000;

inline planner::CardLimits router_card() {
  planner::CardLimits card;
  card.clock_hz = kRouterClock;
  card.outputs = machine::kMaxOutputs;
  return card;
}

inline machine::MachineAxis router_axis(char letter) {
  machine::MachineAxis axis;
  axis.letter = letter;
  axis.steps_per_mm = 250;
  axis.max_velocity = 50;  // mm/s
  axis.max_acceleration = 500;
  axis.step_length_ns = 10'000;
  axis.step_space_ns = 2000;
  return axis;
}

// Spindle and coolant have outputs, and the probe has an input. There are no soft limits and no homing switches.
inline machine::Machine router() {
  machine::Machine machine;
  machine.clock_hz = kRouterClock;
  for (const char letter : {'X', 'Y', 'Z'}) machine.axes.push_back(router_axis(letter));
  machine.outputs.m3 = 1U << 0;
  machine.outputs.m4 = 1U << 1;
  machine.outputs.m7 = 1U << 2;
  machine.outputs.m8 = 1U << 3;
  machine.probe.input = 0;
  return machine;
}

// Each axis has a travel of 200 mm, from -200 to 0 as in Grbl, and a homing switch at the upper end.
inline machine::Machine fenced_router() {
  machine::Machine machine = router();
  for (machine::MachineAxis& axis : machine.axes) {
    axis.min = -200;
    axis.max = 0;
    axis.homing = machine::AxisHoming{};
    axis.homing->search_velocity = 20;
    axis.homing->latch_velocity = -2;
  }
  return machine;
}

}  // namespace trammel::grbl
