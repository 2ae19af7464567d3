// A straight line in pulses as a program of one block, so that look-ahead ramps it by the machine's limits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "trammel/machine/machine.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::app {

// The machine's first `motors` motors as axes of their own whose unit is a pulse, without soft limits, offsets, outputs
// and tools. Throws UsageError where it has fewer.
machine::Machine in_pulses(const machine::Machine& machine, std::size_t motors);

// `machine`: in_pulses(). The line by `pulses` from where the card stands, in `seconds` without its ramps. Throws
// UsageError where nothing moves, and for more than 1,000 minutes.
run::ProgramLines ramped_line(const machine::Machine& machine, const std::vector<std::int64_t>& pulses, double seconds);

}  // namespace trammel::app
