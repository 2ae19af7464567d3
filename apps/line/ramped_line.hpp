// A straight line in pulses as a program of one block, so that look-ahead ramps it by the machine's limits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "trammel/machine/machine.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::app {

// A machine made of the first `motors` motors, each as an axis whose unit is a pulse, without soft limits, offsets,
// outputs and tools. Throws UsageError if the machine has fewer motors.
machine::Machine in_pulses(const machine::Machine& machine, std::size_t motors);

// A program with the line by `pulses` from the card's present position, in `seconds` without its ramps. `machine`: the
// result of in_pulses(). Throws UsageError if nothing moves, and for more than 1,000 minutes.
run::ProgramLines ramped_line(const machine::Machine& machine, const std::vector<std::int64_t>& pulses, double seconds);

}  // namespace trammel::app
