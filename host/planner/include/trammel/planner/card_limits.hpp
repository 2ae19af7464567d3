// What the planner needs to know of the card. Plain data and pure functions, thread-safe.
#pragma once

#include <cstdint>

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::planner {

struct CardLimits {
  std::uint32_t clock_hz = 0;  // > 0
  unsigned axes = 4;           // of the card, 1 .. 8
  bool accumulator = true;     // arcs go to the deviation accumulator; without it out as lines
};

// T_s of the rule for an under-run: clocks in which the fastest hold stops half of what runs at full ratio.
double stop_clocks(const machine::Machine& machine, const CardLimits& card);

CardLimits limits_of(const driver::Identification& card);

// An axis's settings on the card: step times rounded up to whole nanoseconds.
driver::AxisSettings settings_of(const machine::MachineAxis& axis);

}  // namespace trammel::planner
